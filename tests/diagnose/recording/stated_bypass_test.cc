#include "diagnose/recording/stated_bypass.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/recording/oil_spring.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/diagnose/recording/swing.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::NoisyRig;
using testing::Table1Model;

// What a recording has, beside the command.
struct Columns {
  bool p1 = true, p2 = true, speed = true, angle = true;
};

constexpr Columns kLayouts[] = {{true, true, true, true},
                                {true, false, true, false},
                                {false, false, true, true},
                                {false, false, true, false},
                                {false, false, false, true}};

runs::MeasuredRun With(const Columns& columns, runs::MeasuredRun run) {
  if (!columns.p1) run.p1 = {};
  if (!columns.p2) run.p2 = {};
  if (!columns.speed) run.motor_speed = {};
  if (!columns.angle) run.motor_angle = {};
  run.sidecar = "rig/run.toml";
  return run;
}

// What is said of the run with its bypass as it was, or stated wrongly.
std::string Said(runs::MeasuredRun run, bool wrongly, const model::ModelDescription& model = Table1Model()) {
  if (wrongly) run.bypass = !run.bypass;
  return StatedBypassContradiction(model.parameters, run);
}

double Levels(double t) {
  constexpr double kLevels[] = {0, 3, -2, 6, 1.5, -5, 4, -7, 0.5, -3, 8, 2, -1, 5, 0};
  return kLevels[static_cast<int>(t / 0.2) % 15];
}

runs::MeasuredRun Clamped(bool bypass, const model::ModelDescription& model = Table1Model()) {
  NoisyRig rig;
  rig.model = model;
  return rig.Record("run", model::Shaft::kClamped, 0, 3, bypass, Levels).measured;
}

runs::MeasuredRun Free(const model::ModelDescription& model = Table1Model()) {
  NoisyRig rig;
  rig.model = model;
  const auto swing = [](double t) { return std::fmod(2 * t, 1.0) < 0.5 ? 3.0 : -3.0; };
  return rig.Record("run", model::Shaft::kFree, -0.2, 3, false, swing).measured;
}

// Tests that a wrong bypass is named with the line that mends it, whichever signals were recorded, and a
// right one is not.
TEST(StatedBypass, Clamped) {
  for (const bool open : {false, true}) {
    const runs::MeasuredRun run = Clamped(open);
    for (const Columns& columns : kLayouts) {
      SCOPED_TRACE(std::to_string(open) + (columns.p1 ? " p1" : "") + (columns.p2 ? " p2" : "") +
                   (columns.speed ? " speed" : "") + (columns.angle ? " angle" : ""));
      EXPECT_THAT(Said(With(columns, run), false), IsEmpty());
      EXPECT_THAT(Said(With(columns, run), true),
                  HasSubstr(std::string("this in run.toml mends it: bypass = ") + (open ? "true" : "false")));
    }
  }
}

// Tests that an arm which follows the motor contradicts an open bypass, and one that stays where it is a
// closed one.
TEST(StatedBypass, FreeArm) {
  const runs::MeasuredRun closed = Free();
  for (const Columns& columns : kLayouts) {
    EXPECT_THAT(Said(With(columns, closed), false), IsEmpty());
    EXPECT_THAT(Said(With(columns, closed), true), HasSubstr("mends it: bypass = false"));
  }
  NoisyRig rig;
  rig.model = Table1Model();
  const runs::MeasuredRun open =
      rig.Record("run", model::Shaft::kFree, -0.2, 3, true, [](double t) { return Levels(t) / 2; }).measured;
  for (const Columns& columns : kLayouts) {
    EXPECT_THAT(Said(With(columns, open), false), IsEmpty());
    EXPECT_THAT(Said(With(columns, open), true), HasSubstr("mends it: bypass = true"));
  }
}

// Tests the spring itself: of the oil's stiffness where it is closed, none where it is open; an arm that
// follows through the same volumes; and nothing where the run is too short.
TEST(OilSpring, Stiffness) {
  const model::Parameters model = Table1Model().parameters;
  const auto spring = FitOilSpring(model, With(kLayouts[3], Clamped(false)));
  ASSERT_TRUE(spring.has_value());
  EXPECT_NEAR(spring->stiffness, 1, 0.3);
  EXPECT_LT(spring->error, 0.1);
  EXPECT_LT(spring->left, 0.5 * spring->left_without);
  const auto none = FitOilSpring(model, With(kLayouts[4], Clamped(true)));
  ASSERT_TRUE(none.has_value());
  EXPECT_NEAR(none->stiffness, 0, 0.05);
  EXPECT_GT(none->would_take, 1);
  EXPECT_NEAR(none->inertia, 1, 0.1);
  const auto free = FitOilSpring(model, With(kLayouts[3], Free()));
  ASSERT_TRUE(free.has_value());
  EXPECT_GT(free->follows, 0.95);
  EXPECT_NEAR(free->volume, 1, 0.2);
  runs::MeasuredRun few = Clamped(true);
  few.Keep(0, 20);
  EXPECT_FALSE(FitOilSpring(model, few).has_value());
}

// Tests that values of the model that are wrong by a half do not pass for a bypass.
TEST(StatedBypass, WrongValues) {
  for (double model::Parameters::*member :
       {&model::Parameters::J, &model::Parameters::b, &model::Parameters::T_s, &model::Parameters::beta}) {
    for (const double factor : {0.6, 1.5}) {
      model::ModelDescription wrong = Table1Model();
      wrong.parameters.*member *= factor;
      for (const bool open : {false, true}) {
        EXPECT_THAT(Said(With(kLayouts[3], Clamped(open)), false, wrong), IsEmpty());
      }
    }
  }
}

// Tests that an arm that bends, whose angle is not the vane's, is no open bypass.
TEST(StatedBypass, FlexibleArm) {
  model::ModelDescription bends = Table1Model();
  bends.effects.push_back({"arm.flexure", {{"stiffness", 20000}, {"damping", 60}}, {}});
  EXPECT_THAT(Said(Free(bends), false), IsEmpty());
  EXPECT_THAT(Said(With(kLayouts[3], Free(bends)), false), IsEmpty());
}

// Tests that a bare motor, whose model has oil only because it must, is told to say so, and one that stands
// still is not.
TEST(StatedBypass, BareMotor) {
  model::ModelDescription bare = Table1Model();
  bare.parameters.D = 1e-6;
  bare.parameters.c_I = bare.parameters.c_E = 0;
  const runs::MeasuredRun run = With(kLayouts[3], Clamped(true, bare));
  EXPECT_THAT(Said(run, false, bare), IsEmpty());
  EXPECT_THAT(Said(run, true, bare), HasSubstr("the motor is bare, or the bypass was open"));
  NoisyRig rig;
  rig.model = bare;
  rig.angle_measured = false;
  const runs::MeasuredRun still =
      rig.Record("run", model::Shaft::kClamped, 0, 1, true, [](double t) { return 0.02 * Levels(t); })
          .measured;
  EXPECT_THAT(Said(With(kLayouts[3], still), true, bare), IsEmpty());
  // Counts that an encoder at rest makes are no turns.
  runs::MeasuredRun counts = With(kLayouts[4], run);
  counts.motor_angle.values.clear();
  for (size_t i = 0; i < counts.samples(); ++i)
    counts.motor_angle.values.push_back(1e-3 * static_cast<double>(i % 3));
  EXPECT_THAT(Said(counts, true, bare), IsEmpty());
}

// Tests that signs and units that are wrong are not taken for a bypass: they are named as what they are.
TEST(StatedBypass, OtherMistakes) {
  for (const bool open : {false, true}) {
    for (const double factor : {-1.0, 60 / (2 * 3.14159265), 0.104719755}) {
      runs::MeasuredRun run = With(kLayouts[3], Clamped(open));
      for (double& speed : run.motor_speed.values) speed *= factor;
      EXPECT_THAT(Said(run, false), IsEmpty()) << open << " " << factor;
      run = With(kLayouts[3], Clamped(open));
      for (double& volts : run.voltage.values) volts *= factor;
      EXPECT_THAT(Said(run, false), IsEmpty()) << open << " " << factor;
    }
  }
}

}  // namespace
}  // namespace hydro::diagnose
