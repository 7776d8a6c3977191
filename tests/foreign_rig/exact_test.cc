// Rigs of which all is exact but what is hidden.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "runs/measured/measured_run.h"
#include "settings/model_file.h"
#include "tests/foreign_rig/rig_folder.h"

namespace foreign_rig {
namespace {

class ExactRig : public RigFolder {};

// Values of the model that are not the rig's.
std::set<std::string> WrongValues(const Solved& solved) {
  std::set<std::string> wrong;
  for (const ValueForm& form : ValueForms()) {
    if (solved.given.*form.value != solved.rig.values.*form.value) wrong.insert(form.name);
  }
  return wrong;
}

// Tests that the model is right, that there are no small things, and that each run begins at rest.
TEST_F(ExactRig, IsExact) {
  for (const char* name : {"exact-noise_as_stated-1", "exact-sensor.sign-p1", "exact-pump.quadratic_drag"}) {
    const Solved solved = Solve(CaseNamed(name), {0.5, 500});
    EXPECT_EQ(WrongValues(solved), std::set<std::string>()) << name;
    EXPECT_EQ(solved.rig.rich.size, 0) << name;
    EXPECT_EQ(solved.richness, 0) << name;
    for (const Plan& plan : solved.plans) {
      const Machine machine(solved.rig, plan.day);
      EXPECT_EQ(plan.day.prelude, 0) << name << ", " << plan.name;
      EXPECT_EQ(machine.shaft_angle(), 0) << name << ", " << plan.name;
      EXPECT_EQ(machine.celsius(), 40) << name << ", " << plan.name;
      EXPECT_EQ(std::min(machine.pressure_1(), machine.pressure_2()), solved.rig.values.supply_pressure)
          << name << ", " << plan.name;
    }
  }
}

// Tests that of `parameter` one value is wrong, the one that it says, and by enough to be found.
TEST_F(ExactRig, OneValueIsWrong) {
  for (const ValueForm& form : ValueForms()) {
    const Solved solved = Solve(CaseNamed("parameter-" + form.name), {0.5, 500});
    EXPECT_EQ(WrongValues(solved), std::set<std::string>{form.name});
    const double off = std::abs(solved.given.*form.value / (solved.rig.values.*form.value) - 1);
    EXPECT_GT(off, 0.12) << form.name;
    EXPECT_LT(off, 0.31) << form.name;
    EXPECT_EQ(solved.gap, solved.gap_of_model) << form.name;
    EXPECT_TRUE(solved.effects.empty()) << form.name;
  }
}

// Tests that the sidecars state the noise as the case says, and those of other rigs state none.
TEST_F(ExactRig, NoiseIsStated) {
  for (const auto& [name, times] :
       {std::pair("as_stated", 1.0), std::pair("halved", 0.5), std::pair("tripled", 3.0)}) {
    const Solved solved = Write(CaseNamed(std::string("exact-noise_") + name + "-1"), name);
    for (const Plan& plan : solved.plans) {
      const auto run = hydro::runs::ReadMeasuredRun(Folder(name) + "/" + plan.name + ".csv");
      const auto expect = [&, name = name, times = times](const std::optional<double>& stated, int channel) {
        EXPECT_NEAR(stated.value() * times / NoiseUnit(solved.recorder.channels[channel]), 1, 1e-6) << name;
      };
      expect(run.motor_speed.noise, kSpeed);
      expect(run.p1.noise, kSide1);
      expect(run.p2.noise, kSide2);
      if (!plan.day.clamped) expect(run.arm_angle.noise, kArmAngle);
    }
    EXPECT_TRUE(hydro::settings::LoadModelFile(Folder(name) + "/model.toml").uncertainty.empty());
  }
  Write(CaseNamed("values-1"), "other");
  EXPECT_FALSE(hydro::runs::ReadMeasuredRun(Folder("other") + "/run1.csv").p1.noise.has_value());
}

// Tests that the noise of each channel is white and of the recorder's unit: neighbours share nothing.
TEST_F(ExactRig, NoiseIsWhite) {
  for (int i = 1; i <= 4; ++i) {
    const Recorder recorder =
        Solve(CaseNamed("exact-noise_as_stated-" + std::to_string(i)), {0.5, 1000}).recorder;
    constexpr int kSamples = 20000;
    Sensing sensing(recorder, 7, kSamples / recorder.rate);
    Sample before{}, square{}, product{};
    for (int k = 0; k < kSamples; ++k) {
      sensing.Follow(Reading{});
      const Sample sample = sensing.Take(k / recorder.rate);
      for (const int c : {kSpeed, kArmAngle, kSide1, kSide2}) {
        square[c] += sample[c] * sample[c] / kSamples;
        product[c] += sample[c] * before[c] / kSamples;
      }
      before = sample;
    }
    for (const int c : {kSpeed, kSide1, kSide2}) {
      EXPECT_NEAR(std::sqrt(square[c]) / NoiseUnit(recorder.channels[c]), 1, 0.1) << i << ", channel " << c;
      EXPECT_NEAR(product[c] / square[c], 0, 0.03) << i << ", channel " << c;
    }
    EXPECT_NEAR(product[kArmAngle] / square[kArmAngle], 0, 0.03) << i;
  }
}

// Tests that the three wrong signs are those of three channels, in the recording alone.
TEST_F(ExactRig, SignsAreOfThreeChannels) {
  for (const char* signal : {"arm_angle", "p1", "motor_speed"}) {
    Case c = CaseNamed(std::string("exact-sensor.sign-") + signal);
    const Solved solved = Write(c, "wrong");
    ASSERT_EQ(solved.effects.size(), 1u);
    EXPECT_EQ(solved.effects[0].signal, signal);
    Solved right = solved;
    right.rig.effects.inverted = Signal::kNone;
    WriteRuns(c, right, {0.5, 500}, Folder("right"));
    const auto wrong_run = hydro::runs::ReadMeasuredRun(Folder("wrong") + "/run4.csv");
    const auto right_run = hydro::runs::ReadMeasuredRun(Folder("right") + "/run4.csv");
    const auto expect = [&](const auto& wrong, const auto& as_it_is, const std::string& name) {
      for (size_t i = 0; i < as_it_is.values.size(); ++i)
        EXPECT_EQ(wrong.values[i], name == signal ? -as_it_is.values[i] : as_it_is.values[i]) << name;
    };
    expect(wrong_run.motor_speed, right_run.motor_speed, "motor_speed");
    expect(wrong_run.arm_angle, right_run.arm_angle, "arm_angle");
    expect(wrong_run.p1, right_run.p1, "p1");
    expect(wrong_run.p2, right_run.p2, "p2");
  }
}

// Tests that three effects are drawn, none twice.
TEST_F(ExactRig, TriplesAreThree) {
  const Solved solved = Solve(CaseNamed("exact-triple-1"), {0.3, 500});
  std::set<std::string> ids;
  for (const Truth& truth : solved.effects) ids.insert(truth.id);
  EXPECT_EQ(ids.size(), 3u);
}

}  // namespace
}  // namespace foreign_rig
