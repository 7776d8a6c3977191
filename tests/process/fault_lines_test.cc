// How many lines about a fault that comes and goes reach the terminal, and how many messages the bus.
#include "process/fault_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <hydro/fault_t.hpp>
#include <memory>
#include <sstream>

#include "bus/in_process_bus.h"
#include "process/participant.h"

namespace hydro::process {
namespace {

using namespace std::chrono_literals;
using bus::Clock;
using testing::HasSubstr;

// Tests that a fault that comes and goes for ten minutes, at whatever pace, gets a few lines at once and two
// in each ten seconds after that, and that none of its changes is missing from the sum.
TEST(FaultLinesTest, Bounded) {
  for (const auto pace : {10ms, 100ms, 1100ms, 3000ms}) {
    FaultLines lines;
    int64_t shown = 0, said = 0, left_out = 0, changes = 0;
    for (Clock::TimePoint now{1h}; now < Clock::TimePoint{70min}; now += pace) {
      ++changes;
      shown += lines.Show("device_fault", now) ? 1 : 0;
      for (const auto& each : lines.TakeDue(now)) {
        ++said;
        left_out += each.lines;
      }
    }
    for (const auto& each : lines.TakeDue(Clock::TimePoint{70min}, true)) left_out += each.lines;
    EXPECT_EQ(shown + left_out, changes) << pace.count();
    EXPECT_LE(shown, FaultLines::kAtOnce + 60) << pace.count();
    EXPECT_LE(said, 60) << pace.count();
    EXPECT_GT(said, 15) << pace.count();
  }
}

// Tests that changes which are rare each have a line.
TEST(FaultLinesTest, RareChanges) {
  FaultLines lines;
  Clock::TimePoint now{1h};
  for (int i = 0; i < 100; ++i, now += 10s) EXPECT_TRUE(lines.Show("device_fault", now)) << i;
  EXPECT_EQ(lines.due(), Clock::TimePoint::max());
}

// Tests that a flickering fault hides no other one, and that what was left out is said a second after the
// last change.
TEST(FaultLinesTest, SaidOnceItIsQuiet) {
  FaultLines lines;
  Clock::TimePoint now{1h};
  for (int i = 0; i < 20; ++i, now += 1ms) lines.Show("device_fault", now);
  EXPECT_TRUE(lines.hides("device_fault"));
  EXPECT_TRUE(lines.Show("sensor_p1", now));
  EXPECT_FALSE(lines.hides("sensor_p1"));
  const auto last = now - 1ms;
  EXPECT_EQ(lines.due(), last + 1s);
  EXPECT_TRUE(lines.TakeDue(last + 999ms).empty());
  const auto left_out = lines.TakeDue(last + 1s);
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_EQ(left_out[0].code, "device_fault");
  EXPECT_EQ(left_out[0].lines, 14);
  EXPECT_FALSE(lines.hides("device_fault"));
  EXPECT_EQ(lines.due(), Clock::TimePoint::max());
}

// A clock that the test sets, of a process that writes to a terminal.
class SetClock : public Clock {
 public:
  SetClock() : Clock(TimePoint{1h}) {}
  void Advance(Duration by) { SetTo(Now() + by); }
  int64_t Utime() const override { return 1; }
};

// What is written to the terminal meanwhile.
class TerminalText {
 public:
  TerminalText() : before_(spdlog::default_logger()) {
    const auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(text_);
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
    spdlog::set_pattern("%v");
  }
  ~TerminalText() { spdlog::set_default_logger(before_); }
  std::string text() const { return text_.str(); }
  int64_t lines() const {
    const std::string all = text();
    return std::count(all.begin(), all.end(), '\n');
  }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

struct Flicker {
  Flicker() {
    bus.Subscribe<fault_t>("HYDRO_FAULT", [this](const fault_t& fault) { faults.push_back(fault); });
  }
  // The fault is there in every second tick of a millisecond, for so many of them.
  void Ticks(int count) {
    for (int i = 0; i < count; ++i) {
      if (i % 2 == 0) participant.Raise("device_fault", "it reports a fault", NAN, NAN, false);
      if (i % 2 == 1) participant.Clear("device_fault");
      Wait(1ms);
    }
  }
  void Wait(Clock::Duration by) {
    clock.Advance(by);
    participant.Poll();
    bus.HandleUntil(Clock::TimePoint::min());  // what waits, at once
  }

  SetClock clock;
  bus::InProcessBus bus{clock};
  Participant participant{bus, clock, bus::Channels(""), "driver"};
  std::vector<fault_t> faults;
};

// Tests that every change of a fault that flickers is published, that the terminal gets a bounded number of
// lines, and that these say how many were left out and whether the fault is there.
TEST(FaultLinesTest, MessagesHaveEveryChange) {
  const TerminalText terminal;
  Flicker flicker;
  flicker.Ticks(30'001);
  EXPECT_EQ(flicker.faults.size(), 30'001U);
  EXPECT_TRUE(flicker.participant.active("device_fault"));
  EXPECT_LE(terminal.lines(), FaultLines::kAtOnce + 2 * 3);
  flicker.Wait(FaultLines::kPeriod);
  EXPECT_LE(terminal.lines(), FaultLines::kAtOnce + 2 * 4);
  EXPECT_THAT(terminal.text(),
              HasSubstr("fault device_fault: it reports a fault\nfault device_fault has gone\n"));
  EXPECT_THAT(terminal.text(), HasSubstr("comes and goes; lines about it that were not shown: "));
  EXPECT_TRUE(terminal.text().ends_with("; now it is there: it reports a fault\n")) << terminal.text();
}

// Tests that a run that ends says what was left out, and that the reason of its end is said although the line
// of its fault was not.
TEST(FaultLinesTest, SaidAtTheEnd) {
  const TerminalText terminal;
  Flicker flicker;
  flicker.Ticks(101);
  flicker.participant.RequestStop("it ends: it reports a fault", 1);
  EXPECT_THAT(terminal.text(), HasSubstr("\nit ends: it reports a fault\n"));
  flicker.participant.Leave();
  EXPECT_TRUE(terminal.text().ends_with(
      "lines about it that were not shown: 95; now it is there: it reports a fault\n"))
      << terminal.text();
}

}  // namespace
}  // namespace hydro::process
