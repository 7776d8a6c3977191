// A user's own effect, in one file (arm_spring.cc): the plant has it and the gap finder finds it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "diagnose/diagnose.h"
#include "model/effects/effect.h"
#include "settings/model_file.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using ::testing::HasSubstr;

constexpr double kStiffness = 2500;  // in-lbf/rad

model::ModelDescription Sprung() { return Table1With({{"arm.spring", {{"stiffness", kStiffness}}, {}}}); }

// A free arm, simulated by Actuator at 1 kHz, with noise on the measured signals.
runs::MeasuredRun Swing(double volts, double period, uint64_t seed) {
  model::Actuator rig(Sprung(), {});
  runs::MeasuredRun run;
  run.name = run.file = "swing " + std::to_string(seed);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 600; ++k) {
    const double t = 1e-3 * k;
    if (k > 0) rig.Advance(run.voltage.values.back(), t);
    const model::Measurement m = rig.Measure();
    run.time.push_back(t);
    run.voltage.values.push_back(std::fmod(t, period) < 0.5 * period ? volts : -volts);
    run.motor_speed.values.push_back(m.motor_speed + 0.3 * normal(random));
    run.p1.values.push_back(m.p1 + 1.5 * normal(random));
    run.p2.values.push_back(m.p2 + 1.5 * normal(random));
    run.arm_angle.values.push_back(m.arm_angle + 4e-4 * normal(random));
  }
  return run;
}

std::vector<runs::MeasuredRun> Swings() { return {Swing(3, 0.4, 1), Swing(5, 0.25, 2), Swing(4, 0.6, 3)}; }

// Tests that the catalogue has it like any other effect, and so do model files and the simulation.
TEST(OwnEffect, IsInTheCatalogue) {
  const model::EffectInfo* info = model::FindEffect("arm.spring");
  ASSERT_NE(info, nullptr);
  EXPECT_EQ(info->parameters.at(0).unit, "in-lbf/rad");
  EXPECT_TRUE(std::is_sorted(model::EffectCatalogue().begin(), model::EffectCatalogue().end(),
                             [](const auto& a, const auto& b) { return a.id < b.id; }));
  EXPECT_THAT(settings::FormatModel(Sprung()), HasSubstr("[effects.\"arm.spring\"]"));
}

// Tests that it cannot be added once the catalogue is in use and references into it are held.
TEST(OwnEffect, IsAddedBeforeTheCatalogueIsUsed) {
  const size_t known = model::EffectCatalogue().size();
  model::CatalogueEntry late;
  late.info.id = "arm.other";
  EXPECT_THROW(model::AddToCatalogue(late), std::logic_error);
  EXPECT_EQ(model::EffectCatalogue().size(), known);
}

// Tests that the gap finder names it, with its stiffness within the interval, and that the model it writes
// has it.
TEST(OwnEffect, IsFound) {
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), Swings(), {}, {}, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
  ASSERT_EQ(d.effects.size(), 1) << d.sentence;
  EXPECT_EQ(d.effects[0].id, "arm.spring");
  EXPECT_EQ(d.effects[0].summary, "a spring pulls the arm to its middle");
  ASSERT_EQ(d.effects[0].parameters.size(), 1);
  EXPECT_LE(d.effects[0].parameters[0].low, kStiffness);
  EXPECT_GE(d.effects[0].parameters[0].high, kStiffness);
  EXPECT_LT(d.effects[0].parameters[0].high - d.effects[0].parameters[0].low, 0.1 * kStiffness);
  ASSERT_EQ(d.model.effects.size(), 1);
  EXPECT_LT(d.held_out.after, 1.1);
}

// Tests that where it may not be named, nothing else is named with confidence.
TEST(OwnEffect, NothingElseTakesItsPlace) {
  diagnose::DiagnoseOptions options;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (info.id != "arm.spring" && !info.on_request) options.effects.push_back(info.id);
  }
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), Swings(), {}, options, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kUnexplained) << d.sentence;
  ASSERT_FALSE(d.location.empty());
  EXPECT_EQ(d.location[0].balance, "arm_torque");
}

}  // namespace
}  // namespace hydro::testing
