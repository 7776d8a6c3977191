// The writing half of a logger, turn by turn.
#include "logger/recording.h"

#include <gmock/gmock.h>

#include "bus/in_process_bus.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::logger {
namespace {

class RecordingTest : public log::LogTest {
 protected:
  static void Push(Recording& recording, const std::string& text) {
    recording.queue().Push("A", text.data(), text.size(), 0);
  }
  bus::SimulatedClock clock_;
};

// Tests that what waits is in the file after a turn and not before, and that the end carries the remarks.
TEST_F(RecordingTest, WritesInTurns) {
  Recording recording({Path("log"), 0, 1 << 20}, "HYDRO_RUN", clock_);
  Push(recording, "one");
  Push(recording, "two");
  EXPECT_EQ(log::ReadBytes(Path("log")).size(), 0u);
  recording.WriteWaiting(false);
  EXPECT_EQ(recording.TakeWrites().size(), 1u);
  EXPECT_TRUE(recording.TakeWrites().empty());
  EXPECT_GT(log::ReadBytes(Path("log")).size(), 0u);
  Push(recording, "three");
  recording.WriteWaiting(true);
  recording.Finish({"something was left out"});
  EXPECT_EQ(log::ReadEvents(Path("log")).size(), 3u);
  const log::LogReader reader(Path("log"));
  EXPECT_EQ(reader.verdict().completeness, log::Completeness::kComplete);
  EXPECT_THAT(reader.verdict().remarks, ::testing::ElementsAre("something was left out"));
}

// Tests that a write that fails ends the recording, with the reason for who asks and for Finish().
TEST_F(RecordingTest, AFullDisk) {
  Recording recording({"/dev/full", 0, 1 << 20}, "HYDRO_RUN", clock_);
  Push(recording, "one");
  recording.WriteWaiting(false);
  EXPECT_TRUE(recording.failed());
  EXPECT_THAT(recording.FailureText(), ::testing::HasSubstr("/dev/full"));
  EXPECT_TRUE(recording.TakeWrites().empty());
  EXPECT_THROW(recording.Finish({}), WriteError);
}

// Tests that the thread writes what waited when it is closed.
TEST_F(RecordingTest, TheThreadWritesAll) {
  Recording recording({Path("log"), 0, 1 << 20}, "HYDRO_RUN", clock_);
  {
    WritingThread thread(recording);
    for (int k = 0; k < 100; ++k) Push(recording, std::to_string(k));
    thread.Close();
  }
  recording.Finish({});
  EXPECT_EQ(log::ReadEvents(Path("log")).size(), 100u);
}

}  // namespace
}  // namespace hydro::logger
