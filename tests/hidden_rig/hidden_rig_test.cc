// The hidden rig is only worth something if it is right on its own: it agrees with the model where nothing is
// hidden, and its runs say nothing about what is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "model/response.h"
#include "model/terms/state.h"
#include "runs/measured/measured_run.h"
#include "tests/hidden_rig/cases.h"
#include "tests/hidden_rig/line.h"
#include "tests/hidden_rig/plans.h"
#include "tests/hidden_rig/write_case.h"
#include "tests/rig_folder.h"

namespace hidden_rig {
namespace {

namespace fs = std::filesystem;

class HiddenRig : public hydro::testing::RigFolder {
 protected:
  HiddenRig() : RigFolder("hidden_") {}

  static Case CaseNamed(const std::string& name) { return CaseIn(AllCases(), name); }
  static Options Short(double seconds) {
    Options options;
    options.seconds = seconds;
    return options;
  }
};

// Tests that the runs are read as measured runs of the right kinds, with the stated noise.
TEST_F(HiddenRig, RunsAreReadable) {
  const Case c = CaseNamed("nothing-1");
  const Options options = Short(0.5);
  WriteRuns(c, Solve(c, options), options, Folder("a"));
  std::map<hydro::model::Shaft, int> shafts;
  int bypassed = 0;
  for (int i = 1; i <= 6; ++i) {
    const hydro::runs::MeasuredRun run =
        hydro::runs::ReadMeasuredRun(Folder("a") + "/run" + std::to_string(i) + ".csv");
    EXPECT_EQ(run.samples(), 501u);
    EXPECT_DOUBLE_EQ(run.p1.noise.value(), 1.5);
    EXPECT_DOUBLE_EQ(run.motor_speed.noise.value(), 0.3);
    EXPECT_EQ(run.arm_angle.measured(), run.shaft == hydro::model::Shaft::kFree);
    ++shafts[run.shaft];
    bypassed += run.bypass ? 1 : 0;
  }
  EXPECT_EQ(shafts[hydro::model::Shaft::kFree], 2);
  EXPECT_EQ(shafts[hydro::model::Shaft::kClamped], 4);
  EXPECT_EQ(bypassed, 2);
}

// Tests that a seed gives the same files to the bit, and that another seed gives others.
TEST_F(HiddenRig, SeedDecides) {
  Case c = CaseNamed("nothing-1");
  const Options options = Short(0.2);
  WriteRuns(c, Solve(c, options), options, Folder("a"));
  WriteRuns(c, Solve(c, options), options, Folder("b"));
  ++c.seed;
  WriteRuns(c, Solve(c, options), options, Folder("c"));
  for (const auto& entry : fs::directory_iterator(Folder("a"))) {
    const fs::path name = entry.path().filename();
    EXPECT_EQ(Text(entry.path()), Text(fs::path(Folder("b")) / name)) << name;
    if (name.extension() != ".csv") continue;
    EXPECT_NE(Text(entry.path()), Text(fs::path(Folder("c")) / name)) << name;
  }
}

// Tests that nothing handed over names what is in the rig, and that the key does.
TEST_F(HiddenRig, OnlyTheKeyTells) {
  const Case c = CaseNamed("triple-pump.stribeck+valve.relief+amp.lag");
  const Options options = Short(0.2);
  const Truth truth = Solve(c, options);
  WriteRuns(c, truth, options, Folder("a"));
  for (const auto& entry : fs::directory_iterator(Folder("a"))) {
    const std::string text = Text(entry.path());
    for (const std::string word : {"stribeck", "relief", "lag", "effect", "triple", "static_excess", "tau"}) {
      EXPECT_EQ(text.find(word), std::string::npos) << entry.path() << ": " << word;
    }
  }
  WriteKey(c, truth, Folder("key.json"));
  const std::string key = Text(Folder("key.json"));
  for (const std::string word : {"pump.stribeck", "valve.relief", "amp.lag", "\"class\": \"triple\""}) {
    EXPECT_NE(key.find(word), std::string::npos) << word;
  }
}

// Tests that the proof has all the cases it claims: every effect of the catalogue at three sizes, every base
// parameter.
TEST_F(HiddenRig, CasesAreComplete) {
  std::map<std::string, int> kinds;
  std::set<std::string> names;
  std::set<uint64_t> seeds;
  for (const Case& c : AllCases()) {
    ++kinds[c.kind];
    names.insert(c.name);
    seeds.insert(c.seed);
  }
  EXPECT_EQ(EffectForms().size(), 24u);
  EXPECT_EQ(BaseForms().size(), 15u);
  EXPECT_EQ(kinds["single"], 72);
  EXPECT_EQ(kinds["pair"], 12);
  EXPECT_EQ(kinds["triple"], 10);
  EXPECT_EQ(kinds["nothing"], 20);
  EXPECT_EQ(kinds["parameter"], 15);
  EXPECT_EQ(kinds["outside"], 10);
  EXPECT_EQ(names.size(), AllCases().size());
  EXPECT_EQ(seeds.size(), AllCases().size());
}

// Tests that the size for a requested gap is found.
TEST_F(HiddenRig, SizeGivesTheGap) {
  const Truth truth = Solve(CaseNamed("pump.quadratic_drag-medium"), Short(0.4));
  EXPECT_TRUE(truth.reached);
  EXPECT_NEAR(truth.gap, 5, 0.3);
}

// Tests, by shaking it, that a tuned line's first resonance is where requested: the ratio of the pressures at
// its ends has a line of 4 pieces swinging against each other only there.
TEST_F(HiddenRig, LineRingsWhereAsked) {
  constexpr double kVolume = 3.16, kBeta = 247000, kHz = 150;
  const Line line = TuneLine(kHz, 0.3, 0.0, kVolume, kBeta);
  EXPECT_NEAR(line.volume[0] + 1.5 * line.volume[1], 0.3 * kVolume, 1e-12);
  // Swings freely from unequal pressures, by semi-implicit Euler; counts the crossings of the mean at the
  // pump.
  double pressure[kLineNodes + 1] = {1, 0.5, 0, -0.2, -0.4};
  double flow[kPieces] = {};
  double volume[kLineNodes + 1];
  double mean = 0;
  for (int i = 0; i <= kLineNodes; ++i)
    volume[i] = i < kLineNodes ? line.volume[i] : kVolume - line.fixed_volume;
  for (int i = 0; i <= kLineNodes; ++i) mean += pressure[i] * volume[i] / kVolume;
  constexpr double kH = 2e-7;
  double sum_cos = 0, sum_sin = 0, best = 0, best_hz = 0;
  std::vector<double> history;
  for (int n = 0; n < 1000000; ++n) {
    for (int i = 0; i < kPieces; ++i) flow[i] += kH * (pressure[i] - pressure[i + 1]) / line.inertance;
    for (int i = 0; i <= kLineNodes; ++i) {
      pressure[i] += kH * kBeta / volume[i] * ((i > 0 ? flow[i - 1] : 0) - (i < kPieces ? flow[i] : 0));
    }
    if (n % 100 == 0) history.push_back(pressure[0] - mean);
  }
  for (double hz = 100; hz < 200; hz += 0.5) {
    sum_cos = sum_sin = 0;
    for (size_t n = 0; n < history.size(); ++n) {
      const double turn = 2 * M_PI * hz * static_cast<double>(n) * 100 * kH;
      sum_cos += history[n] * std::cos(turn);
      sum_sin += history[n] * std::sin(turn);
    }
    const double power = sum_cos * sum_cos + sum_sin * sum_sin;
    if (power > best) {
      best = power;
      best_hz = hz;
    }
  }
  EXPECT_NEAR(best_hz, kHz, 1.0);
}

hydro::model::Parameters ModelParameters(const Base& b) {
  hydro::model::Parameters p;
  p.k_1 = b.k_1;
  p.T_pmax = b.T_pmax;
  p.D = b.D;
  p.J = b.J;
  p.b = b.b;
  p.T_s = b.T_s;
  p.f = b.f;
  p.beta = b.beta;
  p.V_ms = b.V_ms;
  p.c = b.c;
  p.c_E = b.c_E;
  p.c_I = b.c_I;
  p.p_3 = b.p_3;
  p.k_2 = b.k_2;
  p.J_a = b.J_a;
  p.mgl = b.mgl;
  return p;
}

// Tests that the rig with nothing hidden and without noise is, in every run, within a noise unit of the model
// under the same voltages, open loop: two independently written programs agree.
TEST_F(HiddenRig, AgreesWithTheModel) {
  RigSetup setup;
  hydro::model::ModelDescription model;
  model.parameters = ModelParameters(setup.base);
  for (const Plan& plan : Plans(5, 1.5, false)) {
    Conditions conditions;
    conditions.noise = 0;
    conditions.seconds = 1.5;
    const Record rig = RecordRun(setup, plan, conditions);
    hydro::model::Stimulus stimulus;
    stimulus.shaft = plan.shaft == Shaft::kFree ? hydro::model::Shaft::kFree : hydro::model::Shaft::kClamped;
    stimulus.arm_angle = plan.arm_angle;
    stimulus.bypass = plan.bypass;
    stimulus.time = rig.time;
    stimulus.voltage = rig.voltage;
    hydro::model::StartState start{};
    start[hydro::model::kP1] = rig.p1[0];
    start[hydro::model::kP2] = rig.p2[0];
    start[hydro::model::kArmAngle] = plan.arm_angle;
    const hydro::model::Response response = hydro::model::Respond(model, stimulus, start, {}, {});
    const auto expect_close = [&](hydro::model::Channel channel, const std::vector<double>& recorded,
                                  double noise) {
      const auto& predicted = response.values[static_cast<size_t>(channel)];
      double sum = 0;
      for (size_t i = 0; i < recorded.size(); ++i) sum += std::pow((recorded[i] - predicted[i]) / noise, 2);
      EXPECT_LT(std::sqrt(sum / static_cast<double>(recorded.size())), 1.5)
          << plan.name << ", channel " << static_cast<int>(channel);
    };
    expect_close(hydro::model::Channel::kMotorSpeed, rig.motor_speed, kSpeedNoise);
    expect_close(hydro::model::Channel::kP1, rig.p1, kPressureNoise);
    expect_close(hydro::model::Channel::kP2, rig.p2, kPressureNoise);
    if (plan.shaft == Shaft::kFree)
      expect_close(hydro::model::Channel::kArmAngle, rig.arm_angle, kAngleNoise);
  }
}

// Tests that noise and quantisation are as stated: a bypassed pump at rest reads its pressure with 1.5 psi.
TEST_F(HiddenRig, NoiseIsAsStated) {
  Plan plan;
  plan.shaft = Shaft::kClamped;
  plan.segments = {Segment{}};
  Conditions conditions;
  const Record record = RecordRun(RigSetup{}, plan, conditions);
  double sum = 0;
  for (const double p : record.p1) {
    sum += (p - 100) * (p - 100);
    EXPECT_NEAR(std::remainder(p, 3000.0 / 4096), 0, 1e-9);
  }
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(record.p1.size())), kPressureNoise, 0.1);
}

}  // namespace
}  // namespace hidden_rig
