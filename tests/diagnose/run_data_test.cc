#include "diagnose/recording/run_data.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "diagnose/recording/smoothed_motion.h"
#include "model/terms/state.h"
#include "runs/measured/sample_times.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/diagnose/prepare_run.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

// Which of the base states are free at the start.
std::vector<bool> FreeStates(const diagnose::RunData& data) {
  return std::vector<bool>(data.start_free.begin(), data.start_free.begin() + 6);
}

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Half a second of a clamped run at 1 kHz: speed decaying from 50 rad/s, pressures from 120 and 140 psi.
runs::MeasuredRun ClampedRun() {
  runs::MeasuredRun run;
  run.name = "step";
  run.file = "step.csv";
  run.shaft = model::Shaft::kClamped;
  run.arm_angle_rad = 0.2;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (size_t i = 0; i < 500; ++i) {
    const double t = 1 + 0.001 * static_cast<double>(i);
    run.lines.push_back(i + 2);
    run.time.push_back(t);
    run.voltage.values.push_back(2);
    run.motor_speed.values.push_back(50 * std::exp(-(t - 1) * 5) + 0.3 * normal(random));
    run.p1.values.push_back(120 - 50 * (t - 1) + 1.5 * normal(random));
    run.p2.values.push_back(140 + 900 * (t - 1) + 1.5 * normal(random));
  }
  run.p1.noise = 1.0;
  return run;
}

runs::MeasuredRun WithArm(model::Shaft shaft) {
  runs::MeasuredRun run = ClampedRun();
  run.shaft = shaft;
  run.arm_angle_rad = 0;
  for (const double t : run.time)
    run.arm_angle.values.push_back(0.3 * std::sin(2 * std::numbers::pi * (t - 1)));
  return run;
}

std::string ErrorOf(const std::function<void(runs::MeasuredRun&)>& change,
                    runs::MeasuredRun run = ClampedRun()) {
  change(run);
  try {
    PrepareRun(run, testing::Table1());
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "no error";
}

// Tests which signals of a clamped run are compared, which start it, and what is known of it.
TEST(PrepareRun, Clamped) {
  const RunData data = PrepareRun(ClampedRun(), testing::Table1());
  EXPECT_EQ(data.name, "step");
  EXPECT_EQ(data.samples(), 500u);
  EXPECT_NEAR(data.duration(), 0.499, 1e-9);
  EXPECT_EQ(data.stimulus.motion, nullptr);
  ASSERT_EQ(data.signals.size(), 3u);
  EXPECT_EQ(data.Find(model::Channel::kArmAngle), nullptr);
  const SignalData* p1 = data.Find(model::Channel::kP1);
  ASSERT_NE(p1, nullptr);
  EXPECT_EQ(p1->noise, 1.0);  // as stated
  EXPECT_EQ(p1->stated_noise, 1.0);
  EXPECT_NEAR(p1->estimated_noise, 1.5, 0.2);
  EXPECT_NEAR(data.Find(model::Channel::kP2)->noise, 1.5, 0.2);
  EXPECT_TRUE(std::isnan(data.Find(model::Channel::kP2)->stated_noise));
  EXPECT_EQ(p1->valid, 500u);
  EXPECT_NEAR(data.start[model::kMotorSpeed], 50, 1);
  EXPECT_NEAR(data.start[model::kP1], 120, 3);
  EXPECT_NEAR(data.start[model::kP2], 140, 3);
  EXPECT_EQ(data.start[model::kArmAngle], 0.2);
  EXPECT_THAT(FreeStates(data), ElementsAre(false, true, true, true, false, false));
  // Noise, a scale that may be wrong by 3 %, and a slope; nothing is known of what is not measured.
  EXPECT_NEAR(data.start_error[model::kP1], 3 * 1.0 + 0.03 * 120, 5);
  EXPECT_GT(data.start_error[model::kP1], 3 * 1.0 + 0.03 * 115);
  EXPECT_TRUE(std::isinf(data.start_error[model::kMotorAngle]));
  EXPECT_TRUE(std::isinf(data.start_error[model::kArmSpeed]));
}

// Tests that a first speed within the noise is dropped, and a larger one is kept.
TEST(PrepareRun, RestIsRest) {
  testing::NoisyRig rig;
  rig.model = {"Table 1", testing::Table1(), {}};
  for (rig.seed = 1; rig.seed <= 8; ++rig.seed) {
    const RunData run =
        rig.Record("rest", model::Shaft::kFree, -0.1, 0.5, false, [](double t) { return t < 0.1 ? 0 : 5.0; });
    EXPECT_EQ(run.start[model::kMotorSpeed], 0) << rig.seed;
    EXPECT_NEAR(run.start[model::kArmSpeed], 0, 0.02) << rig.seed;
  }
}

// Tests that a recording that cannot be put on an even grid is refused, with where and what to do: rows
// without end between two, and rows too far apart to show a motion.
TEST(PrepareRun, RefusesTimesWithoutMotion) {
  const auto error = [](const runs::MeasuredRun& run) -> std::string {
    try {
      PrepareRun(run, testing::Table1());
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  runs::MeasuredRun gap = WithArm(model::Shaft::kFree);
  for (size_t i = 300; i < gap.samples(); ++i) gap.time[i] += 1e7;
  EXPECT_THAT(error(gap), ::testing::AllOf(HasSubstr("time: found no row between"), HasSubstr("1e+07")));
  runs::MeasuredRun short_gap = WithArm(model::Shaft::kFree);
  for (size_t i = 300; i < short_gap.samples(); ++i) short_gap.time[i] += 5;
  EXPECT_EQ(error(short_gap), "");
  runs::MeasuredRun slow = WithArm(model::Shaft::kFree);
  for (double& time : slow.time) time *= 1e6;
  EXPECT_THAT(error(slow), HasSubstr("unit = \"us\""));
  runs::MeasuredRun fast = WithArm(model::Shaft::kFree);
  for (double& time : fast.time) time *= 1e-9;
  EXPECT_THAT(error(fast),
              ::testing::AllOf(HasSubstr("time: found rows 1e-12 s apart, allowed at least 5e-06 s"),
                               HasSubstr("is the column in another unit?")));
  fast.time_source.scale = 1e-9;
  EXPECT_THAT(error(fast), HasSubstr("(is the column in s? unit = \"s\")"));
}

// Tests that many gaps, none of them long, are as little an even grid as a single long one.
TEST(PrepareRun, RefusesUnevenTimes) {
  const auto uneven = [](double often) {
    return [often](runs::MeasuredRun& run) {
      for (size_t i = 1; i < run.samples(); ++i) run.time[i] = run.time[i - 1] + (i % 5 < 3 ? often : 0.01);
    };
  };
  EXPECT_EQ(ErrorOf(uneven(1e-3)), "no error");
  EXPECT_EQ(
      ErrorOf(uneven(1e-5)),
      "step.csv: time: found rows of which half are at most 1e-05 s apart, and 500 of them in 2.003 s, "
      "allowed rows that are about equally far apart: where they were taken evenly, set time = { every = "
      "0.00401 } in the sidecar; where they come in stretches, make a table of each");
}

// Tests that a clamped arm beyond the stroke is refused, with the sidecar and its key.
TEST(PrepareRun, RefusesAnArmBeyondItsStroke) {
  const auto held_at = [](double angle) {
    return ErrorOf([angle](runs::MeasuredRun& run) {
      run.sidecar = "step.toml";
      run.arm_angle_rad = angle;
    });
  };
  for (const double angle : {10.0, -10.0})
    EXPECT_THAT(held_at(angle), ::testing::StartsWith("step.toml: arm_angle or arm_angle_rad: found " +
                                                      std::string(angle > 0 ? "10" : "-10") +
                                                      " rad of a clamped shaft, allowed angles between -"));
  EXPECT_EQ(held_at(-0.2), "no error");
}

// Tests that of a cylinder with unequal areas each end of the stroke is its own side's: V_ms/c_1 up, and
// V_ms/c_2 down. For each, the mean's stroke would do the opposite of what is right.
TEST(PrepareRun, EachSideHasItsOwnStroke) {
  model::ModelDescription rod = {"rod", testing::Table1(), {}};
  rod.effects = {{.id = "actuator.unequal_areas", .parameters = {{"difference", 0.3}}, .names = {}}};
  const double mean = rod.parameters.V_ms / rod.parameters.c;
  const auto refused = [&](double part) {
    runs::MeasuredRun run = ClampedRun();
    run.arm_angle_rad = part * mean;
    try {
      PrepareRun(run, rod);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(1.35));
  EXPECT_TRUE(refused(1.45));
  EXPECT_FALSE(refused(-0.75));
  EXPECT_TRUE(refused(-0.8));
  runs::MeasuredRun driven = WithArm(model::Shaft::kDriven);
  const double bottom = std::ranges::min(driven.arm_angle.values);
  const double swing = 1.2 * mean / (std::ranges::max(driven.arm_angle.values) - bottom);
  for (double& angle : driven.arm_angle.values) angle = -0.2 * mean + swing * (angle - bottom);
  EXPECT_NO_THROW(PrepareRun(driven, rod)) << "up to the mean's stroke";
  for (double& angle : driven.arm_angle.values) angle -= 0.65 * mean;
  EXPECT_THROW(PrepareRun(driven, rod), InputError) << "down to 0.85 of it";
}

// Tests that a free arm is compared, and starts at a speed from the angle's slope.
TEST(PrepareRun, Free) {
  const RunData data = PrepareRun(WithArm(model::Shaft::kFree), testing::Table1());
  EXPECT_NE(data.Find(model::Channel::kArmAngle), nullptr);
  EXPECT_NEAR(data.start[model::kArmSpeed], 0.3 * 2 * std::numbers::pi, 0.01);
  EXPECT_THAT(FreeStates(data), ElementsAre(false, true, true, true, true, true));
}

// Tests that a driven arm is imposed and not compared.
TEST(PrepareRun, Driven) {
  RunData data = PrepareRun(WithArm(model::Shaft::kDriven), testing::Table1());
  EXPECT_EQ(data.Find(model::Channel::kArmAngle), nullptr);
  const RunData moved = std::move(data);
  ASSERT_EQ(moved.stimulus.motion, moved.motion.get());
  EXPECT_TRUE(moved.motion->continuous());
  EXPECT_NEAR(moved.motion->Value(1.25), 0.3, 1e-4);
  EXPECT_NEAR(moved.start[model::kArmSpeed], 0.3 * 2 * std::numbers::pi, 0.02);
}

// Tests that with the bypass open there is one pressure to start from.
TEST(PrepareRun, Bypass) {
  runs::MeasuredRun run = ClampedRun();
  run.bypass = true;
  const RunData data = PrepareRun(run, testing::Table1());
  EXPECT_EQ(data.start[model::kP1], data.start[model::kP2]);
  EXPECT_NEAR(data.start[model::kP1], 130, 3);
  EXPECT_THAT(FreeStates(data), ElementsAre(false, true, true, false, false, false));
}

// Tests that unmeasured quantities start from measured ones: speed from the angle, pressures at p_3.
TEST(PrepareRun, StartOfWhatIsNotMeasured) {
  runs::MeasuredRun run = ClampedRun();
  run.motor_speed = {};
  run.p1 = run.p2 = {};
  for (const double t : run.time) run.motor_angle.values.push_back(3 + 20 * (t - 1));
  const RunData data = PrepareRun(run, testing::Table1());
  EXPECT_NEAR(data.start[model::kMotorAngle], 3, 1e-3);
  EXPECT_NEAR(data.start[model::kMotorSpeed], 20, 1e-3);
  EXPECT_EQ(data.start[model::kP1], 100);
  EXPECT_TRUE(data.start_free[model::kMotorAngle]);
}

// Tests that of times in a unit that nobody stated the one is named in which the samples are those of such a
// machine, none where none is, and that there is no question where they are so as they stand.
TEST(PrepareRun, NamesTheUnitOfTimes) {
  for (const auto& [interval, unit] : {std::pair(1.0, "ms"), std::pair(10.0, "ms"), std::pair(1e3, "us"),
                                       std::pair(2e4, "us"), std::pair(1e6, "ns"), std::pair(2e7, "ns")}) {
    EXPECT_EQ(runs::TimeUnitHint(interval, 1),
              std::string(" (is the column in ") + unit + "? unit = \"" + unit + "\")");
  }
  for (const double interval : {1e-3, 0.2}) EXPECT_EQ(runs::TimeUnitHint(interval, 1), "");
  EXPECT_EQ(runs::TimeUnitHint(1e12, 1), " (is the column in another unit?)");
  // Microseconds that a sidecar calls milliseconds, and seconds that it calls microseconds.
  EXPECT_EQ(runs::TimeUnitHint(1, 1e-3), " (is the column in us? unit = \"us\")");
  EXPECT_EQ(runs::TimeUnitHint(1e-9, 1e-6), " (is the column in s? unit = \"s\")");
}

// Tests that data from which nothing can be learnt are refused with run, signal and row.
TEST(PrepareRun, Refusals) {
  EXPECT_EQ(ErrorOf([](runs::MeasuredRun& run) { run.time.resize(99); }),
            "step.csv: found 99 samples, allowed 100 or more");
  EXPECT_EQ(ErrorOf([](runs::MeasuredRun& run) { run.p1.values.assign(500, 7.0); }),
            "step.csv: line 2: p1: found 7 psi here and in every later row, allowed a signal that "
            "changes, or leave it out");
  EXPECT_EQ(ErrorOf([](runs::MeasuredRun& run) { run.p2.values.assign(500, runs::kMissing); }),
            "step.csv: p2: found no value in any row, allowed 20 values or more, or leave the signal out");
  EXPECT_EQ(ErrorOf([](runs::MeasuredRun& run) { run.motor_speed.values[3] = -2e5; }),
            "step.csv: line 5: motor_speed: found -200000 rad/s, allowed -100000 to 100000 with this model: "
            "is the column in another unit?");
  EXPECT_THAT(ErrorOf([](runs::MeasuredRun& run) { run.p1.values[0] = 690000; }),
              HasSubstr("line 2: p1: found"));
  EXPECT_THAT(ErrorOf([](runs::MeasuredRun& run) { run.voltage.values[9] = 24000; }),
              HasSubstr("line 11: voltage: found 24000 V, allowed -10000 to 10000"));
  EXPECT_THAT(ErrorOf([](runs::MeasuredRun& run) { run.motor_speed = run.p1 = run.p2 = {}; }),
              HasSubstr("step.csv: found no signal to compare with a model"));
  EXPECT_THAT(
      ErrorOf([](runs::MeasuredRun& run) { run.arm_angle.values[50] = 0.9; }, WithArm(model::Shaft::kDriven)),
      HasSubstr("line 52: arm_angle: found 0.9 rad"));
  EXPECT_THAT(
      ErrorOf([](runs::MeasuredRun& run) { run.arm_angle.values[50] = 17; }, WithArm(model::Shaft::kFree)),
      HasSubstr("line 52: arm_angle: found 17 rad"));
}

// Tests that limits apply in the model's own units: 100 bar in Pa is nothing unusual in SI.
TEST(PrepareRun, LimitsFollowTheModelsUnits) {
  model::Parameters si = testing::Table1();
  si.beta *= 6894.757;
  runs::MeasuredRun run = ClampedRun();
  for (double& p : run.p2.values) p *= 6894.757;
  EXPECT_NO_THROW(PrepareRun(run, si));
}

// Tests that signals that may stand still are accepted when they do: a voltage, a driven arm, and in a log of
// the stack without noise a side that stays on its one-way valve.
TEST(PrepareRun, ConstantButRight) {
  EXPECT_EQ(ErrorOf([](runs::MeasuredRun& run) { run.arm_angle.values.assign(500, 0.1); },
                    WithArm(model::Shaft::kDriven)),
            "no error");
  EXPECT_EQ(ErrorOf([](runs::MeasuredRun& run) { run.arm_angle.values.assign(500, 0.1); },
                    WithArm(model::Shaft::kFree)),
            "no error");
  EXPECT_EQ(ErrorOf([](runs::MeasuredRun& run) {
              run.model_text = "of a log";
              run.p1.noise.reset();
              run.p1.values.assign(500, 100.0);
            }),
            "no error");
}

// Tests that a noise is never 0, since residuals are divided by it.
TEST(PrepareRun, NoiseIsAboveZero) {
  runs::MeasuredRun run = WithArm(model::Shaft::kFree);
  run.arm_angle.values.assign(500, 0.1);
  for (size_t i = 0; i < 500; ++i) run.p2.values[i] = 100 + static_cast<double>(i);
  for (const SignalData& signal : PrepareRun(run, testing::Table1()).signals) EXPECT_GT(signal.noise, 0);
}

// Tests that readings of a saturated sensor count as missing, and that those of a side resting on its one-way
// valve in a run without noise, and a coarse reading of an angle at rest, do not.
TEST(PrepareRun, Saturation) {
  runs::MeasuredRun run = ClampedRun();
  size_t beyond = 0;
  for (double& p : run.p2.values) {
    if (p <= 400) continue;
    p = 400;
    ++beyond;
  }
  ASSERT_GT(beyond, 100u);
  const RunData data = PrepareRun(run, testing::Table1());
  EXPECT_EQ(data.Find(model::Channel::kP2)->saturated, beyond);
  EXPECT_EQ(data.Find(model::Channel::kP2)->valid, 500 - beyond);
  EXPECT_NEAR(data.Find(model::Channel::kP2)->noise, 1.5, 0.3);
  EXPECT_EQ(data.Find(model::Channel::kP1)->saturated, 0u);

  runs::MeasuredRun quiet = ClampedRun();
  for (size_t i = 0; i < 500; ++i) {
    quiet.p1.values[i] = 100 + std::max(0.0, 300 * std::sin(0.02 * static_cast<double>(i)));
    quiet.motor_speed.values[i] = std::round(std::max(0.0, 20 * std::sin(0.02 * static_cast<double>(i))));
  }
  const RunData still = PrepareRun(quiet, testing::Table1());
  EXPECT_EQ(still.Find(model::Channel::kP1)->saturated, 0u);
  EXPECT_EQ(still.Find(model::Channel::kMotorSpeed)->saturated, 0u);
}

// Tests that runs with the same name are told apart.
TEST(MakeNamesUnique, NumbersWhatIsTaken) {
  std::vector<RunData> runs(4);
  runs[0].name = runs[1].name = runs[3].name = "a";
  runs[2].name = "a (2)";
  MakeNamesUnique(&runs);
  std::vector<std::string> names;
  for (const RunData& run : runs) names.push_back(run.name);
  EXPECT_THAT(names, ElementsAre("a", "a (2)", "a (2) (2)", "a (3)"));
}

// The largest error of the smoothed motion's rate against 0.4 sin(2 pi f t), without its ends, and that of
// monotone cubics through the samples.
struct RateErrors {
  double smooth = 0, through = 0;
};

RateErrors ErrorsOfRate(const std::vector<double>& time, const std::vector<double>& angle, double noise,
                        double frequency) {
  const std::unique_ptr<trajectory::Trajectory> smooth = SmoothMotion(time, angle, noise, {}, 0);
  std::vector<trajectory::Step> steps;
  for (size_t i = 0; i < time.size(); ++i) steps.push_back({time[i], angle[i]});
  const std::unique_ptr<trajectory::Trajectory> through =
      trajectory::MakePoints(steps, trajectory::Interpolation::kCubic);
  RateErrors errors;
  const double w = 2 * std::numbers::pi * frequency;
  for (double t = time[20]; t < time[time.size() - 20]; t += 0.37e-3) {
    const double rate = 0.4 * w * std::cos(w * t);
    errors.smooth = std::max(errors.smooth, std::abs(smooth->Rate(t) - rate));
    errors.through = std::max(errors.through, std::abs(through->Rate(t) - rate));
  }
  return errors;
}

// Tests that the rate of a sine read by a 14-bit encoder is far better than that of cubics through the
// readings.
TEST(SmoothMotion, EncoderSine) {
  const double q = 2 * std::numbers::pi / 16384;
  std::vector<double> time, angle;
  for (size_t i = 0; i < 3000; ++i) {
    time.push_back(0.0005 * static_cast<double>(i));
    angle.push_back(q * std::round(0.4 * std::sin(2 * std::numbers::pi * 2 * time.back()) / q));
  }
  const RateErrors errors = ErrorsOfRate(time, angle, q / std::sqrt(12.0), 2);
  EXPECT_LT(errors.smooth, 0.1);  // of 5 rad/s
  EXPECT_GT(errors.through, 5 * errors.smooth);
}

// Tests that a noiseless motion is followed exactly enough, even with uneven or missing samples.
TEST(SmoothMotion, WithoutNoise) {
  std::vector<double> time, angle;
  for (size_t i = 0; i < 1000; ++i) {
    time.push_back(0.001 * static_cast<double>(i) + (i % 3 == 0 ? 3e-4 : 0));
    angle.push_back(i % 10 == 4 ? runs::kMissing : 0.4 * std::sin(2 * std::numbers::pi * 2 * time.back()));
  }
  const std::unique_ptr<trajectory::Trajectory> motion = SmoothMotion(time, angle, 8e-6, {}, 0);
  for (double t = 0.05; t < 0.95; t += 0.0007) {
    EXPECT_NEAR(motion->Value(t), 0.4 * std::sin(4 * std::numbers::pi * t), 3e-5);
    EXPECT_NEAR(motion->Rate(t), 1.6 * std::numbers::pi * std::cos(4 * std::numbers::pi * t), 0.01);
  }
  EXPECT_GE(motion->Max(), 0.39999);
  EXPECT_EQ(motion->Value(-1), motion->Value(time.front()));
  EXPECT_EQ(motion->Rate(2), 0);
}

// Tests that a measured rate improves the motion's rate.
TEST(SmoothMotion, MeasuredRate) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> time, angle, rate;
  for (size_t i = 0; i < 500; ++i) {
    time.push_back(0.02 * static_cast<double>(i));
    angle.push_back(0.4 * std::sin(2 * std::numbers::pi * 0.5 * time.back()) + 0.002 * normal(random));
    rate.push_back(0.4 * std::numbers::pi * std::cos(2 * std::numbers::pi * 0.5 * time.back()) +
                   0.005 * normal(random));
  }
  const auto error = [&](const trajectory::Trajectory& motion) {
    double sum = 0;
    for (size_t i = 0; i + 1 < time.size(); ++i) {
      sum +=
          std::pow(motion.Rate(time[i]) - 0.4 * std::numbers::pi * std::cos(std::numbers::pi * time[i]), 2);
    }
    return std::sqrt(sum / 500);
  };
  const double without = error(*SmoothMotion(time, angle, 0.002, {}, 0));
  const double with = error(*SmoothMotion(time, angle, 0.002, rate, 0.005));
  EXPECT_LT(with, 0.005);
  EXPECT_LT(with, 0.6 * without);
}

}  // namespace
}  // namespace hydro::diagnose
