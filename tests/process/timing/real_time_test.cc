#include "process/timing/real_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <functional>

namespace hydro::timing {
namespace {

using testing::HasSubstr;

// Runs `check` in a child process, whose scheduling may be changed; its stderr and exit code come back.
struct Outcome {
  int exit_code;
  std::string stderr_text;
};

Outcome InChild(const std::function<int()>& check) {
  int ends[2];
  if (pipe(ends) != 0) return {-1, "no pipe"};
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    _exit(check());
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t size; (size = read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, size);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}

// Gives up every right to real time: no privileges, limits of zero.
void DropRights() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_RTPRIO, &none);
  setrlimit(RLIMIT_MEMLOCK, &none);
  if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(99);
}

// Tests that without a request nothing is done and nothing printed.
TEST(RealTimeTest, DoesNothingUnasked) {
  const Outcome outcome = InChild([] {
    const RealTimeResult result = ApplyRealTime({});
    const bool quiet = !result.priority && !result.cpu && !result.memory_locked && result.warnings.empty();
    return quiet && sched_getscheduler(0) == SCHED_OTHER ? 0 : 1;
  });
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.stderr_text, "");
}

// Tests that each refusal gives exactly one line that names what was refused and how to permit it.
TEST(RealTimeTest, DegradesWithOneWarningEach) {
#ifdef HYDRO_SANITIZED
  GTEST_SKIP() << "the sanitizers answer mlockall() themselves";
#endif
  const Outcome outcome = InChild([] {
    DropRights();
    const RealTimeResult result = ApplyRealTime({.priority = 50, .cpu = 1000, .lock_memory = true});
    if (result.priority || result.cpu || result.memory_locked) return 1;
    return result.warnings.size() == 3 ? 0 : 2;
  });
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(std::count(outcome.stderr_text.begin(), outcome.stderr_text.end(), '\n'), 3)
      << outcome.stderr_text;
  EXPECT_THAT(outcome.stderr_text, HasSubstr("priority 50 is refused"));
  EXPECT_THAT(outcome.stderr_text, HasSubstr("ulimit -r 50"));
  EXPECT_THAT(outcome.stderr_text, HasSubstr("processor 1000 is refused"));
  EXPECT_THAT(outcome.stderr_text, HasSubstr("ulimit -l unlimited"));
}

// Tests that a processor that is there is taken, and that what the result says holds whatever this machine
// permits.
TEST(RealTimeTest, AchievesWhatIsPermitted) {
  const Outcome outcome = InChild([] {
    cpu_set_t permitted;
    sched_getaffinity(0, sizeof permitted, &permitted);
    int cpu = 0;
    while (!CPU_ISSET(cpu, &permitted)) ++cpu;
    const RealTimeResult result = ApplyRealTime({.priority = 1, .cpu = cpu});
    if (!result.cpu || sched_getcpu() != cpu) return 1;
    if ((sched_getscheduler(0) == SCHED_FIFO) != result.priority) return 2;
    return result.warnings.size() == (result.priority ? 0u : 1u) ? 0 : 3;
  });
  EXPECT_EQ(outcome.exit_code, 0) << outcome.stderr_text;
}

// Tests that a priority that does not exist is refused with the range that does.
TEST(RealTimeTest, NamesTheRangeOfPriorities) {
  const Outcome outcome = InChild([] { return ApplyRealTime({.priority = 1000}).priority ? 1 : 0; });
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.stderr_text, HasSubstr("priorities are 1 to 99"));
}

}  // namespace
}  // namespace hydro::timing
