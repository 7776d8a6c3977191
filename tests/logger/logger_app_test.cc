#include "logger/logger_app.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <hydro/fault_t.hpp>
#include <hydro/log_progress_t.hpp>
#include <hydro/loop_statistics_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/input_error.h"
#include "bus/in_process_bus.h"
#include "logger/recording.h"
#include "tests/runs/log/log_fixture.h"
#include "tests/stack_fixture.h"

namespace hydro::logger {
namespace {

using namespace std::chrono_literals;
using testing::SmallStack;

// The logger on an in-process bus; the test sends what it records.
class LoggerAppTest : public log::LogTest {
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
    log::LogReader reader(file);
    log::LogEvent event;
    state_t state;
    while (reader.Next(event)) {
      if (event.channel == "HYDRO_STATE" && log::DecodeAs(event, state)) ticks.push_back(state.tick);
    }
    return ticks;
  }

  std::string file_ = Path("run.lcmlog");
  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  std::vector<log_progress_t> progress_;
};

// Tests that every message is in the file, in order, and that progress is reported in steps that the plant
// can wait for.
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
    log::LogReader reader(name);
    log::LogEvent event;
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

// Tests that each file of a rotation says that it is whole and where the recording goes on, and the last that
// it is the end.
TEST_F(LoggerAppTest, RotationIsNoCut) {
  LoggerApp logger(bus_, clock_, SmallStack(), {file_, 20000});
  SendStates(0, 299);
  EXPECT_EQ(logger.Finish(), 0);
  int files = 0;
  while (std::filesystem::exists(RotatedName(file_, files + 1))) ++files;
  ASSERT_GT(files, 0);
  for (int n = 0; n <= files; ++n) {
    const log::LogVerdict verdict = log::LogReader(RotatedName(file_, n)).verdict();
    EXPECT_EQ(verdict.completeness, log::Completeness::kComplete);
    const std::string next = std::filesystem::path(RotatedName(file_, n + 1)).filename().string();
    EXPECT_EQ(verdict.ending, n == files ? "" : "goes on in " + next);
  }
}

// Tests that the files of a rotation joined in order are one complete log, and that one that is missing,
// repeated or in another place is noticed.
TEST_F(LoggerAppTest, JoinedParts) {
  LoggerApp logger(bus_, clock_, SmallStack(), {file_, 20000});
  SendStates(0, 299);
  EXPECT_EQ(logger.Finish(), 0);
  std::vector<std::string> parts;
  for (int n = 0; std::filesystem::exists(RotatedName(file_, n)); ++n)
    parts.push_back(log::ReadBytes(RotatedName(file_, n)));
  ASSERT_GE(parts.size(), 3u);
  const auto verdict = [&](std::vector<size_t> order) {
    std::string bytes;
    for (const size_t part : order) bytes += parts[part];
    ForgetRead(Path("joined"));
    log::WriteBytes(Path("joined"), bytes);
    return log::LogReader(Path("joined"), log::OnDamage::kStop).verdict();
  };
  EXPECT_EQ(verdict({0, 1, 2}).completeness, log::Completeness::kComplete);
  EXPECT_EQ(verdict({1, 2}).completeness, log::Completeness::kComplete);
  EXPECT_EQ(verdict({1, 2}).note, "a later part of a recording");
  for (const auto& wrong : std::vector<std::vector<size_t>>{{0, 2}, {0, 0}, {0, 1, 1}, {1, 0}, {0, 2, 1}}) {
    EXPECT_EQ(verdict(wrong).completeness, log::Completeness::kDamaged) << wrong[1];
    EXPECT_THAT(verdict(wrong).where, ::testing::HasSubstr("a part is missing, repeated or in another place"))
        << wrong[1];
  }
}

// Tests that a check event from the bus is not recorded, and that of refused messages a bounded number is,
// with a remark on the rest.
TEST_F(LoggerAppTest, RefusedMessagesAreBounded) {
  LoggerApp logger(bus_, clock_, SmallStack(), {file_, 0});
  const std::string data(100, 'x');
  bus_.PublishRaw(std::string(log::kCheckChannel), data.data(), 100);
  for (int k = 0; k < 3000; ++k) bus_.PublishRaw("REFUSED_HYDRO_MOTOR_COMMAND", data.data(), 100);
  Deliver();
  EXPECT_EQ(logger.Finish(), 0);
  int64_t refused = 0;
  for (const log::EventContents& event : log::ReadEvents(file_)) {
    refused += event.channel == "REFUSED_HYDRO_MOTOR_COMMAND";
  }
  EXPECT_EQ(refused, 1000);
  const log::LogVerdict verdict = log::LogReader(file_).verdict();
  EXPECT_EQ(verdict.completeness, log::Completeness::kComplete);
  ASSERT_EQ(verdict.remarks.size(), 1u);
  EXPECT_EQ(verdict.remarks[0].find("2000 refused messages (200000 bytes) were left out"), 0u);
}

// Tests that a log that is deleted while it is recorded ends the logger with 1, not before the stop.
TEST_F(LoggerAppTest, DeletedLog) {
  LoggerApp logger(bus_, clock_, SmallStack(), {file_, 0});
  SendStates(0, 9);
  std::filesystem::remove(file_);
  std::this_thread::sleep_for(1200ms);
  logger.Poll();
  EXPECT_FALSE(logger.finished());
  EXPECT_EQ(logger.Finish(), 1);
}

// Tests that the logger ends by itself after a stop, once all processes that it has seen have said farewell.
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

// A clock whose wall time can be set while it runs; any thread may read it.
class ClockThatIsSet : public bus::Clock {
 public:
  int64_t Utime() const override { return bus::WallClock().Utime() + utime_offset_; }
  bool simulated() const override { return true; }
  void Advance(int64_t ms) { now_ms_ += ms; }
  void SetBy(int64_t us) { utime_offset_ += us; }

 private:
  TimePoint Read() const override { return TimePoint(std::chrono::milliseconds(now_ms_)); }

  std::atomic<int64_t> now_ms_ = 0;
  std::atomic<int64_t> utime_offset_ = 0;
};

// Tests that the time from arrival to write does not depend on the wall clock, which is set by 10 s forwards,
// and back, between arrivals and writes.
TEST_F(LoggerAppTest, LatencyWhileTheWallClockIsSet) {
  ClockThatIsSet clock;
  bus::InProcessBus bus(nullptr);  // stamps what it delivers with the wall clock
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
    bus.HandleUntil(bus::Clock::TimePoint::min());
    clock.SetBy(tick % 2 == 0 ? 10'000'000 : -10'000'000);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    clock.Advance(100);
    logger.Poll();
    while (bus.HandleUntil(bus::Clock::TimePoint::min()) > 0) {
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

// Tests that a disk slower than the bus takes no more memory than allowed: what has no room is left out of
// the log, counted, and reported as a fault, which ends when the disk has caught up. The disk is a pipe that
// nobody reads for a while.
TEST_F(LoggerAppTest, SlowDisk) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  const int disk = open(file_.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(disk, 0);
  std::vector<fault_t> faults;
  bus_.Subscribe<fault_t>("HYDRO_FAULT", [&](const fault_t& fault) { faults.push_back(fault); });
  settings::StackConfig config = SmallStack();
  config.time.mode = settings::TimeMode::kRealtime;
  config.logger.memory_mb = 1;
  LoggerApp logger(bus_, clock_, config, {file_, 0});
  SendStates(0, 19'999);  // some 3.7 MB
  logger.Poll();
  Deliver();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].code, "log_overflow");
  EXPECT_NE(faults[0].active, 0);
  EXPECT_GT(faults[0].value, 5000);
  EXPECT_LT(faults[0].value, 20'000);

  // The disk is finally read, until the logger has closed it.
  std::vector<uint8_t> bytes;
  std::thread reader([&] {
    std::vector<uint8_t> buffer(1 << 16);
    const int end = open(file_.c_str(), O_RDONLY | O_CLOEXEC);
    close(disk);
    for (ssize_t size; (size = read(end, buffer.data(), buffer.size())) > 0;) {
      bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + size);
    }
    close(end);
  });
  const auto give_up = std::chrono::steady_clock::now() + 10s;
  while (faults.size() < 2 && std::chrono::steady_clock::now() < give_up) {
    clock_.AdvanceTo(clock_.Now() + 2s);
    logger.Poll();
    Deliver();
    std::this_thread::yield();
  }
  EXPECT_EQ(logger.Finish(), 0);
  reader.join();
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[1].active, 0);
  std::filesystem::remove(file_);
  std::ofstream(file_, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  // The oldest are all there, without a gap, and exactly as many as were not counted as lost; the logger's
  // own progress reports, one for 16 states, count too.
  const std::vector<int64_t> ticks = StateTicks(file_);
  EXPECT_GE(static_cast<double>(ticks.size()) + faults[0].value, 20'000);
  EXPECT_LE(static_cast<double>(ticks.size()) + faults[0].value, 20'000 * 17.0 / 16 + 10);
  for (size_t i = 0; i < ticks.size(); ++i) ASSERT_EQ(ticks[i], static_cast<int64_t>(i));
}

}  // namespace
}  // namespace hydro::logger
