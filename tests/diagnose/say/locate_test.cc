#include "diagnose/say/locate.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/say/lacking.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/diagnose/prepare_run.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::NoisyRig;

model::ModelDescription Given() {
  model::ModelDescription model;
  model.parameters = testing::Table1();
  model.parameters.mgl = 150;
  return model;
}

model::ModelDescription GivenWith(const std::string& id, const std::map<std::string, double>& parameters) {
  model::ModelDescription model = Given();
  model.effects.push_back({id, parameters, {}});
  return model;
}

model::ModelDescription Changed(double model::Parameters::*member, double factor) {
  model::ModelDescription model = Given();
  model.parameters.*member *= factor;
  return model;
}

Localisation LocateIn(const std::vector<RunData>& runs, const model::ModelDescription& given = Given()) {
  std::vector<const RunData*> all;
  for (const RunData& run : runs) all.push_back(&run);
  return Locate(given, all);
}

Localisation LocateOn(const model::ModelDescription& truth) {
  NoisyRig rig;
  rig.model = truth;
  return LocateIn(rig.RecordAll());
}

struct Case {
  std::string name;
  model::ModelDescription truth;
  std::string balance;
  std::string where;    // part of it
  std::string against;  // of the first table; "": none
  double least_share = 0.85;
};

class HiddenTerm : public ::testing::TestWithParam<Case> {};

// Tests that what a balance lacks shows in that balance, together with what it depends on.
TEST_P(HiddenTerm, ShowsInItsOwnBalance) {
  const Localisation found = LocateOn(GetParam().truth);
  ASSERT_FALSE(found.location.empty());
  const Location& first = found.location.front();
  EXPECT_EQ(first.balance, GetParam().balance);
  EXPECT_GE(first.share, GetParam().least_share);
  EXPECT_THAT(first.where, HasSubstr(GetParam().where));
  EXPECT_FALSE(first.windows.empty());
  double all = 0;
  for (const Location& location : found.location) all += location.share;
  EXPECT_LE(all, 1 + 1e-9);
  for (const Window& window : first.windows) EXPECT_LT(window.from, window.to) << window.run;
  if (GetParam().against.empty()) return;
  ASSERT_FALSE(found.missing.empty());
  const MeasuredCurve& table = found.missing.front();
  EXPECT_EQ(table.against, GetParam().against);
  EXPECT_GE(table.at.size(), 6u);
  EXPECT_EQ(table.at.size(), table.measured.size());
  EXPECT_EQ(table.at.size(), table.error.size());
}

INSTANTIATE_TEST_SUITE_P(
    Locate, HiddenTerm,
    ::testing::Values(
        Case{"Stribeck", GivenWith("pump.stribeck", {{"static_excess", 0.9}, {"speed", 3}}), "pump_torque",
             "|motor_speed| from ", "motor_speed"},
        Case{"PressureFriction", GivenWith("pump.pressure_friction", {{"f", 2e-4}}), "pump_torque", "p1 + p2",
             "(p1 + p2) sgn(motor_speed)"},
        Case{"QuadraticDrag", GivenWith("pump.quadratic_drag", {{"k", 2e-5}}), "pump_torque",
             "|motor_speed| > ", "motor_speed"},
        Case{"SealFriction", GivenWith("actuator.seal_friction", {{"coulomb", 20}, {"viscous", 5}}),
             "arm_torque", "sign of arm_speed", "arm_speed"},
        Case{"Lag", GivenWith("amp.lag", {{"tau", 0.004}}), "command", "change of voltage",
             "change of voltage"},
        Case{"TorquePerVolt", Changed(&model::Parameters::k_1, 1.05), "command", "voltage", "voltage"},
        Case{"TorqueLimit", Changed(&model::Parameters::T_pmax, 0.7), "command", "voltage", ""},
        Case{"ExternalLeakage", Changed(&model::Parameters::c_E, 3), "flow_2", "p2 > ", "p2", 0.5},
        Case{"InternalLeakage", Changed(&model::Parameters::c_I, 5), "flow_2", "|p2 - p1| > ", "p2 - p1",
             0.4},
        Case{"Gravity", Changed(&model::Parameters::mgl, 1.2), "arm_torque", "", ""},
        Case{"PressureOffset", GivenWith("sensor.pressure_offset", {{"p1", 12}, {"p2", -5}}), "sensor",
             "p1 reads +12", ""}),
    [](const auto& test) { return test.param.name; });

// Tests that nothing is located where nothing is missing, whatever the noise.
TEST(Locate, NothingMissing) {
  for (const double noise : {0.5, 1.0, 3.0}) {
    NoisyRig rig;
    rig.model = Given();
    rig.pressure_noise *= noise;
    rig.speed_noise *= noise;
    rig.seed = 7;
    const Localisation found = LocateIn(rig.RecordAll());
    EXPECT_THAT(found.location, IsEmpty()) << noise << " " << found.location.front().balance;
    EXPECT_THAT(found.missing, IsEmpty());
  }
}

// Tests that an effect that the model has is not reported as missing, even one with states, switches or
// delays.
TEST(Locate, NothingMissingWithEffects) {
  for (const model::ModelDescription& model :
       {GivenWith("valve.relief", {{"set", 3000}, {"conductance", 1e-3}}),
        GivenWith("line.wave", {{"frequency", 100}, {"volume_fraction", 0.3}, {"damping", 0.2}}),
        GivenWith("amp.delay", {{"delay", 0.003}}),
        GivenWith("sensor.pressure_offset", {{"p1", 12}, {"p2", -5}})}) {
    NoisyRig rig;
    rig.model = model;
    const Localisation found = LocateIn(rig.RecordAll(), model);
    EXPECT_THAT(found.location, IsEmpty()) << model.effects[0].id << " " << found.location.front().balance
                                           << " " << found.location.front().where;
  }
}

// Tests that pressures recorded late are attributed to the sensors.
TEST(Locate, LateReadings) {
  NoisyRig rig;
  rig.model = Given();
  std::vector<RunData> runs = rig.RecordAll();
  for (RunData& run : runs) {
    for (SignalData& signal : run.signals) {
      if (signal.channel != model::Channel::kP1 && signal.channel != model::Channel::kP2) continue;
      for (size_t k = signal.values.size(); k-- > 3;) signal.values[k] = signal.values[k - 3];
    }
  }
  const Localisation found = LocateIn(runs);
  ASSERT_FALSE(found.location.empty());
  EXPECT_EQ(found.location.front().balance, "sensor");
  EXPECT_GE(found.location.front().share, 0.85);
}

// Tests that the table of the missing term is the hidden term: friction that grows with pressure.
TEST(Locate, TableIsTheHiddenTerm) {
  const Localisation found = LocateOn(GivenWith("pump.pressure_friction", {{"f", 2e-4}}));
  ASSERT_FALSE(found.missing.empty());
  const MeasuredCurve& table = found.missing.front();
  EXPECT_EQ(table.balance, "pump_torque");
  EXPECT_EQ(table.unit, "in-lbf");
  EXPECT_EQ(table.against_unit, "psi");
  for (size_t i = 0; i < table.at.size(); ++i) {
    EXPECT_NEAR(table.measured[i], -2e-4 * table.at[i],
                5 * table.error[i] + 0.02 * std::abs(table.measured[i]) + 0.01)
        << table.at[i];
  }
}

// Tests that balances that the run does not measure are left out, and that a speed known from the encoder
// alone still locates friction.
TEST(Locate, WhatIsNotMeasured) {
  NoisyRig rig;
  rig.model = Changed(&model::Parameters::T_s, 0.85);
  rig.speed_measured = false;
  std::vector<RunData> runs = rig.RecordAll();
  for (RunData& run : runs) {
    std::erase_if(run.signals,
                  [](const SignalData& signal) { return signal.channel == model::Channel::kP1; });
    run.measured.p1.values.clear();
  }
  // Without one of the pressures, only the bypassed run has a balance.
  const Localisation found = LocateIn(runs);
  ASSERT_FALSE(found.location.empty());
  EXPECT_EQ(found.location.front().balance, "pump_torque");
  for (const Location& location : found.location) EXPECT_NE(location.balance, "flow_1");
}

// Tests recordings slower than the pressures' dynamics, with gaps: all results are finite, and a plain error
// shows where it is.
TEST(Locate, SlowRecordings) {
  NoisyRig rig;
  rig.model = Changed(&model::Parameters::T_s, 0.5);
  std::vector<RunData> runs = rig.RecordAll();
  std::vector<RunData> slow;
  for (RunData& run : runs) {
    runs::MeasuredRun measured = run.measured;
    const auto thin = [](std::vector<double>* values) {
      for (size_t k = 0; 20 * k < values->size(); ++k) (*values)[k] = (*values)[20 * k];
      values->resize((values->size() + 19) / 20);
    };
    for (std::vector<double>* values :
         {&measured.time, &measured.voltage.values, &measured.motor_speed.values,
          &measured.motor_angle.values, &measured.p1.values, &measured.p2.values,
          &measured.arm_angle.values}) {
      if (!values->empty()) thin(values);
    }
    for (size_t k = 40; k < 50; ++k) measured.p2.values[k] = std::nan("");
    slow.push_back(PrepareRun(std::move(measured), Given().parameters));
    const std::vector<LackingRun> lacking = LackingIn(Given(), {&slow.back()}, 1);
    for (const Eigen::VectorXd& values : lacking[0].base.left) ASSERT_TRUE(values.allFinite());
  }
  const Localisation found = LocateIn(slow);
  ASSERT_FALSE(found.location.empty());
  const auto pump = std::find_if(found.location.begin(), found.location.end(),
                                 [](const Location& location) { return location.balance == "pump_torque"; });
  EXPECT_NE(pump, found.location.end());
}

// Tests that where no balance can be formed, no place is named, and that this is said.
TEST(Locate, NoBalance) {
  NoisyRig rig;
  rig.model = Changed(&model::Parameters::T_s, 0.5);
  std::vector<RunData> runs = rig.RecordAll();
  runs.pop_back();  // the bypassed one
  for (RunData& run : runs) {
    std::erase_if(run.signals,
                  [](const SignalData& signal) { return signal.channel == model::Channel::kP1; });
    run.measured.p1.values.clear();
  }
  const Localisation found = LocateIn(runs);
  EXPECT_THAT(found.location, IsEmpty());
}

// Tests that the signal that is predicted worst is named with the stretch where it is, of the run where it
// is.
TEST(WorstSignal, IsNamedWithItsStretch) {
  const std::vector<SignalGap> signals = {{model::Channel::kMotorSpeed, 0.3, {.before = 3, .after = 0.3}, {}},
                                          {model::Channel::kP2, 1.5, {.before = 3, .after = 3}, {}}};
  RunCurves still, moving;
  still.run = "still";
  moving.run = "moving";
  still.time = moving.time = {0, 1, 2, 3};
  still.curves = {{model::Channel::kMotorSpeed, {0, 0, 0, 0}, {0, 0.1, 0, 0}, {}}};
  moving.curves = {{model::Channel::kMotorSpeed, {0, 5, 6, 0}, {0, 0, 0, 0.1}, {}}};
  const std::vector<Location> found = WorstSignal(signals, {still, moving}, false);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].balance, "motor_speed");
  EXPECT_NEAR(found[0].share, 99.0 / 102, 1e-9);
  ASSERT_EQ(found[0].windows.size(), 1u);
  EXPECT_EQ(found[0].windows[0].run, "moving");
  EXPECT_EQ(found[0].windows[0].from, 1);
  EXPECT_EQ(found[0].windows[0].to, 2);
  EXPECT_EQ(WorstSignal(signals, {}, true).at(0).balance, "p2");
  EXPECT_THAT(WorstSignal({{model::Channel::kP2, 1.5, {.before = 1.5}, {}}}, {}, false), IsEmpty());
}

// Tests that the same runs give the same localisation to the bit.
TEST(Locate, Repeats) {
  const Localisation a = LocateOn(GivenWith("pump.quadratic_drag", {{"k", 2e-5}}));
  const Localisation b = LocateOn(GivenWith("pump.quadratic_drag", {{"k", 2e-5}}));
  ASSERT_EQ(a.location.size(), b.location.size());
  for (size_t i = 0; i < a.location.size(); ++i) EXPECT_EQ(a.location[i].share, b.location[i].share);
  ASSERT_EQ(a.missing.size(), b.missing.size());
  for (size_t i = 0; i < a.missing.size(); ++i) EXPECT_EQ(a.missing[i].measured, b.missing[i].measured);
}

}  // namespace
}  // namespace hydro::diagnose
