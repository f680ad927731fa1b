#include "morphbake/batch/isolated_process.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <new>
#include <thread>

#include "morphbake/batch/bake_queue.h"

namespace morphbake {
namespace {

using testing::HasSubstr;
using End = ProcessOutcome::End;

std::vector<ProcessOutcome> all_of(IsolatedProcesses& processes) {
  std::vector<ProcessOutcome> outcomes;
  while (processes.running() > 0) {
    for (ProcessOutcome& outcome : processes.wait(std::chrono::milliseconds(100))) {
      outcomes.push_back(std::move(outcome));
    }
  }
  return outcomes;
}

ProcessOutcome outcome_of(const std::function<std::string()>& work, ProcessLimits limits = {}) {
  IsolatedProcesses processes(limits);
  EXPECT_TRUE(processes.start(7, work));
  const std::vector<ProcessOutcome> outcomes = all_of(processes);
  EXPECT_EQ(outcomes.size(), 1U);
  EXPECT_EQ(outcomes.front().ticket, 7U);
  return outcomes.front();
}

TEST(IsolatedProcess, ASignalIsACrashWithWhatWasPrinted) {
  const ProcessOutcome outcome = outcome_of([]() -> std::string {
    std::fputs("before", stderr);
    std::puts("after");
    std::fflush(stdout);
    ::signal(SIGSEGV, SIG_DFL);  // a sanitizer's handler would exit
    ::kill(::getpid(), SIGSEGV);
    return "never";
  });
  EXPECT_EQ(outcome.end, End::Crashed);
  EXPECT_EQ(outcome.signal, SIGSEGV);
  EXPECT_EQ(outcome.log, "beforeafter\n");
}

TEST(IsolatedProcess, AnExitWithoutResultIsACrash) {
  const ProcessOutcome outcome = outcome_of([]() -> std::string { ::_exit(3); });
  EXPECT_EQ(outcome.end, End::Crashed);
  EXPECT_EQ(outcome.exit_code, 3);
}

TEST(IsolatedProcess, TimeIsLimited) {
  const auto work = []() -> std::string {
    signal(SIGTERM, SIG_DFL);
    while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
  };
  const ProcessOutcome outcome = outcome_of(work, {0.2, 0});
  EXPECT_EQ(outcome.end, End::TimedOut);
  EXPECT_LT(outcome.seconds, 5);
}

TEST(IsolatedProcess, MemoryIsLimited) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "AddressSanitizer does not return when memory is short";
#endif
  const auto work = []() -> std::string {
    try {
      std::string much(std::size_t{1} << 30, 'x');
      return "has " + std::to_string(much.size());
    } catch (const std::bad_alloc&) {
      return "has none";
    }
  };
  EXPECT_EQ(outcome_of(work, {0, 500e6}).result, "has none");
  EXPECT_EQ(outcome_of(work, {0, 4e9}).result, "has 1073741824");
}

TEST(IsolatedProcess, LargeResultsAndLogsDoNotBlock) {
  const ProcessOutcome outcome = outcome_of([] {
    const std::string line(1000, 'y');
    for (int i = 0; i < 2000; ++i) std::fputs(line.c_str(), stderr);
    return std::string(3000000, 'x');
  });
  EXPECT_EQ(outcome.end, End::Finished);
  EXPECT_EQ(outcome.result, std::string(3000000, 'x'));
  EXPECT_EQ(outcome.log, std::string(4096, 'y'));
}

TEST(IsolatedProcess, SeveralAtOnceEndAsTheyDo) {
  IsolatedProcesses processes({});
  for (std::size_t i = 0; i < 20; ++i) {
    processes.start(i, [i]() -> std::string {
      if (i % 3 == 0) ::abort();
      return std::to_string(i);
    });
  }
  std::map<std::size_t, std::string> results;
  for (const ProcessOutcome& outcome : all_of(processes)) results[outcome.ticket] = outcome.result;
  ASSERT_EQ(results.size(), 20U);
  for (const auto& [i, result] : results) EXPECT_EQ(result, i % 3 == 0 ? "" : std::to_string(i));
}

TEST(IsolatedProcess, NoneOutlivesItsOwner) {
  pid_t process = 0;
  {
    IsolatedProcesses processes({});
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    processes.start(0, [&]() -> std::string {
      signal(SIGTERM, SIG_DFL);
      const pid_t own = ::getpid();
      if (::write(ends[1], &own, sizeof own) != sizeof own) ::_exit(1);
      while (true) ::pause();
    });
    ASSERT_EQ(::read(ends[0], &process, sizeof process), static_cast<ssize_t>(sizeof process));
  }
  EXPECT_EQ(::kill(process, 0), -1);
}

std::vector<std::size_t> drained(BakeQueue& queue) {
  std::vector<std::size_t> entries;
  while (const auto next = queue.next()) entries.push_back(next->entry);
  return entries;
}

TEST(BakeQueue, OneMakesWhatOthersWaitFor) {
  BakeQueue queue({0, 1, 2});
  EXPECT_FALSE(queue.waits(queue.next()->entry, "k"));
  EXPECT_TRUE(queue.waits(queue.next()->entry, "k"));
  EXPECT_TRUE(queue.waits(queue.next()->entry, "k"));
  EXPECT_FALSE(queue.next());
  queue.made("k", false);
  EXPECT_THAT(drained(queue), testing::ElementsAre(1, 2));
}

TEST(BakeQueue, WhoFailsIsFollowedByTheNext) {
  BakeQueue queue({0, 1, 2});
  for (int i = 0; i < 3; ++i) queue.waits(queue.next()->entry, "k");
  queue.made("k", true);
  const auto next = queue.next();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->entry, 1U);
  EXPECT_EQ(next->makes, "k");
  EXPECT_FALSE(queue.next());
  queue.made("k", true);
  EXPECT_EQ(queue.next()->entry, 2U);
  queue.made("k", true);
  EXPECT_FALSE(queue.next());
  EXPECT_FALSE(queue.waits(9, "k"));
}

}  // namespace
}  // namespace morphbake
