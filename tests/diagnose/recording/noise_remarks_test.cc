#include "diagnose/recording/noise_remarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

SignalData Signal(model::Channel channel, double stated, double shown) {
  SignalData signal;
  signal.channel = channel;
  signal.noise = signal.stated_noise = stated;
  signal.estimated_noise = shown;
  return signal;
}

RunData RunWith(const std::string& name, std::vector<SignalData> signals) {
  RunData run;
  run.name = name;
  run.measured.time_source.column = "t";  // a table's, with a sidecar
  run.signals = std::move(signals);
  return run;
}

// Tests that runs which one sidecar states wrongly share a remark: how many times more each column shows, and
// the lines that mend it.
TEST(NoiseRemarks, SayHowManyTimesAndWhatMendsIt) {
  const RunData a =
      RunWith("a", {Signal(model::Channel::kMotorSpeed, 0.3, 0.9), Signal(model::Channel::kP1, 1.5, 4.4)});
  const RunData b =
      RunWith("b", {Signal(model::Channel::kMotorSpeed, 0.3, 0.9), Signal(model::Channel::kP1, 1.5, 4.5)});
  EXPECT_THAT(
      NoiseRemarks({&a, &b}),
      ElementsAre(
          "every run: the samples show more noise than is stated; gaps count in the stated one, and are "
          "closed "
          "where only what the samples show is left: "
          "motor_speed 0.9 rad/s, 3 times the stated 0.3; p1 4.5 psi, 3 times the stated 1.5; this in "
          "the sidecar, under [noise], mends it: motor_speed = 0.9; p1 = 4.5"));
}

// Tests that runs of which other signals are wrong, or that show less than is stated, have remarks of their
// own.
TEST(NoiseRemarks, OtherSignalsAndOtherWays) {
  const RunData both =
      RunWith("both", {Signal(model::Channel::kP1, 1.5, 4.5), Signal(model::Channel::kP2, 1.5, 0.5)});
  const RunData one =
      RunWith("one", {Signal(model::Channel::kP1, 1.5, 6.0), Signal(model::Channel::kP2, 1.5, 1.6)});
  const RunData good =
      RunWith("good", {Signal(model::Channel::kP1, 1.5, 2.9), Signal(model::Channel::kP2, 1.5, 0.8)});
  EXPECT_THAT(
      NoiseRemarks({&both, &good, &one}),
      ElementsAre(AllOf(HasSubstr("runs both and one: "), HasSubstr("p1 6 psi, 4 times the stated 1.5"),
                        Not(HasSubstr("p2"))),
                  AllOf(HasSubstr("run both: "), HasSubstr("p2 0.5 psi, 0.33 times the stated 1.5"))));
}

// Tests what the samples' own noise leaves: of a quarter of the signals that are three times as noisy as is
// stated, the root of (9 + 3) / 4; what is quieter, or within a factor of two, counts as stated.
TEST(NoiseShown, IsARootMeanSquareOfAllSignals) {
  const RunData noisy =
      RunWith("noisy", {Signal(model::Channel::kP1, 1.5, 4.5), Signal(model::Channel::kP2, 1.5, 0.5)});
  const RunData good =
      RunWith("good", {Signal(model::Channel::kP1, 1.5, 2.9), Signal(model::Channel::kP2, NAN, 4)});
  EXPECT_NEAR(NoiseShown({&noisy, &good}), std::sqrt(3.0), 1e-12);
  EXPECT_EQ(NoiseShown({&good}), 1);
}

// Tests that nothing is said where nothing is stated, and of a log, which has no sidecar, no line.
TEST(NoiseRemarks, OnlyOfWhatIsStated) {
  const RunData unstated = RunWith("unstated", {Signal(model::Channel::kP1, NAN, 4.5)});
  EXPECT_THAT(NoiseRemarks({&unstated}), IsEmpty());
  RunData log = RunWith("log", {Signal(model::Channel::kP1, 1.5, 4.5)});
  log.measured.time_source.column.clear();
  EXPECT_THAT(NoiseRemarks({&log}), ElementsAre(Not(HasSubstr("sidecar"))));
}

}  // namespace
}  // namespace hydro::diagnose
