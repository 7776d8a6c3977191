#include "runs/recorded/compare.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "runs/recorded/message_order.h"
#include "tests/runs/log/log_fixture.h"

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

// Changes each field of a message in turn, and expects it to be named.
template <class Message>
void ExpectEachFieldNamed(const std::string& channel) {
  const RunMessages a = log::SampleRun(12);
  ASSERT_FALSE(a.Of<Message>().empty()) << channel << ": SampleRun() needs one";
  const auto expect_named = [&](const auto& field) {
    RunMessages b = a;
    Message& message = b.Of<Message>()[b.Of<Message>().size() / 2];
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
  std::apply([&](const auto&... field) { (expect_named(field), ...); },
             FieldsOf(static_cast<const Message*>(nullptr)));
}

// Tests that the smallest difference of any one field of any message is found and named.
TEST(CompareTest, EachFieldOfEachMessage) {
  bus::ForEachMessage([]<class Message>(const bus::MessageRow<Message>& row) {
    if constexpr (ComparedMessage<Message>) ExpectEachFieldNamed<Message>(std::string(row.channel));
  });
}

// What LCM's encoding of a field's first value takes.
int EncodedSize(const std::string&) { return 5; }  // its length, and the zero at its end
template <class Number>
int EncodedSize(Number) {
  return sizeof(Number);
}

// Tests that the list of fields leaves out none except utime and session. A difference in a field that the
// list lacks would go unnoticed.
TEST(CompareTest, ListsEveryField) {
  bus::ForEachMessage([]<class Message>(const bus::MessageRow<Message>& row) {
    if constexpr (ComparedMessage<Message>) {
      const Message message{};
      int size = 8 + 8 + 8;  // the type's hash, utime, session
      std::apply([&](const auto&... field) { ((size += EncodedSize(message.*field.member)), ...); },
                 FieldsOf(&message));
      EXPECT_EQ(size, message.getEncodedSize()) << row.channel;
    }
  });
}

// Tests the whole line.
TEST(CompareTest, Line) {
  RunMessages a = log::SampleRun(3);
  RunMessages b = a;
  a.Of<state_t>()[1].p2 = 101.25;
  b.Of<state_t>()[1].p2 = 101.26;
  EXPECT_THAT(Difference(a, b),
              Optional(std::string("differ at tick 1: HYDRO_STATE.p2: 101.25 (a.lcmlog) and 101.26 "
                                   "(b.lcmlog)")));
}

// Tests that wall-clock fields are left out.
TEST(CompareTest, WallClockAndSessionsDoNotMatter) {
  const RunMessages a = log::SampleRun(12);
  RunMessages b = a;
  bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>&) {
    if constexpr (ComparedMessage<Message>) {
      for (Message& message : b.Of<Message>()) {
        message.utime += 12345;
        message.session += 99;
      }
    }
  });
  EXPECT_EQ(Difference(a, b), std::nullopt);
}

// Tests that neither the order of arrival nor a resent message makes a difference.
TEST(CompareTest, OrderAndRepetitionDoNotMatter) {
  const RunMessages a = log::SampleRun(40);
  RunMessages b = a;
  std::mt19937_64 random(1);
  std::shuffle(b.Of<state_t>().begin(), b.Of<state_t>().end(), random);
  std::shuffle(b.Of<motor_command_t>().begin(), b.Of<motor_command_t>().end(), random);
  std::reverse(b.Of<arm_reference_t>().begin(), b.Of<arm_reference_t>().end());
  b.Of<state_t>().push_back(b.Of<state_t>()[3]);
  b.Of<state_t>().back().utime += 1;  // sent again, later
  b.Of<pressure_command_t>().push_back(b.Of<pressure_command_t>()[2]);
  EXPECT_EQ(Difference(a, b), std::nullopt);
  EXPECT_EQ(Difference(b, a), std::nullopt);
}

// Tests that a second message of the same tick and number with other contents is a difference.
TEST(CompareTest, ContradictoryRepetition) {
  const RunMessages a = log::SampleRun(12);
  RunMessages b = a;
  b.Of<motor_command_t>().push_back(b.Of<motor_command_t>()[3]);
  b.Of<motor_command_t>().back().voltage += 1;
  EXPECT_THAT(Difference(a, b), Optional(StartsWith("differ at tick ")));
}

// Tests that a message missing at the start, in the middle or at the end of either run is named.
TEST(CompareTest, MissingMessage) {
  const RunMessages whole = log::SampleRun(12);
  for (const int64_t tick : {0, 6, 11}) {
    RunMessages part = whole;
    part.Of<state_t>().erase(part.Of<state_t>().begin() + tick);
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
  b.Of<state_t>()[9].p1 += 1;
  b.Of<motor_command_t>()[4].voltage += 1;
  EXPECT_THAT(Difference(a, b), Optional(StartsWith("differ at tick 4: HYDRO_MOTOR_COMMAND.voltage")));
  b.Of<state_t>()[4].p1 += 1;
  EXPECT_THAT(Difference(a, b), Optional(StartsWith("differ at tick 4: HYDRO_STATE.p1")));
}

// Tests that doubles are compared by their bits.
TEST(CompareTest, BitsOfDoubles) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RunMessages a = log::SampleRun(3);
  a.Of<state_t>()[1].p1 = nan;
  RunMessages b = a;
  EXPECT_EQ(Difference(a, b), std::nullopt);
  b.Of<state_t>()[1].p1 = std::bit_cast<double>(std::bit_cast<uint64_t>(nan) + 1);
  EXPECT_THAT(Difference(a, b),
              Optional(HasSubstr("nan (0x7ff8000000000000) (a.lcmlog) and nan (0x7ff8000000000001)")));
  a.Of<state_t>()[1].p1 = 0.0;
  b.Of<state_t>()[1].p1 = -0.0;
  EXPECT_THAT(Difference(a, b), Optional(HasSubstr("p1: 0 (a.lcmlog) and -0 (b.lcmlog)")));
}

// Tests that faults of two processes with the same tick and number are told apart, in whatever order they
// arrived.
TEST(CompareTest, FaultsOfTwoProcesses) {
  RunMessages a = log::SampleRun(3);
  a.Of<fault_t>().push_back(a.Of<fault_t>()[0]);
  a.Of<fault_t>().back().source = "plant";
  RunMessages b = a;
  std::swap(b.Of<fault_t>()[0], b.Of<fault_t>()[1]);
  EXPECT_EQ(Difference(a, b), std::nullopt);
  b.Of<fault_t>().pop_back();
  EXPECT_NE(Difference(a, b), std::nullopt);
}

// Tests that of runs in other units one line says which those are and what compares them, because their first
// numbers differ whatever the runs do; and that runs that do not say their units are compared.
TEST(CompareTest, RunsInOtherUnits) {
  LimbLog a, b;
  a.limb.messages = b.limb.messages = log::SampleRun(9);
  for (LimbLog* log : {&a, &b}) log->limb.messages.Of<run_description_t>().resize(1);
  run_description_t& of_a = a.limb.messages.Of<run_description_t>().front();
  run_description_t& of_b = b.limb.messages.Of<run_description_t>().front();
  of_b = of_a;
  of_a.model_text = "name = \"a\"\n";
  of_b.model_text = "units = \"si\"\n";
  try {
    FirstDifference(a, "a.lcmlog", b, "b.lcmlog");
    FAIL() << "compared";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("b.lcmlog: found a run in m, N and Pa, allowed one in the units "
                                "of a.lcmlog, in, lbf and psi, "),
                      HasSubstr("hydro-log export --si")));
  }
  of_b.model_text = of_a.model_text;
  EXPECT_EQ(FirstDifference(a, "a.lcmlog", b, "b.lcmlog"), std::nullopt);
  of_b.model_text = "";
  EXPECT_EQ(FirstDifference(a, "a.lcmlog", b, "b.lcmlog"), std::nullopt);
}

}  // namespace
}  // namespace hydro::runs
