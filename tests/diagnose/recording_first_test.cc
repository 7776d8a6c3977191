#include "diagnose/recording_first.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "diagnose/recording/recording_remarks.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// One clamped run of Table 1, its values multiplied by these factors.
std::vector<runs::MeasuredRun> Bench(double voltage, double speed) {
  testing::NoisyRig rig;
  rig.model = {"Table 1", testing::Table1(), {}};
  rig.encoder_bits = 14;
  const RunData data = rig.Record("bench", model::Shaft::kClamped, 0.1, 2, false,
                                  [](double t) { return std::fmod(t, 0.4) < 0.2 ? 5.0 : -4.0; });
  std::vector<runs::MeasuredRun> runs = {data.measured};
  runs[0].motor_angle = {};
  for (double& value : runs[0].voltage.values) value *= voltage;
  for (double& value : runs[0].motor_speed.values) value *= speed;
  return runs;
}

// A run with the bypass open, whose speed is multiplied by this factor, and whose angle is not.
runs::MeasuredRun SpeedAndAngle(double factor) {
  testing::NoisyRig rig;
  rig.model = {"Table 1", testing::Table1(), {}};
  runs::MeasuredRun run = rig.Record("bench", model::Shaft::kClamped, 0.1, 4, true,
                                     [](double t) { return std::fmod(t, 0.7) < 0.4 ? 3.0 : -4.0; })
                              .measured;
  for (double& value : run.motor_speed.values) value *= factor;
  return run;
}

const model::ModelDescription kGiven = {"Table 1", testing::Table1(), {}};

// Tests that a sound recording passes, and that limits are no faults.
TEST(RecordingFirst, Sound) {
  std::vector<runs::MeasuredRun> runs = Bench(1, 1), none;
  const CheckedRecordings checked = CheckFirst(kGiven, {}, 1, &runs, &none);
  EXPECT_THAT(checked.mistakes, IsEmpty());
  EXPECT_THAT(checked.damage, IsEmpty());
  EXPECT_FALSE(checked.mend_first);
  runs[0].p1 = runs[0].p2 = {};
  const RecordingReport report = ReportOnRecordings(kGiven, runs, 1);
  EXPECT_THAT(report.wrong, IsEmpty());
  EXPECT_THAT(report.limits, ::testing::ElementsAre(HasSubstr("no pressure was recorded")));
}

// Tests that a command in the wrong row stands first where a gap is left, and only there.
TEST(RecordingFirst, ALateCommandComesFirst) {
  CheckedRecordings checked;
  checked.commands.late = {"the voltage is late by 3 rows"};
  Diagnosis open, closed;
  open.verdict = Verdict::kPartly;
  closed.verdict = Verdict::kNamed;
  open.sentence = closed.sentence = "Something is missing.";
  AddChecked(checked, &open);
  AddChecked(checked, &closed);
  EXPECT_EQ(open.sentence, "Mend the recording first: the voltage is late by 3 rows. Something is missing.");
  EXPECT_EQ(open.verdict, Verdict::kPartly);
  EXPECT_EQ(closed.sentence, "Something is missing.");
  EXPECT_THAT(closed.remarks, ::testing::ElementsAre("the voltage is late by 3 rows"));
}

// Tests that a run that cannot be judged is said to be that, and why.
TEST(RecordingFirst, CannotBeJudged) {
  EXPECT_THAT(ReportOnRecordings(kGiven, Bench(1, 1), 1).unjudged, IsEmpty());
  const auto unjudged = [](const std::function<void(runs::MeasuredRun&)>& change) {
    std::vector<runs::MeasuredRun> runs = Bench(1, 1);
    change(runs[0]);
    const RecordingReport report = ReportOnRecordings(kGiven, runs, 1);
    EXPECT_THAT(report.wrong, IsEmpty());
    return report.unjudged;
  };
  const std::string not_checked = "run bench: signs, units and columns could not be checked, because ";
  EXPECT_THAT(unjudged([](runs::MeasuredRun& run) { run.p1 = run.p2 = {}; }),
              ::testing::ElementsAre(StartsWith(not_checked + "p1 and p2 were not recorded")));
  EXPECT_THAT(unjudged([](runs::MeasuredRun& run) { run.p1 = {}; }),
              ::testing::ElementsAre(not_checked + "p1 was not recorded"));
  EXPECT_THAT(unjudged([](runs::MeasuredRun& run) { run.motor_speed = {}; }),
              ::testing::ElementsAre(not_checked + "neither motor_speed nor motor_angle was recorded"));
  std::vector<runs::MeasuredRun> bare = {SpeedAndAngle(1)};
  bare[0].motor_angle = bare[0].p1 = bare[0].p2 = {};
  EXPECT_THAT(ReportOnRecordings(kGiven, bare, 1).unjudged, IsEmpty()) << "a motor alone";
}

// Tests that a missing pressure of one side is not passed over in silence.
TEST(RecordingFirst, OneSideIsMissing) {
  std::vector<runs::MeasuredRun> runs = Bench(1, 1);
  runs[0].p2 = {};
  EXPECT_THAT(
      ReportOnRecordings(kGiven, runs, 1).limits,
      ::testing::Contains(HasSubstr("run bench: p2 was not recorded: what leaks or opens on side 2")));
}

// Tests that a command in percent of a +/-10 V amplifier is said, and one that the amplifier limits is not.
TEST(RecordingFirst, CommandInPercent) {
  std::vector<runs::MeasuredRun> runs = Bench(10, 1);
  EXPECT_THAT(ReportOnRecordings(kGiven, runs, 1).limits,
              ::testing::Contains(HasSubstr("run bench: voltage reaches 50 V, 5 times what saturates the "
                                            "amplifier, T_pmax/k_1 = 10 V: is it in percent or counts")));
  EXPECT_THAT(ReportOnRecordings(kGiven, Bench(6, 1), 1).limits, IsEmpty());
}

// Tests that the time limit holds for the check, too: what it cuts off is not found.
TEST(RecordingFirst, TimeIsUp) {
  std::vector<runs::MeasuredRun> runs = Bench(-1, 1), none;
  EXPECT_THAT(CheckFirst(kGiven, {}, 1, &runs, &none, [] { return true; }).mistakes, IsEmpty());
}

// Tests that the load of an arm is said of the joints that it loads, also where the recording is to be mended
// first.
TEST(RecordingFirst, JointsOfAnArm) {
  const std::string said = "the load is that of the limb's [arm], in the place of J_a and mgl";
  std::vector<runs::MeasuredRun> runs = Bench(1, 1), none;
  runs[0].in_an_arm = true;
  EXPECT_EQ(LoadRemark(runs), "") << "clamped, it has no load";
  runs[0].shaft = model::Shaft::kFree;
  EXPECT_THAT(LoadRemark(runs), StartsWith("run bench: " + said));
  EXPECT_THAT(ReportOnRecordings(kGiven, runs, 1).limits, ::testing::Contains(HasSubstr(said)));
  CheckedRecordings checked = CheckFirst(kGiven, {}, 1, &runs, &none);
  checked.mistakes = {"what is to be mended"};
  EXPECT_THAT(MendFirst(kGiven, checked, runs, none).remarks, ::testing::Contains(HasSubstr(said)));
  Diagnosis diagnosis;
  AddChecked(checked, &diagnosis);
  EXPECT_THAT(diagnosis.remarks, ::testing::Contains(HasSubstr(said)));
}

// Tests that a speed that contradicts its angle is said, and corrected in what is searched, in the fitted and
// the held-out runs alike.
TEST(RecordingFirst, SpeedThatContradictsItsAngle) {
  std::vector<runs::MeasuredRun> runs = {SpeedAndAngle(1.14)}, held_out = {SpeedAndAngle(1.14)};
  const RecordingReport report = ReportOnRecordings(kGiven, runs, 1);
  EXPECT_THAT(report.wrong,
              ::testing::Contains(HasSubstr("the angle is believed, and the speed is corrected")));
  const CheckedRecordings checked = CheckFirst(kGiven, {}, 1, &runs, &held_out);
  EXPECT_FALSE(checked.mend_first);
  ASSERT_EQ(checked.sensors.size(), 1u);
  EXPECT_THAT(checked.sensors[0], StartsWith("every run: motor_speed is 1.1"));
  for (const runs::MeasuredRun* run : std::vector<const runs::MeasuredRun*>{
           &runs[0], &held_out[0], &checked.aligned[0].run, &checked.aligned[1].run}) {
    const double recorded = SpeedAndAngle(1.14).motor_speed.values[100];
    EXPECT_NEAR(run->motor_speed.values[100], recorded / 1.14, 0.02 * std::abs(recorded));
  }
  std::vector<runs::MeasuredRun> sound = {SpeedAndAngle(1)}, none;
  EXPECT_THAT(CheckFirst(kGiven, {}, 1, &sound, &none).sensors, IsEmpty());
  EXPECT_TRUE(sound[0].motor_speed.measured());
}

// Tests that a wrong sign of the command ends the diagnosis before the search, and what it then says.
TEST(RecordingFirst, MendFirst) {
  std::vector<runs::MeasuredRun> runs = Bench(-1, 1), none;
  const CheckedRecordings checked = CheckFirst(kGiven, {}, 1, &runs, &none);
  ASSERT_TRUE(checked.mend_first);
  const Diagnosis diagnosis = MendFirst(kGiven, checked, runs, none);
  EXPECT_EQ(diagnosis.verdict, Verdict::kUnexplained);
  EXPECT_THAT(diagnosis.sentence,
              StartsWith("Mend the recording first: run bench: voltage has the wrong sign"));
  EXPECT_THAT(diagnosis.effects, IsEmpty());
  EXPECT_TRUE(std::isnan(diagnosis.held_out.after));
  EXPECT_EQ(diagnosis.runs, std::vector<std::string>{"bench"});
  EXPECT_EQ(diagnosis.samples, runs[0].samples());
  EXPECT_THAT(ReportOnRecordings(kGiven, runs, 1).wrong, ::testing::ElementsAre(HasSubstr("wrong sign")));
}

// Tests that a factor that is no known unit's is said, and ends no search: an effect may look like one.
TEST(RecordingFirst, UnknownFactor) {
  std::vector<runs::MeasuredRun> runs = Bench(1, 1), none;
  for (auto signal : {&runs::MeasuredRun::p1, &runs::MeasuredRun::p2}) {
    for (double& value : (runs[0].*signal).values) value *= 2.5;
  }
  const CheckedRecordings checked = CheckFirst(kGiven, {}, 1, &runs, &none);
  EXPECT_THAT(checked.factors, ::testing::ElementsAre(HasSubstr("times too large; no known unit")));
  EXPECT_THAT(checked.mistakes, IsEmpty());
  EXPECT_FALSE(checked.mend_first);
  EXPECT_EQ(ReportOnRecordings(kGiven, runs, 1).wrong, checked.factors);
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::kNamed;
  AddChecked(checked, &diagnosis);
  EXPECT_EQ(diagnosis.verdict, Verdict::kNamed);
  EXPECT_EQ(diagnosis.remarks, checked.factors);
}

// Tests that an inverted sensor is left to the search where sensor.sign may be named, and that nothing else
// then stays named.
TEST(RecordingFirst, InvertedSensor) {
  std::vector<runs::MeasuredRun> runs = Bench(1, -1), none;
  EXPECT_TRUE(CheckFirst(kGiven, {"pump.stribeck"}, 1, &runs, &none).mend_first);
  const CheckedRecordings checked = CheckFirst(kGiven, {}, 1, &runs, &none);
  ASSERT_EQ(checked.mistakes.size(), 1u);
  EXPECT_FALSE(checked.mend_first);
  for (const char* effect : {"sensor.sign", "pump.stribeck"}) {
    Diagnosis diagnosis;
    diagnosis.verdict = Verdict::kNamed;
    diagnosis.sentence = "Found.";
    diagnosis.effects.resize(1);
    diagnosis.effects[0].id = effect;
    AddChecked(checked, &diagnosis);
    const bool sign = std::string(effect) == "sensor.sign";
    EXPECT_EQ(diagnosis.verdict, sign ? Verdict::kNamed : Verdict::kUnexplained);
    EXPECT_THAT(diagnosis.sentence, StartsWith("Mend the recording first: run bench: motor_speed"));
    EXPECT_EQ(diagnosis.remarks, checked.mistakes);
  }
}

}  // namespace
}  // namespace hydro::diagnose
