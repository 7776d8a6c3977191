#include "logger/logger_app.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <hydro/log_progress_t.hpp>
#include <hydro/loop_statistics_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>
#include <string>
#include <thread>
#include <vector>

#include "bus/in_process_bus.h"
#include "settings/input_error.h"
#include "tests/logger/log_fixture.h"
#include "tests/stack_fixture.h"

namespace hydro {
namespace {

using testing::SmallStack;

// The logger on an in-process bus; the test sends what it records.
class LoggerAppTest : public LogTest {
 protected:
  LoggerAppTest() {
    bus_.Subscribe<log_progress_t>("HYDRO_LOG_PROGRESS",
                                   [this](const log_progress_t& p) { progress_.push_back(p); });
  }

  void Deliver() {
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
  }

  void SendStates(int64_t from, int64_t to) {
    for (int64_t tick = from; tick <= to; ++tick) {
      state_t state{};
      state.tick = state.sequence = tick;
      state.session = 3;
      bus_.Publish("HYDRO_STATE", state);
      Deliver();
    }
  }

  static std::vector<int64_t> StateTicks(const std::string& file) {
    std::vector<int64_t> ticks;
    LogReader reader(file);
    LogEvent event;
    state_t state;
    while (reader.Next(event)) {
      if (event.channel == "HYDRO_STATE" && DecodeAs(event, state)) ticks.push_back(state.tick);
    }
    return ticks;
  }

  std::string file_ = Path("run.lcmlog");
  SimulatedClock clock_;
  InProcessBus bus_{&clock_};
  std::vector<log_progress_t> progress_;
};

// Tests that every message is in the file, in order, and that progress is told in steps the plant can wait
// for.
TEST_F(LoggerAppTest, RecordsEverything) {
  LoggerApp logger(bus_, clock_, SmallStack(), {file_, 0});
  SendStates(0, 999);
  EXPECT_EQ(logger.Finish(), 0);
  const std::vector<int64_t> ticks = StateTicks(file_);
  ASSERT_EQ(ticks.size(), 1000u);
  for (int64_t i = 0; i < 1000; ++i) EXPECT_EQ(ticks[static_cast<size_t>(i)], i);
  ASSERT_GE(progress_.size(), 60u);
  for (size_t i = 1; i < progress_.size(); ++i) EXPECT_LE(progress_[i].tick - progress_[i - 1].tick, 16);
  EXPECT_GE(progress_.back().tick, 984);
}

// Tests that rotation loses nothing and that each file begins with the run's description.
TEST_F(LoggerAppTest, RotatesBySize) {
  LoggerApp logger(bus_, clock_, SmallStack(), {file_, 20000});
  run_description_t description;
  description.config_file = "the configuration";
  bus_.Publish("HYDRO_RUN", description);
  SendStates(0, 999);
  EXPECT_EQ(logger.Finish(), 0);
  std::vector<int64_t> all;
  int files = 0;
  for (; std::filesystem::exists(RotatedName(file_, files)); ++files) {
    const std::string name = RotatedName(file_, files);
    EXPECT_LT(std::filesystem::file_size(name), 21000u);
    LogReader reader(name);
    LogEvent event;
    bool described = false;
    for (int i = 0; i < 5 && reader.Next(event); ++i) described = described || event.channel == "HYDRO_RUN";
    EXPECT_TRUE(described) << name;
    for (const int64_t tick : StateTicks(name)) all.push_back(tick);
    if (files > 0) std::filesystem::remove(name);
  }
  EXPECT_GE(files, 5);
  ASSERT_EQ(all.size(), 1000u);
  for (int64_t i = 0; i < 1000; ++i) EXPECT_EQ(all[static_cast<size_t>(i)], i);
}

// Tests that the logger ends by itself after a stop, once all whom it had seen have said farewell.
TEST_F(LoggerAppTest, EndsAfterEveryonesFarewell) {
  LoggerApp logger(bus_, clock_, SmallStack(), {file_, 0});
  process_status_t plant;
  plant.role = "plant";
  plant.session = 3;
  plant.state = process_status_t::RUNNING;
  bus_.Publish("HYDRO_PROCESS_STATUS", plant);
  stop_t stop{};
  bus_.Publish("HYDRO_STOP", stop);
  Deliver();
  logger.Poll();
  EXPECT_FALSE(logger.finished());
  plant.state = process_status_t::DONE;
  bus_.Publish("HYDRO_PROCESS_STATUS", plant);
  Deliver();
  EXPECT_TRUE(logger.finished());
  EXPECT_EQ(logger.Finish(), 0);
}

// Tests that a file that cannot be created is bad input.
TEST_F(LoggerAppTest, RefusesAnImpossibleFile) {
  EXPECT_THROW(LoggerApp(bus_, clock_, SmallStack(), {"/no/such/folder/x.lcmlog", 0}), InputError);
}

// Tests the names of rotated files.
TEST(RotatedNameTest, NumbersBeforeTheExtension) {
  EXPECT_EQ(RotatedName("run.lcmlog", 0), "run.lcmlog");
  EXPECT_EQ(RotatedName("out/run.lcmlog", 2), "out/run-002.lcmlog");
  EXPECT_EQ(RotatedName("run", 1), "run-001");
}

// A clock whose wall time can be set while it runs; safe to read from any thread.
class ClockThatIsSet : public Clock {
 public:
  TimePoint Now() const override { return TimePoint(std::chrono::milliseconds(now_ms_)); }
  int64_t Utime() const override { return WallClock().Utime() + utime_offset_; }
  bool simulated() const override { return true; }
  void Advance(int64_t ms) { now_ms_ += ms; }
  void SetBy(int64_t us) { utime_offset_ += us; }

 private:
  std::atomic<int64_t> now_ms_ = 0;
  std::atomic<int64_t> utime_offset_ = 0;
};

// Tests that the time from arrival to write is no business of the wall clock: it is set by 10 s forwards, and
// back, between arrivals and writes.
TEST_F(LoggerAppTest, LatencyWhileTheWallClockIsSet) {
  ClockThatIsSet clock;
  InProcessBus bus(nullptr);  // stamps what it delivers with the wall clock
  std::vector<loop_statistics_t> reports;
  LoggerApp logger(bus, clock, SmallStack(), {file_, 0});
  bus.Subscribe<loop_statistics_t>("HYDRO_LOOP_STATISTICS",
                                   [&](const loop_statistics_t& report) { reports.push_back(report); });
  int64_t cycles = 0;
  for (int64_t tick = 0; tick < 4000 && cycles < 20; ++tick) {
    state_t state{};
    state.tick = state.sequence = tick;
    state.session = 3;
    bus.Publish("HYDRO_STATE", state);
    bus.HandleUntil(Clock::TimePoint::min());
    clock.SetBy(tick % 2 == 0 ? 10'000'000 : -10'000'000);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    clock.Advance(100);
    logger.Poll();
    while (bus.HandleUntil(Clock::TimePoint::min()) > 0) {
    }
    cycles = 0;
    for (const loop_statistics_t& report : reports) cycles += report.cycles;
  }
  ASSERT_GE(cycles, 20);
  for (const loop_statistics_t& report : reports) {
    EXPECT_LT(report.latency_max_us, 9e6);
    EXPECT_GE(report.latency_p50_us, 0);
  }
  EXPECT_EQ(logger.Finish(), 0);
}

}  // namespace
}  // namespace hydro
