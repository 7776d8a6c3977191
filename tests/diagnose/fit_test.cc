// Fits recover the numbers that runs were made with, keep to bounds, and are the same every time.
#include "diagnose/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>

#include "diagnose/recording/windows.h"
#include "model/terms/state.h"
#include "tests/diagnose/prepare_run.h"
#include "tests/diagnose/small_runs.h"
#include "tests/model_in_units.h"

namespace hydro::testing {
namespace {

diagnose::Fitted FitRuns(const diagnose::Hypothesis& hypothesis, const std::vector<diagnose::RunData>& runs,
                         int jobs = 1) {
  diagnose::FitOptions options;
  options.tolerance = 1e-6;
  options.jobs = jobs;
  return diagnose::Fit(hypothesis, PointersTo(runs), StartsOf(runs), options);
}

double ValueOf(const diagnose::Fitted& fitted, const std::string& name) {
  for (const diagnose::FreeParameter& parameter : fitted.hypothesis.Free()) {
    if (parameter.name == name) return parameter.value;
  }
  ADD_FAILURE() << name << " is not free";
  return NAN;
}

// Tests that wrong base parameters are corrected, to within the noise.
TEST(Fit, RecoversBaseParameters) {
  model::ModelDescription truth = Table1With();
  truth.parameters.k_1 = 4.3;
  truth.parameters.b = 0.018;
  truth.parameters.T_s = 4.5;
  truth.parameters.c_E = 3e-5;
  const std::vector<diagnose::RunData> runs = OneOfEach(truth, 0.6, 1);
  const diagnose::Fitted fitted = FitRuns(WithFree(Table1With(), {"k_1", "b", "T_s", "c_E"}), runs);
  ASSERT_TRUE(fitted.ok()) << fitted.failure;
  EXPECT_NEAR(ValueOf(fitted, "k_1"), 4.3, 0.01 * 4.3);
  EXPECT_NEAR(ValueOf(fitted, "b"), 0.018, 0.02 * 0.018);
  EXPECT_NEAR(ValueOf(fitted, "T_s"), 4.5, 0.02 * 4.5);
  EXPECT_NEAR(ValueOf(fitted, "c_E"), 3e-5, 0.05 * 3e-5);
  EXPECT_NEAR(fitted.squared_gap(), 1, 0.1);
  EXPECT_EQ(fitted.runs.size(), runs.size());
}

// The same run with its pressures in the units of another system.
void ConvertTo(const UnitSystem& to, diagnose::RunData* run) {
  const double pressure = Factor("psi", 0, {}, to);
  for (diagnose::SignalData& signal : run->signals) {
    if (signal.channel != model::Channel::kP1 && signal.channel != model::Channel::kP2) continue;
    for (double& value : signal.values) value *= pressure;
    signal.noise *= pressure;
  }
  for (const size_t state : {size_t{model::kP1}, size_t{model::kP2}}) {
    run->start[state] *= pressure;
    run->start_error[state] *= pressure;
  }
  run->start_error[model::kReturned] *= Factor("in^3", 0, {}, to);
}

// Tests that a fit ends at the same values in all systems of units: it once stopped early where pressures are
// large numbers, and what was left was said to be physics.
TEST(Fit, EndsAtTheSameValuesInAllUnits) {
  const std::vector<std::string> free = {"k_1", "D", "J", "b", "T_s", "beta", "c", "c_E", "c_I", "p_3"};
  model::ModelDescription truth = Table1With(), given = truth;
  given.parameters.k_1 *= 1.03;
  given.parameters.D *= 0.98;
  given.parameters.b *= 0.8;
  given.parameters.c *= 1.02;
  given.parameters.c_E *= 1.4;
  const auto fitted_in = [&](const UnitSystem& units) {
    std::vector<diagnose::RunData> runs = OneOfEach(truth, 0.5, 1);
    for (diagnose::RunData& run : runs) ConvertTo(units, &run);
    return FitRuns(WithFree(InUnits(given, units), free), runs);
  };
  const diagnose::Fitted paper = fitted_in(kSystems[0]);
  ASSERT_TRUE(paper.ok()) << paper.failure;
  for (const UnitSystem& units : kSystems) {
    const diagnose::Fitted other = fitted_in(units);
    ASSERT_TRUE(other.ok()) << other.failure;
    EXPECT_NEAR(other.squared_gap() / paper.squared_gap(), 1, 1e-4) << units.length;
    for (const std::string& name : free) {
      const model::ParameterInfo& info = model::BaseParameters()[model::BasePlace(name)].info;
      const double factor = Factor(info.unit, info.arm, {}, units);
      EXPECT_NEAR(ValueOf(other, name) / (factor * ValueOf(paper, name)), 1, 2e-3)
          << name << ", " << units.length;
    }
  }
}

// Tests that a start that has gone where the run says nothing, below p_3, comes back: what was measured holds
// it.
TEST(Fit, ComesBackFromBelowTheFloor) {
  std::vector<diagnose::RunData> runs;
  runs.push_back(SmallRun(Table1With(), model::Shaft::kClamped, false, 0.6, 2, 1));
  diagnose::Hypothesis hypothesis;
  hypothesis.model = Table1With();
  model::StartState below = runs[0].start;
  below[model::kP1] = -1000;
  const diagnose::FitOptions options;
  EXPECT_LT(Fit(hypothesis, PointersTo(runs), {below}, options).squared_gap(), 1.15);
  runs[0].start_error = diagnose::kUnknownStart;
  EXPECT_LT(Fit(hypothesis, PointersTo(runs), {below}, options).runs[0].start[model::kP1], -900);
}

// Tests that effects' parameters are found from the points where fits start.
TEST(Fit, RecoversEffectParameters) {
  const std::vector<diagnose::RunData> runs =
      ClampedPair(Table1With({{"pump.quadratic_drag", {{"k", 2e-4}}, {}},
                              {"valve.relief", {{"set", 1500}, {"conductance", 3e-3}}, {}}}),
                  0.8, 1);
  const diagnose::Fitted fitted =
      FitRuns(WithFree(Table1With({{"pump.quadratic_drag", {{"k", 0}}, {}},
                                   {"valve.relief", {{"set", 1300}, {"conductance", 1e-3}}, {}}}),
                       {}),
              runs);
  ASSERT_TRUE(fitted.ok()) << fitted.failure;
  EXPECT_NEAR(ValueOf(fitted, "pump.quadratic_drag.k"), 2e-4, 0.03 * 2e-4);
  EXPECT_NEAR(ValueOf(fitted, "valve.relief.set"), 1500, 15);
  EXPECT_NEAR(ValueOf(fitted, "valve.relief.conductance"), 3e-3, 0.05 * 3e-3);
  EXPECT_NEAR(fitted.squared_gap(), 1, 0.1);
}

// Tests that prior knowledge decides where it outweighs the runs, and does nothing without weight.
TEST(Fit, WeighsWhatIsKnownBeforehand) {
  const std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 0.5, 1);
  diagnose::Hypothesis hypothesis = WithFree(Table1With(), {"k_1", "b"});
  diagnose::FitOptions options;
  options.tolerance = 1e-6;
  const diagnose::Fitted without = diagnose::Fit(hypothesis, PointersTo(runs), StartsOf(runs), options);
  model::ModelDescription known = Table1With();
  known.parameters.k_1 = 4.4;
  hypothesis.known = std::make_shared<diagnose::Knowledge>(diagnose::Knowledge{known, 0});
  EXPECT_NEAR(ValueOf(Fit(hypothesis, PointersTo(runs), StartsOf(runs), options), "k_1"),
              ValueOf(without, "k_1"), 1e-4);
  hypothesis.known = std::make_shared<diagnose::Knowledge>(diagnose::Knowledge{known, 1e15});
  EXPECT_NEAR(ValueOf(Fit(hypothesis, PointersTo(runs), StartsOf(runs), options), "k_1"), 4.4, 1e-3);
}

// Tests that the start of a run that begins in motion is found.
TEST(Fit, RecoversStarts) {
  const model::ModelDescription truth = Table1With();
  diagnose::RunData whole = SmallRun(truth, model::Shaft::kClamped, false, 0.6, 0, 1);
  constexpr size_t kFirst = 130;
  const model::Response exact = model::Respond(truth, whole.stimulus, {0, 0, 100, 100, 0.3, 0}, {}, {});
  runs::MeasuredRun rest = whole.measured;
  for (std::vector<double>* values : {&rest.time, &rest.voltage.values, &rest.motor_speed.values,
                                      &rest.motor_angle.values, &rest.p1.values, &rest.p2.values}) {
    values->erase(values->begin(), values->begin() + kFirst);
  }
  std::vector<diagnose::RunData> runs;
  runs.push_back(diagnose::PrepareRun(rest, truth.parameters));
  const diagnose::Fitted fitted = FitRuns(WithFree(truth, {}), runs);
  ASSERT_TRUE(fitted.ok()) << fitted.failure;
  const model::StartState& start = fitted.runs[0].start;
  EXPECT_NEAR(start[model::kMotorAngle], exact.values[0][kFirst], 1e-3);
  EXPECT_NEAR(start[model::kMotorSpeed], exact.values[1][kFirst], 1);
  EXPECT_NEAR(start[model::kP1], exact.values[4][kFirst], 5);
  EXPECT_NEAR(start[model::kP2], exact.values[5][kFirst], 5);
  EXPECT_LT(std::abs(fitted.squared_gap() - 1), 0.1);
}

// Tests that an effect whose best fit lies below its smallest physical value ends at that value.
TEST(Fit, KeepsToBounds) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b = 0.008;
  const std::vector<diagnose::RunData> runs = ClampedPair(truth, 0.5, 1);
  const diagnose::Fitted fitted =
      FitRuns(WithFree(Table1With({{"pump.quadratic_drag", {{"k", 1e-4}}, {}}}), {}), runs);
  ASSERT_TRUE(fitted.ok()) << fitted.failure;
  EXPECT_EQ(ValueOf(fitted, "pump.quadratic_drag.k"), 0);
}

// Tests that a parameter that must be above 0 is fitted by its logarithm, even from far away.
TEST(Fit, PositiveParametersAreLogarithms) {
  model::ModelDescription wrong = Table1With();
  wrong.parameters.beta = 0.6 * 247000;
  const diagnose::Hypothesis hypothesis = WithFree(wrong, {"beta", "b"});
  EXPECT_TRUE(hypothesis.Free()[0].logarithmic);
  EXPECT_FALSE(hypothesis.Free()[1].logarithmic);  // may be 0
  const diagnose::Fitted fitted = FitRuns(hypothesis, ClampedPair(Table1With(), 0.5, 1));
  ASSERT_TRUE(fitted.ok()) << fitted.failure;
  EXPECT_NEAR(ValueOf(fitted, "beta"), 247000, 0.02 * 247000);
}

// Tests that a model which cannot be simulated is reported, not thrown.
TEST(Fit, FailuresAreTold) {
  model::ModelDescription stiff = Table1With();
  stiff.parameters.beta = 1e16;
  diagnose::Fitted fitted;
  const std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 0.2, 1);
  EXPECT_NO_THROW(fitted = FitRuns(WithFree(stiff, {"b"}), runs));
  EXPECT_FALSE(fitted.ok());
  EXPECT_NE(fitted.failure, "");
  EXPECT_NO_THROW(fitted = FitRuns(WithFree(stiff, {}), runs));
  EXPECT_FALSE(fitted.ok());
}

size_t DifferentBits(const std::vector<double>& a, const std::vector<double>& b) {
  size_t different = a.size() != b.size();
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    different += std::bit_cast<uint64_t>(a[i]) != std::bit_cast<uint64_t>(b[i]);
  }
  return different;
}

std::vector<double> AllNumbers(const diagnose::Fitted& fitted) {
  std::vector<double> numbers = {fitted.sum};
  for (const diagnose::FreeParameter& parameter : fitted.hypothesis.Free())
    numbers.push_back(parameter.value);
  for (const diagnose::RunFit& run : fitted.runs) {
    numbers.push_back(run.sum);
    numbers.insert(numbers.end(), run.start.begin(), run.start.end());
    numbers.insert(numbers.end(), run.information.begin(), run.information.end());
    numbers.insert(numbers.end(), run.gradient.begin(), run.gradient.end());
  }
  return numbers;
}

// Tests that a fit is the same to the bit when repeated, and for any number of threads.
TEST(Fit, SameBitsEveryTime) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b = 0.018;
  truth.parameters.J = 0.026;
  const std::vector<diagnose::RunData> runs = OneOfEach(truth, 0.2, 1);
  const diagnose::Hypothesis hypothesis =
      WithFree(Table1With({{"pump.quadratic_drag", {{"k", 0}}, {}}}), {"J", "b", "T_s", "beta"});
  const std::vector<double> once = AllNumbers(FitRuns(hypothesis, runs));
  ASSERT_GT(once.size(), 5);
  EXPECT_EQ(DifferentBits(AllNumbers(FitRuns(hypothesis, runs)), once), 0);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(DifferentBits(AllNumbers(FitRuns(hypothesis, runs, 2)), once), 0) << "2 threads";
    EXPECT_EQ(DifferentBits(AllNumbers(FitRuns(hypothesis, runs, 4)), once), 0) << "4 threads";
  }
}

// Small memory blocks, freed in an order of their own: what is allocated next lies in another order.
void ShuffleFreeMemory(int round) {
  std::vector<std::unique_ptr<double[]>> blocks;
  for (int i = 0; i < 400; ++i) blocks.push_back(std::make_unique<double[]>(1 + i % 8));
  for (size_t i = 0; i < blocks.size(); ++i) blocks[(i * (7 + 2 * round)) % blocks.size()].reset();
}

// Tests that a fit of many windows does not depend on where its numbers lie in memory.
TEST(Fit, SameBitsWhereverItsNumbersLie) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b = 0.018;
  std::vector<diagnose::RunData> windows;
  for (const diagnose::RunData& run : OneOfEach(truth, 0.6, 1)) {
    for (diagnose::RunData& window : diagnose::WindowsOf(run, 0.1, truth.parameters)) {
      windows.push_back(std::move(window));
    }
  }
  ASSERT_GT(windows.size(), 12);
  const diagnose::Hypothesis hypothesis = WithFree(Table1With(), {"J", "b", "T_s", "beta"});
  const std::vector<double> once = AllNumbers(FitRuns(hypothesis, windows));
  for (int round = 0; round < 2; ++round) {
    ShuffleFreeMemory(round);
    EXPECT_EQ(DifferentBits(AllNumbers(FitRuns(hypothesis, windows)), once), 0) << round;
  }
}

}  // namespace
}  // namespace hydro::testing
