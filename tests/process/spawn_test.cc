#include "process/spawn.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

#include "process/process_end.h"

namespace hydro::process {
namespace {

using ::testing::HasSubstr;

struct Finished {
  ProcessEnd end;
  std::string said;  // on stdout
  std::vector<std::string> warnings;
};

Finished RunToEnd(SpawnRequest request) {
  std::array<int, 2> pipe_ends{};
  EXPECT_EQ(pipe2(pipe_ends.data(), O_CLOEXEC), 0);
  request.out = pipe_ends[1];
  const Spawned spawned = Spawn(request);
  close(pipe_ends[1]);
  Finished finished;
  finished.warnings = spawned.warnings;
  std::array<char, 4096> bytes{};
  for (ssize_t n; (n = read(pipe_ends[0], bytes.data(), bytes.size())) > 0;) {
    finished.said.append(bytes.data(), static_cast<size_t>(n));
  }
  close(pipe_ends[0]);
  int status = 0;
  waitpid(spawned.pid, &status, 0);
  finished.end = EndOf(status);
  return finished;
}

std::string ErrorOf(const SpawnRequest& request) {
  try {
    Spawn(request);
  } catch (const StartError& error) {
    return error.what();
  }
  return "no error";
}

// Tests that a program runs where and with what it is told, reads nothing, and leads a process group.
TEST(SpawnTest, RunsWithWhatItIsTold) {
  const Finished finished =
      RunToEnd({.argv = {"/bin/sh", "-c", "read x || echo $A $PWD $(ps -o pgid= -p $$) $$; exit 3"},
                .environment = std::vector<std::string>{"A=b", "PATH=/bin:/usr/bin"},
                .folder = "/"});
  EXPECT_EQ(finished.end.exit_code, 3);
  EXPECT_EQ(finished.end.signal, 0);
  EXPECT_EQ(finished.said.substr(0, 4), "b / ");
  const std::string ids = finished.said.substr(4, finished.said.size() - 5);
  EXPECT_EQ(ids.substr(0, ids.find(' ')), ids.substr(ids.find(' ') + 1)) << finished.said;
}

// Tests what is said of a program that ended, and of one that does not start.
TEST(SpawnTest, SaysHowItEnded) {
  EXPECT_EQ(DescribeEnd("a", RunToEnd({.argv = {"/bin/sh", "-c", "kill -9 $$"}}).end),
            "a was killed by signal 9 (SIGKILL)");
  EXPECT_THAT(ErrorOf({.argv = {"/no/such"}}), HasSubstr("/no/such: cannot be started: No such file"));
  EXPECT_THAT(ErrorOf({.argv = {"/bin/sh"}, .folder = "/no/such"}),
              HasSubstr("cannot be started in /no/such: "));
  EXPECT_THAT(ErrorOf({.argv = {"/etc/passwd"}}), HasSubstr("Permission denied"));
}

// Tests that a processor that there is not is a warning, and the program runs.
TEST(SpawnTest, RunsWithoutWhatIsRefused) {
  const Finished finished = RunToEnd({.argv = {"/bin/sh", "-c", "echo on"}, .cpu = 1023});
  EXPECT_EQ(finished.said, "on\n");
  ASSERT_EQ(finished.warnings.size(), 1u);
  EXPECT_THAT(finished.warnings[0], HasSubstr("processor 1023 is refused"));
}

}  // namespace
}  // namespace hydro::process
