#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "morphbake/bake/stage_report.h"
#include "morphbake/diagnostics/problem.h"

namespace morphbake {

/// A file as it was when a recipe was baked.
struct FileState {
  std::string file;  ///< from the folder of the batch on
  bool is_there =
      true;  ///< false: it was looked for in vain, and changes the bake once it is there
  std::uint64_t bytes = 0;
  std::int64_t mtime = 0;  ///< nanoseconds since 1970, as the file system has it
  std::string hash;
};

/// What a bake gave, for the table of a library.
struct BakeSummary {
  int vertices = 0;
  int triangles = 0;
  int frames = 0;
  int targets = 0;                  ///< of all outputs
  std::uint64_t bytes = 0;          ///< of all .glb
  double max_error = 0;             ///< the largest of all outputs, share of the diagonal
  double normal_error = 0;          ///< degrees, likewise
  std::vector<StageReport> stages;  ///< that ran
  std::vector<std::string> cached;  ///< names of those that were taken from the cache
};

/// A line of a batch's report: what came of a recipe, and by what a later run sees whether it
/// holds.
struct BatchRecord {
  std::string name;
  std::string recipe;    ///< its file, from the folder of the batch on
  std::string set;       ///< JSON text of an object of changes, or ""
  bool is_done = false;  ///< else it failed
  double seconds = 0;    ///< from its start to its end, in its process
  std::optional<BakeSummary> summary;
  std::vector<Problem> problems;  ///< warnings, or what it failed of
  std::string log;                ///< the end of what libraries printed, where the process crashed

  std::string request;       ///< hash of what the batch asks for: changes, options, program
  std::string key;           ///< hash of all that decides the outputs' bytes
  std::string connectivity;  ///< the key of the shared stage; "" where it is not known
  std::int64_t written = 0;  ///< nanoseconds since 1970: when the files' states were taken
  std::vector<FileState> inputs;
  std::vector<FileState> outputs;
};

/// One line of JSON, without a line break.
std::string record_to_line(const BatchRecord& record);

/// @return  none where the line is no record: cut off, or of another program
std::optional<BatchRecord> record_from_line(const std::string& line);

/// How a line of a report begins.
struct LineStart {
  std::string name;  ///< "" where the line is none
  bool is_done = false;
};

/// Reads no more of a line than its start.
LineStart start_of_line(const std::string& line);

}  // namespace morphbake
