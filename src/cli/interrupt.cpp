#include "cli/interrupt.h"

#include <signal.h>

#include <atomic>

namespace morphbake::cli {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

extern "C" void note_interrupt(int signal_number) {
  interrupted = true;
  for (const int other : {SIGINT, SIGTERM}) signal(other, SIG_DFL);
  static_cast<void>(signal_number);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_interrupt;
  action.sa_flags = SA_RESTART;
  for (const int signal_number : {SIGINT, SIGTERM}) sigaction(signal_number, &action, nullptr);
}

bool is_interrupted() { return interrupted; }

}  // namespace morphbake::cli
