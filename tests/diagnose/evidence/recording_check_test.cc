#include "diagnose/evidence/recording_check.h"

#include <gmock/gmock.h>

#include "tests/diagnose/noisy_rig.h"
#include "tests/diagnose/recording/swing.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Two runs of a rig that has more friction than the model that is given, and a relief valve besides.
class RecordingCheckTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    testing::NoisyRig rig;
    rig.model = {"rig", testing::Table1(), {{"valve.relief", {{"set", 700.0}, {"conductance", 0.01}}, {}}}};
    rig.model.parameters.b *= 1.2;
    rig.model.parameters.beta *= 0.85;
    recorded_ = new std::vector<runs::MeasuredRun>;
    for (const RunData& run : rig.RecordAll()) {
      recorded_->push_back(run.measured);
      for (auto signal : {&runs::MeasuredRun::voltage, &runs::MeasuredRun::motor_speed,
                          &runs::MeasuredRun::p1, &runs::MeasuredRun::p2}) {
        (recorded_->back().*signal).source.column = "X";
      }
    }
  }
  static void TearDownTestSuite() { delete recorded_; }

  // The remarks when each run is changed like this.
  template <class Change>
  static std::vector<std::string> Remarks(const Change& change) {
    std::vector<runs::MeasuredRun> runs = *recorded_;
    for (runs::MeasuredRun& run : runs) change(run);
    return FindingRemarks(CheckRecordings(given_, runs, 2), runs);
  }
  static void Multiply(std::vector<double>* values, double factor) {
    for (double& value : *values) value *= factor;
  }

  inline static const model::ModelDescription given_ = {"Table 1", testing::Table1(), {}};
  inline static std::vector<runs::MeasuredRun>* recorded_ = nullptr;
};

// Tests that a wrong model and a missing effect are not taken for a mistake.
TEST_F(RecordingCheckTest, NothingInASoundRecording) {
  EXPECT_THAT(Remarks([](runs::MeasuredRun&) {}), IsEmpty());
}

// Tests signs: of the command, and of the motor.
TEST_F(RecordingCheckTest, Signs) {
  const auto voltage = Remarks([](runs::MeasuredRun& run) { Multiply(&run.voltage.values, -1); });
  ASSERT_EQ(voltage.size(), 1u);
  EXPECT_THAT(voltage[0], HasSubstr("every run: voltage has the wrong sign"));
  EXPECT_THAT(voltage[0], HasSubstr("voltage = { column = \"X\", scale = -1 }"));
  const auto speed = Remarks([](runs::MeasuredRun& run) { Multiply(&run.motor_speed.values, -1); });
  // Also of the bypassed run, of which a wrong sign of the voltage would explain as much.
  ASSERT_EQ(speed.size(), 1u);
  EXPECT_THAT(speed[0], HasSubstr("every run: motor_speed has the wrong sign"));
  EXPECT_EQ(speed[0].find("Where the unit is right"), std::string::npos) << "no value has the wrong sign";
}

// Tests exchanged pressures; with the bypass open there is nothing to tell them by.
TEST_F(RecordingCheckTest, ExchangedPressures) {
  const auto remarks = Remarks([](runs::MeasuredRun& run) { std::swap(run.p1, run.p2); });
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("p1 and p2 are exchanged"));
  EXPECT_EQ(remarks[0].find("bypass"), std::string::npos) << remarks[0];
}

// Tests units of pressure, speed and time, two at once, and one run of several.
TEST_F(RecordingCheckTest, Units) {
  const auto bar = Remarks([](runs::MeasuredRun& run) {
    Multiply(&run.p1.values, 1 / 14.5038);
    Multiply(&run.p2.values, 1 / 14.5038);
  });
  ASSERT_GE(bar.size(), 1u);
  EXPECT_THAT(bar[0],
              HasSubstr("p1 = { column = \"X\", unit = \"bar\" }; p2 = { column = \"X\", unit = \"bar\" }"));
  const auto both = Remarks([](runs::MeasuredRun& run) {
    Multiply(&run.motor_speed.values, 9.5493);
    Multiply(&run.voltage.values, -1);
  });
  ASSERT_GE(both.size(), 1u);
  EXPECT_THAT(both[0], HasSubstr("motor_speed = { column = \"X\", unit = \"rpm\" }"));
  EXPECT_THAT(both[0], HasSubstr("voltage = { column = \"X\", scale = -1 }"));
  const auto one = Remarks([](runs::MeasuredRun& run) {
    if (run.name == "chirp") Multiply(&run.motor_speed.values, 9.5493);
  });
  ASSERT_EQ(one.size(), 1u);
  EXPECT_THAT(one[0], HasSubstr("run chirp: motor_speed is in rpm"));
  EXPECT_THAT(one[0], HasSubstr("Where the unit is right, a value of the model is off by as much"));
}

// Tests that a speed that is not the rate of its angle is named with its unit or its sign, and that a sensor
// 20 % too large is none.
TEST_F(RecordingCheckTest, Rates) {
  const auto remarks = [](runs::MeasuredSignal runs::MeasuredRun::*signal, double factor) {
    std::vector<runs::MeasuredRun> runs = {testing::Swing(model::Shaft::kFree)};
    Multiply(&(runs[0].*signal).values, factor);
    return FindingRemarks(CheckRecordings(given_, runs, 1), runs);
  };
  const auto degrees = remarks(&runs::MeasuredRun::arm_speed, 57.2958);
  ASSERT_THAT(degrees, SizeIs(1));
  EXPECT_THAT(degrees[0], HasSubstr("arm_speed is in deg/s"));
  const auto turns = remarks(&runs::MeasuredRun::motor_angle, 1 / 6.283185);
  ASSERT_THAT(turns, SizeIs(1));
  EXPECT_THAT(turns[0], HasSubstr("motor_angle is in rev"));
  const auto turned = remarks(&runs::MeasuredRun::arm_speed, -1);
  ASSERT_THAT(turned, SizeIs(1));
  EXPECT_THAT(turned[0], HasSubstr("arm_speed has the wrong sign"));
  EXPECT_THAT(remarks(&runs::MeasuredRun::arm_speed, 1.2), IsEmpty());
}

// Tests mistakes that come together, of which undoing one alone explains nothing.
TEST_F(RecordingCheckTest, SeveralAtOnce) {
  const auto three = Remarks([](runs::MeasuredRun& run) {
    Multiply(&run.motor_speed.values, 9.5493);
    Multiply(&run.motor_angle.values, -1);
    Multiply(&run.p1.values, 1 / 14.5038);
    Multiply(&run.p2.values, 1 / 14.5038);
  });
  ASSERT_GE(three.size(), 1u);
  EXPECT_THAT(three[0], HasSubstr("motor_speed = { column = \"X\", unit = \"rpm\" }"));
  EXPECT_THAT(three[0], HasSubstr("motor_angle = { column = \"motor_angle_rad\", scale = -1 }"));
  EXPECT_THAT(three[0], HasSubstr("p1 = { column = \"X\", unit = \"bar\" }"));
  const auto exchanged = Remarks([](runs::MeasuredRun& run) {
    std::swap(run.p1, run.p2);
    Multiply(&run.p1.values, 1 / 14.5038);
    Multiply(&run.p2.values, 1 / 14.5038);
  });
  ASSERT_GE(exchanged.size(), 1u);
  EXPECT_THAT(exchanged[0], HasSubstr("p1 and p2 are exchanged and p1 and p2 are in bar"));
}

// Tests that what explains the runs equally well is offered beside it: with the shaft clamped at mid-stroke a
// wrong sign of the command with exchanged pressures looks like a motor that turns the other way. The weight
// of an arm that moves freely decides.
TEST_F(RecordingCheckTest, Ties) {
  std::vector<runs::MeasuredRun> runs = *recorded_;
  testing::NoisyRig rig;
  rig.model = given_;
  const auto steps = [](double t) { return std::fmod(t, 0.4) < 0.2 ? 5.0 : -4.0; };
  runs.push_back(rig.Record("middle", model::Shaft::kClamped, 0, 2, false, steps).measured);
  for (runs::MeasuredRun& run : runs) {
    Multiply(&run.voltage.values, -1);
    std::swap(run.p1, run.p2);
  }
  const auto all = FindingRemarks(CheckRecordings(given_, runs, 1), runs);
  ASSERT_GE(all.size(), 1u);
  EXPECT_THAT(all[0], HasSubstr("voltage has the wrong sign and p1 and p2 are exchanged: this"));
  const std::vector<runs::MeasuredRun> middle = {runs.back()};
  const auto clamped = FindingRemarks(CheckRecordings(given_, middle, 1), middle);
  ASSERT_EQ(clamped.size(), 1u);
  EXPECT_THAT(clamped[0], HasSubstr("motor_speed and motor_angle have the wrong sign: this"));
  EXPECT_THAT(clamped[0],
              HasSubstr("It might also be that voltage has the wrong sign and p1 and p2 are exchanged"));
}

// Tests that a free arm whose weight the model lacks hides no mistake.
TEST_F(RecordingCheckTest, ArmWithoutItsWeight) {
  model::ModelDescription weightless = given_;
  weightless.parameters.mgl = 0;
  std::vector<runs::MeasuredRun> swing;
  for (const runs::MeasuredRun& run : *recorded_) {
    if (run.name == "swing") swing.push_back(run);
  }
  ASSERT_EQ(swing.size(), 1u);
  EXPECT_THAT(CheckRecordings(weightless, swing, 1), IsEmpty());
  Multiply(&swing[0].motor_speed.values, 9.5493);
  const auto remarks = FindingRemarks(CheckRecordings(weightless, swing, 1), swing);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("motor_speed is in rpm"));
}

// Tests that a factor that is no unit's is said as that, once for all runs, and no line is made up for the
// sidecar.
TEST_F(RecordingCheckTest, UnknownFactor) {
  const auto remarks = Remarks([](runs::MeasuredRun& run) {
    Multiply(&run.p1.values, 3.1);
    Multiply(&run.p2.values, 3.1);
  });
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("p1 and p2 are about "));
  EXPECT_THAT(remarks[0], HasSubstr("times too large; no known unit"));
  EXPECT_THAT(remarks[0], ::testing::Not(HasSubstr("mends")));
}

// Tests that a shaft that was held otherwise than the sidecar says is not taken for a unit.
TEST_F(RecordingCheckTest, OtherShaft) {
  std::vector<runs::MeasuredRun> swing;
  for (const runs::MeasuredRun& run : *recorded_) {
    if (run.name == "swing" || run.name == "chirp") swing.push_back(run);
  }
  ASSERT_EQ(swing.size(), 2u);
  swing[1].shaft = model::Shaft::kClamped;
  swing[1].arm_angle = {};
  auto remarks = FindingRemarks(CheckRecordings(given_, swing, 1), swing);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("run swing: the shaft is free, not clamped"));
  EXPECT_THAT(remarks[0], HasSubstr("shaft = \"free\""));
  swing[1].shaft = swing[0].shaft = model::Shaft::kFree;
  remarks = FindingRemarks(CheckRecordings(given_, swing, 1), swing);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("run chirp: the shaft is clamped, not free"));
}

// Tests that pressures in mbar are told from kPa, also with times in us or ns.
TEST_F(RecordingCheckTest, Millibars) {
  for (const auto& [unit, factor] : {std::pair("us", 1e6), std::pair("ns", 1e9)}) {
    const auto remarks = Remarks([factor = factor](runs::MeasuredRun& run) {
      for (auto signal : {&runs::MeasuredRun::p1, &runs::MeasuredRun::p2})
        Multiply(&(run.*signal).values, 68.947573);
      Multiply(&run.time, factor);
    });
    ASSERT_THAT(remarks, SizeIs(1));
    EXPECT_THAT(remarks[0], HasSubstr(std::string("time is in ") + unit + " and p1 and p2 are in mbar"));
  }
}

// Tests that a run which nothing predicts is said to be that: columns exchanged, say.
TEST_F(RecordingCheckTest, NotPredictedAtAll) {
  std::vector<runs::MeasuredRun> runs = *recorded_;
  std::swap(runs[1].p1.values, runs[1].motor_speed.values);
  UnjudgedRuns unjudged;
  const auto findings = CheckRecordings(
      given_, runs, 2, [] { return false; }, &unjudged);
  EXPECT_THAT(findings, IsEmpty());
  EXPECT_THAT(unjudged.unpredicted, ::testing::ElementsAre(1u));
  UnjudgedRuns sound;
  CheckRecordings(
      given_, *recorded_, 2, [] { return false; }, &sound);
  for (const std::vector<size_t>& some : {sound.unpredicted, sound.at_rest, sound.unbalanced})
    EXPECT_THAT(some, IsEmpty());
}

// Tests that runs of which nothing can be said are told by their reasons: at rest, without the signals of any
// balance, too short. With the bypass open the pressures are not needed.
TEST_F(RecordingCheckTest, NothingToJudgeBy) {
  const auto unjudged = [](const auto& change) {
    std::vector<runs::MeasuredRun> runs = {recorded_->front()};
    runs[0].motor_angle = {};
    change(runs[0]);
    UnjudgedRuns found;
    CheckRecordings(
        given_, runs, 1, [] { return false; }, &found);
    return std::vector<size_t>{found.unpredicted.size(), found.at_rest.size(), found.unbalanced.size()};
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(unjudged([](runs::MeasuredRun&) {}), ElementsAre(0u, 0u, 0u));
  EXPECT_THAT(unjudged([](runs::MeasuredRun& run) {
                Multiply(&run.motor_speed.values, 1e-4);
                run.motor_speed.noise = 0.3;
              }),
              ElementsAre(0u, 1u, 0u));
  EXPECT_THAT(unjudged([](runs::MeasuredRun& run) { run.p1 = run.p2 = {}; }), ElementsAre(0u, 0u, 1u));
  EXPECT_THAT(unjudged([](runs::MeasuredRun& run) {
                run.p1 = run.p2 = {};
                run.bypass = true;
              })[2],
              0u);
  EXPECT_THAT(unjudged([](runs::MeasuredRun& run) { Multiply(&run.time, 0.01); }), ElementsAre(0u, 0u, 1u));
}

// Tests that a run at rest says nothing of the mistake that the other runs show.
TEST_F(RecordingCheckTest, ARunAtRestBesideAMistake) {
  std::vector<runs::MeasuredRun> runs = *recorded_;
  for (runs::MeasuredRun& run : runs) Multiply(&run.voltage.values, -1);
  runs.push_back(runs.front());
  runs.back().motor_angle = {};
  runs.back().motor_speed.noise = 0.3;
  Multiply(&runs.back().motor_speed.values, 1e-4);
  UnjudgedRuns unjudged;
  const auto findings = CheckRecordings(
      given_, runs, 2, [] { return false; }, &unjudged);
  EXPECT_THAT(findings, SizeIs(recorded_->size()));
  EXPECT_THAT(unjudged.at_rest, ::testing::ElementsAre(recorded_->size()));
}

// Tests that times in milliseconds are found, and quickly: a simulation over them would hardly end.
TEST_F(RecordingCheckTest, Milliseconds) {
  const auto remarks = Remarks([](runs::MeasuredRun& run) { Multiply(&run.time, 1000); });
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("every run: time is in ms"));
}

}  // namespace
}  // namespace hydro::diagnose
