#include "cli/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace morphbake::cli {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

constexpr unsigned kPatience = 20;  // seconds; stages look for interrupts far more often

extern "C" void give_up(int signal_number) {
  static_cast<void>(signal_number);
  _exit(130);
}

/// Asks politely; a library that does not come back is ended all the same.
extern "C" void note_interrupt(int signal_number) {
  interrupted = true;
  for (const int other : {SIGINT, SIGTERM}) signal(other, SIG_DFL);
  signal(SIGALRM, give_up);
  alarm(kPatience);
  static_cast<void>(signal_number);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_interrupt;
  action.sa_flags = SA_RESTART;
  for (const int signal_number : {SIGINT, SIGTERM}) sigaction(signal_number, &action, nullptr);
  // A limit on the size of files then is an error of the write, as a full disk, and is cleaned up.
  signal(SIGXFSZ, SIG_IGN);
}

bool is_interrupted() { return interrupted; }

}  // namespace morphbake::cli
