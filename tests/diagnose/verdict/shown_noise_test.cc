#include "diagnose/verdict/shown_noise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnose/fit/held_out.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// What the true model predicts of a run whose pressures' noise of 1.5 psi is stated as this.
std::optional<double> GapWith(double stated) {
  testing::NoisyRig rig;
  rig.model.parameters = testing::Table1();
  const auto steps = [](double t) { return t < 0.5 ? 3.0 : -2.0; };
  runs::MeasuredRun run = rig.Record("steps", model::Shaft::kClamped, 0.1, 1, false, steps).measured;
  run.p1.noise = run.p2.noise = stated;
  const RunData prepared = PrepareRun(std::move(run), testing::Table1());
  Hypothesis truth;
  truth.model = rig.model;
  const Fitted fitted = Fit(truth, {&prepared}, MeasuredStarts({&prepared}), {});
  EXPECT_TRUE(fitted.ok());
  return GapInShownNoise({&prepared}, Predict(fitted, {&prepared}, 1));
}

// Tests that a third of the real noise leaves a gap of one by what the samples show, and that the right noise, or one
// that is too large, has no such gap.
TEST(ShownNoise, IsTheFloorOfNoisierRuns) {
  const std::optional<double> gap = GapWith(0.5);
  ASSERT_TRUE(gap.has_value());
  EXPECT_NEAR(*gap, 1, 0.1);
  EXPECT_FALSE(GapWith(1.5).has_value());
  EXPECT_FALSE(GapWith(4.5).has_value());
}

// Tests that only verdicts which leave a gap are explained by it, and that a gap above the noise is not called noise.
TEST(ShownNoise, IsSaidBesideAnOpenVerdict) {
  EXPECT_THAT(ShownNoiseSentence(Verdict::kUnexplained, 1.02),
              AllOf(HasSubstr("1.02 is left"), HasSubstr("mend the stated noise first")));
  EXPECT_THAT(ShownNoiseSentence(Verdict::kPartly, 1.9),
              AllOf(HasSubstr("1.9 is left"), Not(HasSubstr("mend"))));
  EXPECT_THAT(ShownNoiseSentence(Verdict::kNamed, 1.02), IsEmpty());
  EXPECT_THAT(ShownNoiseSentence(Verdict::kUnexplained, std::nullopt), IsEmpty());
}

}  // namespace
}  // namespace hydro::diagnose
