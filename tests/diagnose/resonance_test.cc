// A fit that ended at the wrong frequency is moved to one that fits better.
#include "diagnose/search/resonance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

constexpr double kFrequency = 196, kFraction = 0.3, kDamping = 0.012;

model::ModelDescription WithLine(double frequency, double fraction, double damping) {
  return Table1With(
      {{"line.wave", {{"frequency", frequency}, {"volume_fraction", fraction}, {"damping", damping}}, {}}});
}

// Tests that a fit which ended at another frequency than the line's is moved to it, and that one which ended
// there stays.
TEST(AtBestResonance, GoesToTheLinesFrequency) {
  const std::vector<diagnose::RunData> runs = ClampedPair(WithLine(kFrequency, kFraction, kDamping), 1.0, 1);
  diagnose::SearchContext context;
  context.given = Table1With();
  context.runs = context.held_out = PointersTo(runs);
  diagnose::FitOptions options;
  options.most_iterations = 15;
  options.tolerance = 1e-5;
  const auto end = [&](const diagnose::Explanation& one) {
    return one.fitted.hypothesis.model.effects[0].parameters.at("frequency");
  };
  const diagnose::Explanation elsewhere =
      diagnose::Explain(context, WithFree(WithLine(250, 0.4, 0.02), {}), StartsOf(runs), options);
  ASSERT_TRUE(elsewhere.fitted.ok());
  ASSERT_GT(std::abs(end(elsewhere) - kFrequency), 5) << "the fit found it by itself";
  const diagnose::Explanation found = diagnose::AtBestResonance(context, elsewhere, options);
  EXPECT_NEAR(end(found), kFrequency, 0.01 * kFrequency);
  EXPECT_LT(found.fitted.sum, elsewhere.fitted.sum);

  const diagnose::Explanation there = diagnose::AtBestResonance(context, found, options);
  EXPECT_NEAR(end(there), end(found), 1e-3 * kFrequency);
  EXPECT_LE(there.fitted.sum, found.fitted.sum);
}

// Tests that nothing is done without a parameter in Hz.
TEST(AtBestResonance, LeavesTheOthersAlone) {
  const model::ModelDescription model = Table1With({{"pump.quadratic_drag", {{"k", 1e-4}}, {}}});
  const std::vector<diagnose::RunData> runs = ClampedPair(model, 0.3, 1);
  diagnose::SearchContext context;
  context.given = Table1With();
  context.runs = context.held_out = PointersTo(runs);
  const diagnose::Explanation one = diagnose::Explain(context, WithFree(model, {}), StartsOf(runs), {});
  EXPECT_EQ(AtBestResonance(context, one, {}).fitted.sum, one.fitted.sum);
}

}  // namespace
}  // namespace hydro::testing
