#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace morphbake {

/// What a process may take; 0 for no limit.
struct ProcessLimits {
  double seconds = 0;
  double bytes = 0;  ///< of address space, beyond what this program has when it forks
};

/// What became of a process.
struct ProcessOutcome {
  enum class End { Finished, Crashed, TimedOut };

  std::size_t ticket = 0;
  End end = End::Finished;
  std::string result;  ///< what its work returned, if it finished
  std::string log;     ///< the end of what it printed
  int signal = 0;      ///< that ended it, or 0
  int exit_code = 0;
  bool was_asked = false;  ///< to stop, since its time was over
  double seconds = 0;
};

/// Runs work in processes of its own, which are copies of this one (fork): whatever becomes of
/// them, this one goes on. They do not outlive this object, nor this process.
///
/// Of a process with threads the copy has one only, and waits for ever for what another one held.
/// So whoever starts work here runs none by TBB; OpenBLAS, which has threads from its start, ends
/// them for a fork by itself.
class IsolatedProcesses {
 public:
  explicit IsolatedProcesses(ProcessLimits limits) : limits_(limits) {}

  IsolatedProcesses(const IsolatedProcesses&) = delete;
  IsolatedProcesses& operator=(const IsolatedProcesses&) = delete;
  ~IsolatedProcesses();

  /// Starts `work`, whose result comes back with `ticket`. It must not throw.
  ///
  /// @return  false when the system gives no process more
  bool start(std::size_t ticket, const std::function<std::string()>& work);

  std::size_t running() const { return children_.size(); }

  /// Waits until something ends, at most so long; a signal ends the waiting too.
  std::vector<ProcessOutcome> wait(std::chrono::milliseconds at_most);

  /// Asks all to stop (SIGTERM); those that have not after 10 s are killed by wait().
  void ask_to_stop();

 private:
  using Clock = std::chrono::steady_clock;

  struct Child {
    std::size_t ticket = 0;
    int process = 0;  ///< its number
    int result_end = -1;
    int log_end = -1;
    std::string result;
    std::string log;
    bool is_timed_out = false;
    Clock::time_point began;
    Clock::time_point asked = Clock::time_point::max();  ///< to stop
  };

  void enforce_limits();
  static void read_from(Child& child);
  ProcessOutcome ended(Child& child);

  ProcessLimits limits_;
  std::vector<Child> children_;
  std::vector<int> ending_;  ///< processes that have given their results
};

}  // namespace morphbake
