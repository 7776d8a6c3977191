#include "diagnose/recording/thinned.h"

#include <gmock/gmock.h>

#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;

// A second at 2 kHz; the command steps at a sample that no grid of two has.
RunData Stepped() {
  testing::NoisyRig rig;
  rig.model = {"Table 1", testing::Table1(), {}};
  rig.step = 5e-4;
  return rig.Record("step", model::Shaft::kClamped, 0, 1.0001, false,
                    [](double t) { return t < 0.5001 ? 2.0 : -4.0; });
}

// Tests that every second sample is left, and those where the command jumps, each with its own values.
TEST(Thinned, KeepsEverySecondSampleAndJumps) {
  const RunData run = Stepped();
  EXPECT_NEAR(static_cast<double>(ThinnedCopy(run).samples()), 1000, 2)
      << "fewer are not left of a whole run";
  RunData thin = Stepped();
  Thin(100, &thin);
  EXPECT_NEAR(static_cast<double>(thin.samples()), static_cast<double>(run.samples()) / 2, 2);
  const SignalData& all = *run.Find(model::Channel::kP1);
  const SignalData& some = *thin.Find(model::Channel::kP1);
  EXPECT_EQ(some.valid, thin.samples());
  size_t at = 0, steps = 0;
  for (size_t k = 0; k < thin.samples(); ++k) {
    while (run.stimulus.time[at] < thin.stimulus.time[k]) ++at;
    ASSERT_EQ(run.stimulus.time[at], thin.stimulus.time[k]);
    EXPECT_EQ(some.values[k], all.values[at]);
    EXPECT_EQ(thin.stimulus.voltage[k], run.stimulus.voltage[at]);
    steps += k > 0 && thin.stimulus.voltage[k] != thin.stimulus.voltage[k - 1] ? 1 : 0;
  }
  EXPECT_EQ(steps, 1U);
  EXPECT_NEAR(thin.most_steps_per_sample * static_cast<double>(thin.samples()),
              run.most_steps_per_sample * static_cast<double>(run.samples()), 1e-6)
      << "else a wave in a line is too stiff";
}

// Tests that a command between the samples that are left counts by its mean.
TEST(Thinned, CountsTheCommandByItsMean) {
  RunData run;
  for (int k = 0; k < 8; ++k) {
    run.stimulus.time.push_back(0.0005 * k);
    run.stimulus.voltage.push_back(10 + 0.01 * k);
  }
  run.stimulus.voltage.front() = 0;  // a wide range: what follows is no jump
  Thin(2, &run);
  EXPECT_THAT(run.stimulus.time, ElementsAre(0, 0.0005, 0.0015, 0.0025, 0.0035));
  EXPECT_DOUBLE_EQ(run.stimulus.voltage[1], 10 + 0.01 * 1.5);
}

// Tests that neither slow recordings nor short ones are thinned.
TEST(Thinned, LeavesWhatIsNeeded) {
  RunData run = Stepped();
  const size_t samples = run.samples();
  Thin(samples, &run);
  EXPECT_EQ(run.samples(), samples);
  Thin(10, &run);
  const size_t thin = run.samples();
  Thin(10, &run);
  EXPECT_EQ(run.samples(), thin);
}

}  // namespace
}  // namespace hydro::diagnose
