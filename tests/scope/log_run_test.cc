#include "scope/signals/log_run.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <hydro/process_status_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>

#include "base/input_error.h"
#include "runs/log/log_writer.h"
#include "tests/scope/recorded_run.h"

namespace hydro::scope {
namespace {

// What a run of this test before left is removed.
std::string TestFile(const std::string& name) {
  std::string file = ::testing::TempDir() + "/scope_" + name;
  std::filesystem::remove(file);
  return file;
}

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

// Tests that each joint of a limb is a run, in the order of its configuration, that one can be chosen, and
// that what the limb itself says counts for each.
TEST(LogRunTest, OpensTheJointsOfALimb) {
  const std::string file = TestFile("limb.lcmlog");
  log::LogWriter writer(file, Opening::kTemporary);
  process_status_t limb{};
  limb.role = "limb";
  limb.host = "here";
  for (const char* joint : {"hip", "knee"}) {
    const std::string suffix = std::string("_") + joint;
    for (const RecordedMessage& message :
         Record(DemoConfig({"time.mode=lockstep", "time.duration_s=0.5", "bus.channel_suffix=" + suffix}))) {
      writer.Append(message.channel, message.data.data(), message.data.size(), message.utime);
    }
  }
  run_description_t description{};
  description.config_text = "[[joint]]\nname = 'knee'\n[[joint]]\nname = 'hip'\n";
  writer.AppendMessage("HYDRO_RUN", description, 0);
  const RecordedMessage status = Encoded("HYDRO_PROCESS_STATUS", limb, 0);
  writer.Append(status.channel, status.data.data(), status.data.size(), status.utime);
  writer.Finish();
  std::string problem;
  const auto runs = OpenLogRuns(file, "limb.lcmlog", &problem);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0]->name, "knee of limb.lcmlog");
  EXPECT_EQ(runs[1]->name, "hip of limb.lcmlog");
  EXPECT_EQ(runs[0]->suffix, "_knee");
  for (const auto& run : runs) {
    EXPECT_EQ(run->ticks.end(), 501u);
    EXPECT_TRUE(run->processes.contains("limb on here"));
  }
  EXPECT_EQ(OpenLogRuns(file, "limb.lcmlog", &problem, {.joint = "knee"}).size(), 1u);
  EXPECT_THROW(OpenLogRuns(file, "limb.lcmlog", &problem, {.joint = "ankle"}), InputError);
  std::remove(file.c_str());
}

// Tests that what a limb leaves out between two samples is no gap, and that a sample lasts until the next.
TEST(LogRunTest, SamplesOfALimbAreNoGaps) {
  for (const bool of_a_limb : {false, true}) {
    const std::string file = TestFile(of_a_limb ? "sampled.lcmlog" : "lacking.lcmlog");
    log::LogWriter log(file, Opening::kTemporary);
    run_description_t description{};
    description.session = 5;
    description.program = of_a_limb ? "hydro-limb" : "hydro-plant";
    description.rate_hz = 1000;
    log.AppendMessage("HYDRO_RUN", description, 0);
    for (int64_t sample = 0; sample < 50; ++sample) {
      state_t state{};
      state.session = 5;
      state.sequence = sample;
      state.tick = 20 * sample;
      state.time = 0.02 * static_cast<double>(sample);
      log.AppendMessage("HYDRO_STATE", state, 20000 * sample);
    }
    log.Finish();
    std::string problem;
    const auto runs = OpenLogRuns(file, "sampled", &problem);
    ASSERT_EQ(runs.size(), 1u);
    EXPECT_EQ(runs[0]->sample_ticks, of_a_limb ? 20 : 1);
    EXPECT_EQ(runs[0]->events.last(), of_a_limb ? 0u : 49u);
    EXPECT_EQ(runs[0]->Find("p1")->hold, of_a_limb ? 2.5 * 0.02 : 0);
    EXPECT_EQ(runs[0]->spacing(), of_a_limb ? 0 : 0.001);
    std::remove(file.c_str());
  }
}

}  // namespace
}  // namespace hydro::scope
