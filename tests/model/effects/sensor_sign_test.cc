#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that one channel is inverted, including its offset, and no other.
TEST(Sign, InvertsOneChannel) {
  const std::vector<std::pair<std::string, int>> signals = {
      {"motor_speed", 0}, {"motor_angle", 1}, {"arm_angle", 2}, {"p1", 4}, {"p2", 5}};
  model::ModelDescription model = Table1Model({{"sensor.pressure_offset", {{"p1", 3}, {"p2", -2}}, {}}});
  const auto read = [&] {
    model::Actuator actuator(model, Held(model::Shaft::kFree));
    actuator.Advance(2.5, 0.2);
    const model::Measurement m = actuator.Measure();
    return std::vector<double>{m.motor_speed, m.motor_angle, m.arm_angle, m.arm_speed, m.p1, m.p2};
  };
  const std::vector<double> plain = read();
  for (const auto& [name, index] : signals) {
    model.effects.resize(1);
    model.effects.push_back({"sensor.sign", {}, {{"signal", name}}});
    const std::vector<double> inverted = read();
    for (int i = 0; i < 6; ++i) {
      const bool is_it = i == index || (index == 2 && i == 3);  // the arm's speed comes with its angle
      EXPECT_EQ(inverted[i], is_it ? -plain[i] : plain[i]) << name << " " << i;
    }
  }
}

}  // namespace
}  // namespace hydro::testing
