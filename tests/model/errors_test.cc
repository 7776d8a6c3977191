// What the model refuses, and how its errors read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "model/trajectory/trajectory.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <class Action>
std::string ErrorOf(Action action) {
  try {
    action();
  } catch (const model::ModelError& error) {
    return error.what();
  }
  return "no error";
}

std::string ErrorOfBuilding(const model::ModelDescription& model, const model::ActuatorOptions& options) {
  return ErrorOf([&] { model::Actuator actuator(model, options); });
}

// Tests that Figure 7's angle, which Table 1 leaves no volume for, is refused with angle, volume and limit.
TEST(Errors, ClampedBeyondTheVolume) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.arm_angle = 1.5707963267948966;
  EXPECT_THAT(
      ErrorOfBuilding(Table1Model(), options),
      AllOf(HasSubstr("arm angle 1.5708 rad"), HasSubstr("V_1 = -2.62"), HasSubstr("|alpha| < 0.8578")));
  options.arm_angle = -1;
  EXPECT_THAT(ErrorOfBuilding(Table1Model(), options), HasSubstr("V_2 = -0.52"));
}

// Tests that the volume at the pump's end of the line counts.
TEST(Errors, LineTakesVolume) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.arm_angle = 0.8;
  EXPECT_EQ(ErrorOfBuilding(Table1Model(), options), "no error");
  EXPECT_THAT(ErrorOfBuilding(Table1Model({Wave(300, 0.2, 0.05)}), options), HasSubstr("|alpha| < 0.686"));
}

// Tests that a free arm driven out of its volume stops with an error that names angle, limit, time and state.
TEST(Errors, FreeArmRunsOut) {
  for (const model::Integrator integrator : kIntegrators) {
    model::Actuator actuator(Table1Model(), Held(model::Shaft::kFree, integrator));
    const std::string error = ErrorOf([&] {
      for (int i = 1; i < 100000; ++i) actuator.Advance(10, i * 1e-3);
    });
    EXPECT_THAT(error, AllOf(HasSubstr("arm angle 0.85"), HasSubstr("V_1 = "), HasSubstr("|alpha| < 0.857"),
                             HasSubstr(" at t = "), HasSubstr("motor_speed = ")))
        << Name(integrator);
  }
}

// Tests the same within one long call.
TEST(Errors, FreeArmRunsOutInOneCall) {
  for (const model::Integrator integrator : kIntegrators) {
    model::Actuator actuator(Table1Model(), Held(model::Shaft::kFree, integrator));
    EXPECT_THAT(ErrorOf([&] { actuator.Advance(10, 100); }),
                AllOf(HasSubstr("arm angle 0.8"), HasSubstr("V_1 = "), HasSubstr(" at t = ")))
        << Name(integrator);
  }
}

// Tests that overflowing numbers end, on every path, in an error with time and state, not in a silently wrong
// number.
TEST(Errors, Overflow) {
  model::ModelDescription model = Table1Model();
  model.parameters.k_1 = 1e300;
  model.parameters.T_pmax = 1e300;
  model.parameters.J = 1e-300;
  for (const model::Integrator integrator : kIntegrators) {
    EXPECT_THAT(ErrorOf([&] {
                  model::Actuator actuator(model, Held(model::Shaft::kClamped, integrator));
                  actuator.Advance(1, 1);
                }),
                AllOf(HasSubstr(" at t = 0 s"), HasSubstr("motor_speed = ")))
        << Name(integrator);
  }
}

// Tests that a driven shaft's motion is checked before it runs.
TEST(Errors, DrivenMotion) {
  model::ActuatorOptions options = Held(model::Shaft::kDriven);
  EXPECT_THAT(ErrorOfBuilding(Table1Model(), options), HasSubstr("needs a motion"));
  const auto far = trajectory::MakePoints({{0, 0}, {1, 0.9}}, trajectory::Interpolation::kLinear);
  options.motion = far.get();
  EXPECT_THAT(ErrorOfBuilding(Table1Model(), options), HasSubstr("arm angle 0.9 rad leaves V_1"));
  const auto jumps = trajectory::MakeSteps(0, {{1, 0.1}});
  options.motion = jumps.get();
  EXPECT_THAT(ErrorOfBuilding(Table1Model(), options), HasSubstr("continuous"));
}

// Tests that a voltage that is not a number is an error with time and state, and that the actuator stays
// unchanged.
TEST(Errors, NotANumber) {
  for (const model::Integrator integrator : kIntegrators) {
    for (const double voltage : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      model::Actuator actuator(Table1Model(), Held(model::Shaft::kClamped, integrator));
      actuator.Advance(2.5, 0.01);
      const double before = actuator.Measure().p2;
      EXPECT_THAT(ErrorOf([&] { actuator.Advance(voltage, 0.02); }),
                  AllOf(HasSubstr("voltage is not finite at t = 0.01 s"), HasSubstr("p2 = 106.")));
      EXPECT_EQ(actuator.Measure().p2, before);
    }
  }
}

// Tests that time does not run backwards, and that standing still is allowed.
TEST(Errors, Time) {
  model::Actuator actuator(Table1Model(), Held(model::Shaft::kClamped));
  actuator.Advance(2.5, 0.01);
  actuator.Advance(2.5, 0.01);
  EXPECT_EQ(actuator.time(), 0.01);
  EXPECT_THAT(ErrorOf([&] { actuator.Advance(2.5, 0.009); }), HasSubstr("cannot advance to t = 0.009"));
  EXPECT_THAT(ErrorOf([&] { actuator.Advance(2.5, std::nan("")); }), HasSubstr("cannot advance"));
}

// Tests that impossible models are refused, naming the parameter.
TEST(Errors, Parameters) {
  model::ModelDescription model = Table1Model();
  model.parameters.J = 0;
  EXPECT_THAT(ErrorOfBuilding(model, Held(model::Shaft::kClamped)), HasSubstr("parameter J = 0 lbf-in-s^2"));
  model = Table1Model();
  model.parameters.c_E = -1;
  EXPECT_THAT(ErrorOfBuilding(model, Held(model::Shaft::kClamped)), HasSubstr("parameter c_E = -1"));
  model = Table1Model();
  model.parameters.beta = std::nan("");
  EXPECT_THAT(ErrorOfBuilding(model, Held(model::Shaft::kClamped)), HasSubstr("parameter beta = nan"));
  EXPECT_THAT(ErrorOfBuilding(Table1Model({{"pump.unknown", {}, {}}}), Held(model::Shaft::kClamped)),
              HasSubstr("\"pump.unknown\" is not known"));
  EXPECT_THAT(ErrorOfBuilding(Table1Model({Lag(1), Lag(2)}), Held(model::Shaft::kClamped)),
              HasSubstr("there twice"));
  const model::EffectDescription line = {"motor.speed_torque_limit", {{"no_load_speed", 300}}, {}},
                                 corner = {"motor.current_limit",
                                           {{"corner_speed", 100}, {"speed_range", 100}},
                                           {}};
  EXPECT_THAT(ErrorOfBuilding(Table1Model({line, corner}), Held(model::Shaft::kClamped)),
              HasSubstr("allowed is one of those like motor.speed_torque_limit and motor.current_limit"));
  EXPECT_THAT(ErrorOfBuilding(Table1Model({Lag(-1)}), Held(model::Shaft::kClamped)),
              HasSubstr("amp.lag.tau = -1 s"));
  EXPECT_THAT(ErrorOfBuilding(Table1Model({{"amp.lag", {}, {}}}), Held(model::Shaft::kClamped)),
              HasSubstr("amp.lag.tau is missing"));
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.initial_pressure = 99;
  EXPECT_THAT(ErrorOfBuilding(Table1Model(), options), HasSubstr("initial pressure 99"));
  options = Held(model::Shaft::kClamped);
  options.relative_tolerance = 0;
  EXPECT_THAT(ErrorOfBuilding(Table1Model(), options), HasSubstr("relative tolerance"));
}

}  // namespace
}  // namespace hydro::testing
