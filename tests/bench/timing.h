#pragma once

#include <functional>
#include <string>
#include <vector>

namespace morphbake::bench {

/// One line of the table.
struct Figure {
  std::string group;  ///< "solve, 100k vertices"
  std::string name;
  double value = 0;
  std::string unit;
  std::string note;  ///< how it was obtained where that is not by timing alone
};

/// Where figures go: all of them, in order.
using Figures = std::vector<Figure>;

/// Seconds of one call.
double seconds_of(const std::function<void()>& work);

/// Median seconds of `repeats` calls, after one that does not count.
double median_seconds(int repeats, const std::function<void()>& work);

/// Two ways of doing one thing, timed in turn.
struct Pair {
  double first = 0;   ///< seconds, median
  double second = 0;  ///< seconds, median
  double ratio = 0;   ///< median of second / first, each of neighbouring runs
};

Pair time_pair(int repeats, const std::function<void()>& first,
               const std::function<void()>& second);

/// "10k", "500k"
std::string shown_count(int count);

/// Bytes that the process has had in memory at most, since it was started or told to forget.
double peak_memory();
void forget_peak_memory();

void bench_batch(int count, Figures& figures);
void bench_solvers(int vertices, Figures& figures);
void bench_stream(int vertices, int frames, Figures& figures);
void bench_rotations(int vertices, Figures& figures);
void bench_regions(int vertices, Figures& figures);
void bench_eigenvectors(int vertices, Figures& figures);
void bench_load(int vertices, Figures& figures);
void bench_targets(int vertices, int frames, Figures& figures);
void bench_export(int vertices, Figures& figures);
void bench_preview(int vertices, Figures& figures);
void bench_diff(int vertices, Figures& figures);

}  // namespace morphbake::bench
