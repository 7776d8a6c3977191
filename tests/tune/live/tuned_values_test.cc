#include "tune/live/tuned_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/stack_fixture.h"

namespace hydro::tuning {
namespace {

using ::testing::HasSubstr;

tuned_settings_t Message() {
  tuned_settings_t message{};
  Write(ValuesOf(testing::SmallStack()), &message);
  return message;
}

void Set(tuned_settings_t* message, const std::string& name, double value) {
  for (size_t i = 0; i < message->names.size(); ++i) {
    if (message->names[i] == name) message->values[i] = value;
  }
}

// Tests that values arrive as they were sent, and that the pressure limit follows from the torque's.
TEST(TunedValues, TravelInAMessage) {
  tuned_settings_t message = Message();
  for (size_t i = 0; i < message.values.size(); ++i) message.values[i] = 2.0 + static_cast<double>(i);
  TunedValues values = ValuesOf(testing::SmallStack());
  ASSERT_EQ(Read(message, 4, &values), "");
  tuned_settings_t again{};
  Write(values, &again);
  Set(&message, "position.derivative_on_error", 1);  // a switch
  EXPECT_EQ(again.values, message.values);
  EXPECT_EQ(again.names, message.names);
  EXPECT_EQ(again.count, static_cast<int32_t>(message.names.size()));
  EXPECT_EQ(values.position.pressure_limit, values.limits.arm_torque_in_lbf / 4);
}

// Tests that a message that is not to be believed changes nothing.
TEST(TunedValues, AreAllTakenOrNone) {
  const struct {
    const char* name;
    double value;
    const char* says;
  } cases[] = {{"pressure.k_p", NAN, "pressure.k_p: found nan, allowed a finite number of at least 0"},
               {"pressure.k_p", -1, "found -1"},
               {"position.c2", INFINITY, "position.c2: found inf"},
               {"limits.pressure", 0, "limits.pressure: found 0, allowed a number above 0"},
               {"limits.pressure", NAN, "found nan"},
               {"noise.p1", -0.1, "noise.p1"}};
  for (const auto& c : cases) {
    tuned_settings_t message = Message();
    Set(&message, "position.c1", 77);
    Set(&message, c.name, c.value);
    TunedValues values = ValuesOf(testing::SmallStack());
    EXPECT_THAT(Read(message, 4, &values), HasSubstr(c.says));
    EXPECT_EQ(values.position.c1, 1000) << c.name;
  }
  tuned_settings_t unknown = Message();
  unknown.names[0] = "pressure.k_q";
  tuned_settings_t uneven = Message();
  uneven.values.pop_back();
  TunedValues values = ValuesOf(testing::SmallStack());
  EXPECT_EQ(Read(unknown, 4, &values), "pressure.k_q: not known to this version");
  EXPECT_EQ(Read(uneven, 4, &values), "names and values differ in number");
}

TEST(TunedValues, ALimitMayBeInfiniteAndAFeedforwardNegative) {
  tuned_settings_t message = Message();
  Set(&message, "limits.motor_speed", INFINITY);
  Set(&message, "pressure.reference_feedforward", -0.001);
  TunedValues values{};
  EXPECT_EQ(Read(message, 4, &values), "");
  EXPECT_EQ(values.pressure.reference_feedforward, -0.001);
}

// Tests that the names which older logs have for values are taken for the present ones.
TEST(TunedValues, FormerNamesAreRead) {
  TunedValues values = ValuesOf(testing::SmallStack());
  tuned_settings_t message{};
  message.names = {"limits.pressure_psi", "pressure.reference_feedforward_V_psi", "noise.arm_angle_rad"};
  message.values = {1234, -0.002, 0.5};
  message.count = 3;
  EXPECT_EQ(Read(message, 1, &values), "");
  EXPECT_EQ(values.limits.pressure_psi, 1234);
  EXPECT_EQ(values.pressure.reference_feedforward, -0.002);
  EXPECT_EQ(values.noise.arm_angle_rad, 0.5);
}

}  // namespace
}  // namespace hydro::tuning
