#include "morphbake/batch/isolated_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace morphbake {
namespace {

constexpr std::chrono::seconds kPatience(10);  // after a polite SIGTERM
constexpr std::size_t kLogBytes = 4096;        // of the end of what a process prints
constexpr std::size_t kMostResult = std::size_t{64} << 20;

/// Both ends of a pipe; -1 where there is none.
struct Pipe {
  int read_end = -1;
  int write_end = -1;
};

Pipe make_pipe() {
  std::array<int, 2> ends = {-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {};
  return {ends[0], ends[1]};
}

void close_end(int& end) {
  if (end >= 0) ::close(end);
  end = -1;
}

/// Bytes of address space that this process has.
double address_space() {
  std::ifstream stream("/proc/self/statm");
  double pages = 0;
  stream >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

void limit_memory(double bytes) {
  const auto most = static_cast<rlim_t>(address_space() + bytes);
  const rlimit limit = {most, most};
  ::setrlimit(RLIMIT_AS, &limit);
}

void write_all(int end, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::write(end, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) _exit(EXIT_FAILURE);
    done += static_cast<std::size_t>(count);
  }
}

/// What the new process does, all its life long. Nothing of the old one is flushed or destroyed.
[[noreturn]] void live(pid_t parent, const ProcessLimits& limits, int result_end, int log_end,
                       const std::function<std::string()>& work) {
  ::setpgid(0, 0);  // so that a Ctrl-C is this program's to pass on
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) _exit(EXIT_FAILURE);  // it died before it could be noted
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  ::dup2(log_end, STDOUT_FILENO);
  ::dup2(log_end, STDERR_FILENO);
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  if (limits.bytes > 0) limit_memory(limits.bytes);
  write_all(result_end, work());
  ::close(result_end);  // now, since the end of a process with much memory takes a while
  _exit(EXIT_SUCCESS);
}

/// Appends what a pipe holds now, of which the last `most` bytes are kept; closes it at its end.
void drain(int& end, std::string& text, std::size_t most) {
  std::array<char, 65536> piece;
  while (end >= 0) {
    const ssize_t count = ::read(end, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;  // nothing now
    if (count == 0) return close_end(end);
    text.append(piece.data(), static_cast<std::size_t>(count));
    if (text.size() > most) text.erase(0, text.size() - most);
  }
}

void kill_group(pid_t process, int signal_number) {
  ::kill(-process, signal_number);
  ::kill(process, signal_number);  // it may not have come to have a group yet
}

}  // namespace

IsolatedProcesses::~IsolatedProcesses() {
  ask_to_stop();  // so that they take their temporary files with them
  while (!children_.empty()) wait(std::chrono::milliseconds(100));
  for (const int process : ending_) {
    while (::waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

bool IsolatedProcesses::start(std::size_t ticket, const std::function<std::string()>& work) {
  Pipe result = make_pipe();
  Pipe log = make_pipe();
  const pid_t parent = ::getpid();
  std::fflush(nullptr);
  const bool has_pipes = result.read_end >= 0 && log.read_end >= 0;
  const pid_t process = has_pipes ? ::fork() : -1;
  if (process == 0) live(parent, limits_, result.write_end, log.write_end, work);
  close_end(result.write_end);
  close_end(log.write_end);
  if (process < 0) {
    close_end(result.read_end);
    close_end(log.read_end);
    return false;
  }
  ::setpgid(process, process);
  for (const int end : {result.read_end, log.read_end}) ::fcntl(end, F_SETFL, O_NONBLOCK);
  Child child;
  child.ticket = ticket;
  child.process = process;
  child.result_end = result.read_end;
  child.log_end = log.read_end;
  child.began = Clock::now();
  children_.push_back(std::move(child));
  return true;
}

void IsolatedProcesses::read_from(Child& child) {
  drain(child.result_end, child.result, kMostResult);
  drain(child.log_end, child.log, kLogBytes);
}

ProcessOutcome IsolatedProcesses::ended(Child& child) {
  ProcessOutcome outcome;
  outcome.was_asked = child.is_timed_out;
  if (child.result.empty()) {
    int status = 0;
    while (::waitpid(child.process, &status, 0) < 0 && errno == EINTR) {
    }
    outcome.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    outcome.end = child.is_timed_out ? ProcessOutcome::End::TimedOut : ProcessOutcome::End::Crashed;
  } else {
    ending_.push_back(child.process);  // there is no need to wait for it
  }
  read_from(child);
  close_end(child.result_end);
  close_end(child.log_end);
  outcome.ticket = child.ticket;
  outcome.seconds = std::chrono::duration<double>(Clock::now() - child.began).count();
  outcome.result = std::move(child.result);
  outcome.log = std::move(child.log);
  return outcome;
}

void IsolatedProcesses::enforce_limits() {
  const Clock::time_point now = Clock::now();
  for (Child& child : children_) {
    const std::chrono::duration<double> lived = now - child.began;
    if (limits_.seconds > 0 && lived.count() > limits_.seconds && !child.is_timed_out) {
      child.is_timed_out = true;
      child.asked = std::min(child.asked, now);
      kill_group(child.process, SIGTERM);
    }
    const bool was_asked = child.asked != Clock::time_point::max();
    if (was_asked && now - child.asked > kPatience) kill_group(child.process, SIGKILL);
  }
}

void IsolatedProcesses::ask_to_stop() {
  for (Child& child : children_) {
    if (child.asked != Clock::time_point::max()) continue;
    child.asked = Clock::now();
    kill_group(child.process, SIGTERM);
  }
}

std::vector<ProcessOutcome> IsolatedProcesses::wait(std::chrono::milliseconds at_most) {
  std::vector<pollfd> ends;
  for (const Child& child : children_) {
    for (const int end : {child.result_end, child.log_end}) {
      if (end >= 0) ends.push_back({end, POLLIN, 0});
    }
  }
  ::poll(ends.data(), ends.size(), static_cast<int>(at_most.count()));
  std::vector<ProcessOutcome> outcomes;
  std::erase_if(children_, [&](Child& child) {
    read_from(child);
    if (child.result_end >= 0) return false;
    outcomes.push_back(ended(child));
    return true;
  });
  enforce_limits();
  std::erase_if(ending_, [](int process) { return ::waitpid(process, nullptr, WNOHANG) != 0; });
  return outcomes;
}

}  // namespace morphbake
