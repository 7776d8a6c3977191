#include "runs/compare.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "runs/message_fields.h"
#include "tests/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Optional;
using testing::StartsWith;

std::optional<std::string> Difference(const RunMessages& a, const RunMessages& b) {
  return FirstDifference(a, "a.lcmlog", b, "b.lcmlog");
}

// The smallest possible change.
void Change(double& value) { value = std::nextafter(value, std::numeric_limits<double>::infinity()); }
void Change(int64_t& value) { ++value; }
void Change(int8_t& value) { ++value; }
void Change(std::string& value) { value += '.'; }

// Changes each field of the message that `pick` returns in turn, and expects it to be named.
template <class Pick>
void ExpectEachFieldNamed(const std::string& channel, Pick pick) {
  const RunMessages a = log::SampleRun(12);
  const auto expect_named = [&](const auto& field) {
    RunMessages b = a;
    auto& message = pick(b);
    const int64_t tick = message.tick;
    Change(message.*field.member);
    const std::optional<std::string> difference = Difference(a, b);
    ASSERT_TRUE(difference.has_value()) << channel << "." << field.name;
    if (std::string(field.name) == "tick")
      return;  // then it is a message that is missing: see MissingMessage
    EXPECT_THAT(*difference, AllOf(StartsWith("differ at tick " + std::to_string(tick) + ": " + channel +
                                              "." + field.name + ": "),
                                   HasSubstr(" (a.lcmlog) and "), EndsWith(" (b.lcmlog)")));
  };
  std::apply(
      [&](const auto&... field) { (expect_named(field), ...); },
      FieldsOf(static_cast<std::remove_reference_t<decltype(pick(std::declval<RunMessages&>()))>*>(nullptr)));
}

// Tests that the smallest difference of any one field of any message is found and named.
TEST(CompareTest, EachFieldOfEachMessage) {
  ExpectEachFieldNamed("HYDRO_STATE", [](RunMessages& run) -> state_t& { return run.states[8]; });
  ExpectEachFieldNamed("HYDRO_MOTOR_COMMAND",
                       [](RunMessages& run) -> motor_command_t& { return run.motor_commands[7]; });
  ExpectEachFieldNamed("HYDRO_PRESSURE_COMMAND",
                       [](RunMessages& run) -> pressure_command_t& { return run.pressure_commands[1]; });
  ExpectEachFieldNamed("HYDRO_ARM_REFERENCE",
                       [](RunMessages& run) -> arm_reference_t& { return run.arm_references[2]; });
  ExpectEachFieldNamed("HYDRO_FAULT", [](RunMessages& run) -> fault_t& { return run.faults[0]; });
}

// Tests the whole line.
TEST(CompareTest, Line) {
  RunMessages a = log::SampleRun(3);
  RunMessages b = a;
  a.states[1].p2 = 101.25;
  b.states[1].p2 = 101.26;
  EXPECT_THAT(Difference(a, b),
              Optional(std::string("differ at tick 1: HYDRO_STATE.p2: 101.25 (a.lcmlog) and 101.26 "
                                   "(b.lcmlog)")));
}

// Tests that wall-clock fields are left out.
TEST(CompareTest, WallClockAndSessionsDoNotMatter) {
  const RunMessages a = log::SampleRun(12);
  RunMessages b = a;
  const auto change = [](auto& messages) {
    for (auto& message : messages) {
      message.utime += 12345;
      message.session += 99;
    }
  };
  change(b.states);
  change(b.motor_commands);
  change(b.pressure_commands);
  change(b.arm_references);
  change(b.faults);
  EXPECT_EQ(Difference(a, b), std::nullopt);
}

// Tests that neither the order of arrival nor a resent message makes a difference.
TEST(CompareTest, OrderAndRepetitionDoNotMatter) {
  const RunMessages a = log::SampleRun(40);
  RunMessages b = a;
  std::mt19937_64 random(1);
  std::shuffle(b.states.begin(), b.states.end(), random);
  std::shuffle(b.motor_commands.begin(), b.motor_commands.end(), random);
  std::reverse(b.arm_references.begin(), b.arm_references.end());
  b.states.push_back(b.states[3]);
  b.states.back().utime += 1;  // sent again, later
  b.pressure_commands.push_back(b.pressure_commands[2]);
  EXPECT_EQ(Difference(a, b), std::nullopt);
  EXPECT_EQ(Difference(b, a), std::nullopt);
}

// Tests that a second message of the same tick and number with other contents is a difference.
TEST(CompareTest, ContradictoryRepetition) {
  const RunMessages a = log::SampleRun(12);
  RunMessages b = a;
  b.motor_commands.push_back(b.motor_commands[3]);
  b.motor_commands.back().voltage += 1;
  EXPECT_THAT(Difference(a, b), Optional(StartsWith("differ at tick ")));
}

// Tests that a message missing at the start, in the middle or at the end of either run is named.
TEST(CompareTest, MissingMessage) {
  const RunMessages whole = log::SampleRun(12);
  for (const int64_t tick : {0, 6, 11}) {
    RunMessages part = whole;
    part.states.erase(part.states.begin() + tick);
    const std::string place = "differ at tick " + std::to_string(tick) + ": HYDRO_STATE: no such message in ";
    const std::string number = ", sequence " + std::to_string(tick) + " in ";
    EXPECT_THAT(Difference(part, whole), Optional(place + "a.lcmlog" + number + "b.lcmlog"));
    EXPECT_THAT(Difference(whole, part), Optional(place + "b.lcmlog" + number + "a.lcmlog"));
  }
}

// Tests that of several differences the one of the lowest tick is named, and within a tick the state's.
TEST(CompareTest, NamesTheFirst) {
  const RunMessages a = log::SampleRun(12);
  RunMessages b = a;
  b.states[9].p1 += 1;
  b.motor_commands[4].voltage += 1;
  EXPECT_THAT(Difference(a, b), Optional(StartsWith("differ at tick 4: HYDRO_MOTOR_COMMAND.voltage")));
  b.states[4].p1 += 1;
  EXPECT_THAT(Difference(a, b), Optional(StartsWith("differ at tick 4: HYDRO_STATE.p1")));
}

// Tests that doubles are compared by their bits.
TEST(CompareTest, BitsOfDoubles) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RunMessages a = log::SampleRun(3);
  a.states[1].p1 = nan;
  RunMessages b = a;
  EXPECT_EQ(Difference(a, b), std::nullopt);
  b.states[1].p1 = std::bit_cast<double>(std::bit_cast<uint64_t>(nan) + 1);
  EXPECT_THAT(Difference(a, b),
              Optional(HasSubstr("nan (0x7ff8000000000000) (a.lcmlog) and nan (0x7ff8000000000001)")));
  a.states[1].p1 = 0.0;
  b.states[1].p1 = -0.0;
  EXPECT_THAT(Difference(a, b), Optional(HasSubstr("p1: 0 (a.lcmlog) and -0 (b.lcmlog)")));
}

// Tests that faults of two processes with the same tick and number are told apart, in whatever order they
// arrived.
TEST(CompareTest, FaultsOfTwoProcesses) {
  RunMessages a = log::SampleRun(3);
  a.faults.push_back(a.faults[0]);
  a.faults.back().source = "plant";
  RunMessages b = a;
  std::swap(b.faults[0], b.faults[1]);
  EXPECT_EQ(Difference(a, b), std::nullopt);
  b.faults.pop_back();
  EXPECT_NE(Difference(a, b), std::nullopt);
}

}  // namespace
}  // namespace hydro::runs
