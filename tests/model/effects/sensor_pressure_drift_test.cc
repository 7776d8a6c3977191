#include <gtest/gtest.h>

#include <vector>

#include "model/response.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

const model::EffectDescription kDrift = {"sensor.pressure_drift", {{"p1", 3}, {"p2", -2}}, {}};

// Tests that the readings drift with time while the motion stays.
TEST(PressureDrift, ShiftsTheMeasurementWithTime) {
  model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
  model::Actuator with(Table1Model({kDrift}), Held(model::Shaft::kClamped));
  for (const double t : {0.2, 0.5}) {
    plain.Advance(2.5, t);
    with.Advance(2.5, t);
    EXPECT_NEAR(with.Measure().p1, plain.Measure().p1 + 3 * t, 1e-6);
    EXPECT_NEAR(with.Measure().p2, plain.Measure().p2 - 2 * t, 1e-6);
    EXPECT_NEAR(with.Measure().motor_speed, plain.Measure().motor_speed, 1e-6);
  }
}

// Tests that time counts from the run's first sample, of which a stretch of the run need not have any.
TEST(PressureDrift, CountsFromTheBeginOfTheRun) {
  model::Stimulus stimulus;
  stimulus.shaft = model::Shaft::kClamped;
  stimulus.begin = 1000;
  stimulus.time = {1000.5, 1000.75};
  stimulus.voltage = {0, 0};
  const model::StartState start = {0, 0, 300, 300, 0, 0};
  const auto p1 = [&](std::vector<model::EffectDescription> effects) {
    return model::Respond(Table1Model(std::move(effects)), stimulus, start, {}, {}).values[4];
  };
  const std::vector<double> plain = p1({}), with = p1({kDrift});
  EXPECT_NEAR(with[0] - plain[0], 1.5, 1e-9);
  EXPECT_NEAR(with[1] - plain[1], 2.25, 1e-9);
}

// Tests that a channel that reads late drifts late: its derivative by the delay includes the drift's.
TEST(PressureDrift, OfALateChannel) {
  const model::ModelDescription model =
      Table1Model({kDrift, {"sensor.skew", {{"delay", 0.05}}, {{"signal", "p1"}}}});
  model::Stimulus stimulus;
  stimulus.shaft = model::Shaft::kClamped;
  stimulus.time = {0, 0.1, 0.2};
  stimulus.voltage = {0, 0, 0};
  const model::StartState at_rest = {0, 0, 100, 100, 0, 0};  // p_3: nothing moves
  const model::Response response =
      model::Respond(model, stimulus, at_rest, {{model::Unknown::Kind::kEffect, 2}}, {});
  EXPECT_NEAR(response.values[4][2], 100 + 3 * 0.15, 1e-9);
  EXPECT_NEAR(response.derivatives[0][4][2], -3, 1e-9);
}

}  // namespace
}  // namespace hydro::testing
