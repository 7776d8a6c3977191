#include "scope/signals/log_run.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "base/input_error.h"
#include "log/log_writer.h"
#include "tests/scope/recorded_run.h"

namespace hydro::scope {
namespace {

std::string TestFile(const std::string& name) { return ::testing::TempDir() + "/scope_" + name; }

// Tests that a log opens as its run: every tick, its configuration, and its name.
TEST(LogRunTest, OpensALog) {
  const std::string file = TestFile("log.lcmlog");
  log::LogWriter writer(file, Opening::kTemporary);
  for (const RecordedMessage& message : Record(DemoConfig({"time.mode=lockstep", "time.duration_s=1"}))) {
    writer.Append(message.channel, message.data.data(), message.data.size(), message.utime);
  }
  writer.Finish();
  std::string problem;
  const auto runs = OpenLogRuns(file, "log.lcmlog", &problem);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(problem, "");
  EXPECT_EQ(runs[0]->ticks.end(), 1001u);
  EXPECT_EQ(runs[0]->last_time(), 1);
  EXPECT_EQ(runs[0]->name, "log.lcmlog");
  EXPECT_EQ(runs[0]->log_file, file);
  EXPECT_NE(runs[0]->config, nullptr);
  std::remove(file.c_str());
}

// Tests that what is no log is refused.
TEST(LogRunTest, RefusesOthers) {
  const std::string file = TestFile("text.lcmlog");
  std::ofstream(file) << "no log";
  std::string problem;
  EXPECT_THROW(OpenLogRuns(file, "text", &problem), InputError);
  std::remove(file.c_str());
  EXPECT_THROW(OpenLogRuns(file, "nothing", &problem), InputError);
}

}  // namespace
}  // namespace hydro::scope
