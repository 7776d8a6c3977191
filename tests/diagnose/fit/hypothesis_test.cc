#include "diagnose/fit/hypothesis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "diagnose/fit/residuals.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::Change;
using diagnose::FreeParameter;
using diagnose::Hypothesis;

// Tests that free parameters carry the units of the model.
TEST(Hypothesis, UnitsOfTheModel) {
  Hypothesis hypothesis =
      WithFree(Table1With({{"arm.flexure", {{"stiffness", 1e4}, {"damping", 10}}, {}}}), {"b", "J_a"});
  EXPECT_EQ(hypothesis.Free()[0].unit, "in-lbf-s");
  hypothesis.model.units = {"m", "N", true};
  const std::vector<FreeParameter> free = hypothesis.Free();
  ASSERT_EQ(free.size(), 4u);
  EXPECT_EQ(free[0].unit, "N m s");
  EXPECT_EQ(free[1].unit, "N s^2/m");
  for (size_t i : {size_t{2}, size_t{3}}) {
    EXPECT_EQ(free[i].unit, free[i].name == "arm.flexure.stiffness" ? "N/m" : "N s/m") << free[i].name;
  }
}

// Tests that a speed by which friction changes is not sought beyond the fastest motion, where it would be
// another name for the friction that the model has.
TEST(Hypothesis, SpeedsWithinTheRuns) {
  Hypothesis hypothesis = WithFree(Table1With({{"pump.stribeck", {{"static_excess", 0.5}, {"speed", 3}}, {}},
                                               {"motor.speed_torque_limit", {{"no_load_speed", 700}}, {}}}),
                                   {});
  hypothesis.highest_speed = 40;
  const std::vector<FreeParameter> free = hypothesis.Free();
  ASSERT_EQ(free.size(), 3u);
  const auto named = [&](const char* name) { return *std::ranges::find(free, name, &FreeParameter::name); };
  EXPECT_EQ(named("pump.stribeck.speed").high, 40);
  EXPECT_GT(named("motor.speed_torque_limit.no_load_speed").high, 700);
}

// Tests that the largest speed is read off an encoder where no speed was recorded, whatever its steps.
TEST(Sizes, SpeedOfAnAngle) {
  diagnose::RunData run = SmallRun(Table1With(), model::Shaft::kClamped, false, 2, 1, 7);
  const double recorded = diagnose::SizesOf(Table1With(), {&run}).speed;
  diagnose::SignalData* speed = nullptr;
  for (diagnose::SignalData& signal : run.signals) {
    if (signal.channel == model::Channel::kMotorSpeed) speed = &signal;
  }
  ASSERT_NE(speed, nullptr);
  double angle = 0;
  speed->channel = model::Channel::kMotorAngle;
  for (size_t i = 0; i < speed->values.size(); ++i) {
    if (i > 0) angle += speed->values[i] * (run.stimulus.time[i] - run.stimulus.time[i - 1]);
    speed->values[i] = 1e-3 * std::round(angle / 1e-3);
  }
  EXPECT_NEAR(diagnose::SizesOf(Table1With(), {&run}).speed, recorded, 0.2 * recorded);
}

// Tests that free parameters can be read, set and moved, positive ones by their logarithms.
TEST(Hypothesis, FreeNumbers) {
  Hypothesis hypothesis = WithFree(Table1With({{"pump.quadratic_drag", {{"k", 2e-4}}, {}}}), {"b", "T_s"});
  const std::vector<FreeParameter> free = hypothesis.Free();
  ASSERT_EQ(free.size(), 3u);
  EXPECT_EQ(free[0].name, "b");
  EXPECT_EQ(free[0].value, Table1().b);
  EXPECT_EQ(free[2].name, "pump.quadratic_drag.k");
  EXPECT_EQ(free[2].value, 2e-4);
  for (const FreeParameter& parameter : free) {
    EXPECT_NEAR(parameter.FromFitted(parameter.ToFitted(parameter.value)), parameter.value, 1e-12);
    EXPECT_NEAR(parameter.Moved(1e-6) - parameter.value, 1e-6 * parameter.Slope(), 1e-11);
    EXPECT_LT(parameter.low, parameter.value);
    EXPECT_GT(parameter.high, parameter.value);
  }
  hypothesis.Set({0.02, 5, 3e-4});
  EXPECT_EQ(hypothesis.model.parameters.b, 0.02);
  EXPECT_EQ(hypothesis.model.parameters.T_s, 5);
  EXPECT_EQ(hypothesis.model.effects[0].parameters.at("k"), 3e-4);
}

// Tests that fits leave a number at its standard that need not be stated: of an effect that is added unasked,
// and of one that the model has without that number. Where the model states it, and in effects that are
// added only when asked for, it is free.
TEST(Hypothesis, OptionalNumbers) {
  const auto names = [](const Hypothesis& hypothesis) {
    std::vector<std::string> all;
    for (const FreeParameter& one : hypothesis.Free()) all.push_back(one.name);
    return all;
  };
  using Names = std::vector<std::string>;
  const auto given = [&](std::map<std::string, double> numbers) {
    return names(WithFree(Table1With({{"gear.load_friction", std::move(numbers), {}}}), {}));
  };
  EXPECT_EQ(given({{"load_share", 0.1}}), (Names{"gear.load_friction.load_share"}));
  EXPECT_EQ(given({{"load_share", 0.1}, {"motor_share", 0}}),
            (Names{"gear.load_friction.motor_share", "gear.load_friction.load_share"}));
  const auto added = [&](const char* effect) {
    const Hypothesis plain = WithFree(Table1With({}), {});
    return names(diagnose::With(plain, Change{effect, {}, ""}, diagnose::Sizes{.torque = 40}, {}).front());
  };
  EXPECT_EQ(added("gear.load_friction"), (Names{"gear.load_friction.load_share"}));
  EXPECT_EQ(added("motor.back_emf"), (Names{"motor.back_emf.k_e", "motor.back_emf.tau"}));
}

// Tests that a whole number of periods, which is counted and not fitted, is not free and stays when the free
// numbers are set, and that one that is no whole number is fitted.
TEST(Hypothesis, WholePeriodsStay) {
  for (const double periods : {9.0, 9.5}) {
    const model::EffectDescription ripple = {
        "motor.cogging", {{"amplitude", 0.1}, {"periods", periods}, {"phase", 0.5}}, {}};
    Hypothesis hypothesis = WithFree(Table1With({ripple}), {"b"});
    const bool whole = periods == 9.0;
    ASSERT_EQ(hypothesis.Free().size(), whole ? 3u : 4u);
    hypothesis.Set(whole ? std::vector{0.02, 0.2, 0.25} : std::vector{0.02, 0.2, 9.25, 0.25});
    const std::map<std::string, double> expected = {
        {"amplitude", 0.2}, {"periods", whole ? 9.0 : 9.25}, {"phase", 0.25}};
    EXPECT_EQ(hypothesis.model.effects[0].parameters, expected);
    std::vector<double> read;
    for (const FreeParameter& parameter : hypothesis.Free()) read.push_back(parameter.value);
    EXPECT_EQ(read.front(), 0.02);
    EXPECT_EQ(read.back(), 0.25);
  }
}

// Tests that a change is added with its starting points, named, told from another, and fully undone.
TEST(Hypothesis, ChangesThereAndBack) {
  const std::vector<diagnose::RunData> runs = OneOfEach(Table1With(), 0.5, 1);
  const diagnose::Sizes sizes = diagnose::SizesOf(Table1With(), PointersTo(runs));
  EXPECT_GT(sizes.pressure, 0);
  EXPECT_GT(sizes.speed, 0);
  EXPECT_NEAR(sizes.sample, 1e-3, 1e-9);
  Hypothesis plain;
  plain.model = Table1With();
  const Change drag{"pump.quadratic_drag", {}, ""}, skew{"sensor.skew", {{"signal", "p1"}}, ""},
      k_1{"", {}, "k_1"};
  EXPECT_EQ(drag.Label(), "pump.quadratic_drag");
  EXPECT_EQ(skew.Label(), "sensor.skew (p1)");
  EXPECT_EQ(k_1.Label(), "parameter k_1");
  const std::vector<Hypothesis> with = diagnose::With(plain, drag, sizes, {});
  ASSERT_FALSE(with.empty());
  for (const Hypothesis& one : with) {
    EXPECT_TRUE(one.Has(drag));
    EXPECT_FALSE(one.Has(k_1));
    ASSERT_EQ(one.model.effects.size(), 1u);
    EXPECT_EQ(one.model.effects[0].id, "pump.quadratic_drag");
  }
  Hypothesis both = diagnose::With(with[0], k_1, sizes, {}).at(0);
  both.model.parameters.k_1 = 9;
  const Hypothesis back = diagnose::Without(both, k_1, Table1With());
  EXPECT_EQ(back.model.parameters.k_1, Table1().k_1);
  EXPECT_TRUE(back.Has(drag));
  EXPECT_TRUE(diagnose::Without(back, drag, Table1With()).model.effects.empty());
}

// Tests that what an accumulator has taken in before a run is unknown where the model has one that remembers
// it, held to what oil can give up, and that no other model has this unknown.
TEST(StartUnknowns, WhatAnAccumulatorHasTakenIn) {
  const diagnose::RunData run = SmallRun(Table1With(), model::Shaft::kClamped, false, 0.5, 0, 1);
  const model::Unknown returned = {model::Unknown::Kind::kStart, model::kReturned};
  const auto has = [&](const model::ModelDescription& model) {
    const std::vector<model::Unknown> starts = diagnose::StartUnknowns(model, run);
    return std::find(starts.begin(), starts.end(), returned) != starts.end();
  };
  EXPECT_TRUE(has(Table1With({{"accumulator.stiffness", {{"stiffness", 3e3}}, {}}})));
  EXPECT_FALSE(has(Table1With()));
  EXPECT_FALSE(
      has(Table1With({{"line.wave", {{"frequency", 80}, {"volume_fraction", 0.3}, {"damping", 0.05}}, {}}})));
  EXPECT_EQ(run.start[model::kReturned], 0);
  EXPECT_NEAR(run.start_error[model::kReturned], 0.064, 0.005);  // in^3, of Table 1
}

// Tests that the truth's residuals are noise of 1, and that their derivatives match difference quotients.
TEST(Residuals, NoiseAndDerivatives) {
  diagnose::RunData run = SmallRun(Table1With(), model::Shaft::kClamped, false, 0.5, 0, 1);
  run.start = {0, 0, Table1().p_3, Table1().p_3, 0.3, 0};  // as the rig was, not as its first samples suggest
  const Hypothesis hypothesis = WithFree(Table1With(), {"b", "beta"});
  const std::vector<FreeParameter> free = hypothesis.Free();
  const std::vector<model::Unknown> starts = diagnose::StartUnknowns(hypothesis.model, run);
  EXPECT_FALSE(starts.empty());
  const diagnose::Residuals at = diagnose::ResidualsOf(hypothesis.model, run, run.start, free, starts);
  const size_t n = at.values.size();
  ASSERT_EQ(at.first.size(), run.signals.size() + 1);
  EXPECT_EQ(at.first.back(), n);
  ASSERT_EQ(at.jacobian.size(), n * (free.size() + starts.size()));
  double square = 0;
  for (const double value : at.values) square += value * value / static_cast<double>(n);
  EXPECT_NEAR(std::sqrt(square), 1, 0.3);
  EXPECT_EQ(diagnose::ResidualsOf(hypothesis.model, run, run.start).values, at.values);
  for (size_t p = 0; p < free.size(); ++p) {
    constexpr double kStep = 1e-4;
    const auto moved = [&](double by) {
      Hypothesis other = hypothesis;
      std::vector<double> values = {free[0].value, free[1].value};
      values[p] = free[p].Moved(by);
      other.Set(values);
      return diagnose::ResidualsOf(other.model, run, run.start).values;
    };
    const std::vector<double> up = moved(kStep), down = moved(-kStep);
    double off = 0, size = 0;
    for (size_t i = 0; i < n; ++i) {
      const double difference = (up[i] - down[i]) / (2 * kStep);
      off += std::pow(difference - at.jacobian[p * n + i], 2);
      size += difference * difference;
    }
    EXPECT_GT(size, 0) << free[p].name;
    EXPECT_LT(std::sqrt(off / size), 0.02) << free[p].name;
  }
}

// Tests that a resonance is not looked for beyond what the samples can show, and that a model's own frequency
// has no such limit.
TEST(Hypothesis, FrequenciesBelowHalfTheSamplingRate) {
  const model::ModelDescription wave =
      Table1With({{"line.wave", {{"frequency", 300}, {"volume_fraction", 0.1}, {"damping", 0.1}}, {}}});
  Hypothesis hypothesis = WithFree(wave, {});
  const auto highest = [&] {
    for (const FreeParameter& one : hypothesis.Free()) {
      if (one.role == model::Role::kFrequency) return one.high;
    }
    return 0.0;
  };
  EXPECT_GT(highest(), 1000);
  hypothesis.highest_frequency = 500;
  EXPECT_EQ(highest(), 500);
}

// Tests that a fit stays within twice what is given and estimated, both ways where a value cannot be nothing,
// and upwards where it can.
TEST(Hypothesis, ReachesTwiceAsFarAsGivenAndEstimated) {
  Hypothesis hypothesis;
  hypothesis.model = {"Table 1", testing::Table1(), {}};
  model::Parameters estimated = testing::Table1();
  estimated.J *= 3;
  estimated.b *= 0.5;
  estimated.mgl = 0;
  hypothesis.reach =
      std::make_shared<const diagnose::ValueReach>(diagnose::ReachOf(testing::Table1(), estimated));
  for (const char* name : {"J", "b", "mgl"}) hypothesis.base.push_back(model::BasePlace(name));
  const std::vector<FreeParameter> free = hypothesis.Free();
  EXPECT_DOUBLE_EQ(free[0].low, testing::Table1().J / 2);
  EXPECT_DOUBLE_EQ(free[0].high, testing::Table1().J * 6);
  EXPECT_DOUBLE_EQ(free[1].low, 0);
  EXPECT_DOUBLE_EQ(free[1].high, testing::Table1().b * 2);
  EXPECT_EQ(free[2].high, model::BaseParameters()[hypothesis.base[2]].info.max);
}

}  // namespace
}  // namespace hydro::testing
