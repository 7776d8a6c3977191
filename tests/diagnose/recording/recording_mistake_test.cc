#include "diagnose/recording/recording_mistake.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "diagnose/recording/other_side.h"
#include "diagnose/recording/sidecar_lines.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;

runs::MeasuredRun BenchRun() {
  runs::MeasuredRun run;
  run.shaft = model::Shaft::kClamped;
  run.time = {0, 1, 2};
  run.time_source = {"t"};
  run.voltage = {{1, 2, 3}, {}, {"V"}};
  run.p1 = {{10, 20, 30}, 0.5, {"P1"}};
  run.p2 = {{40, 50, 60}, 0.7, {"P2", 2, 3}};
  return run;
}

RecordingMistake Mistake(const std::string& what) {
  const std::vector<RecordingMistake> all = PossibleMistakes(BenchRun());
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.what == what; });
  EXPECT_NE(found, all.end()) << what;
  return found == all.end() ? RecordingMistake() : *found;
}

// Tests that only mistakes in what is measured are possible, and exchanged pressures not with the bypass
// open.
TEST(RecordingMistake, OfWhatIsMeasured) {
  for (const RecordingMistake& mistake : PossibleMistakes(BenchRun())) {
    EXPECT_EQ(mistake.what.find("motor"), std::string::npos) << mistake.what;
    EXPECT_EQ(mistake.what.find("arm"), std::string::npos) << mistake.what;
  }
  runs::MeasuredRun bypass = BenchRun();
  bypass.bypass = true;
  for (const RecordingMistake& mistake : PossibleMistakes(bypass)) EXPECT_FALSE(mistake.pressures_exchanged);
  Mistake("p1 and p2 are exchanged");
}

// Tests that an arm that was recorded moving was not clamped, whatever else may explain the run; its noise
// and an arm that nobody recorded rule out nothing.
TEST(RecordingMistake, AMovingArmIsNotHeld) {
  model::Parameters model;
  model.c = 0.002;
  model.V_ms = 2.5e-4;
  runs::MeasuredRun run = BenchRun();
  run.shaft = model::Shaft::kFree;
  const auto clamped = [&] {
    const std::vector<RecordingMistake> others = OtherShafts(run, model);
    return std::ranges::count_if(
        others, [](const RecordingMistake& mistake) { return mistake.shaft == model::Shaft::kClamped; });
  };
  EXPECT_EQ(clamped(), 1);
  run.arm_angle.values = {0, 0.025, -0.025};
  EXPECT_EQ(clamped(), 0);
  run.arm_angle.values = {0, 1e-5, -1e-5};
  EXPECT_EQ(clamped(), 1);
}

std::vector<std::string> Offered(const runs::MeasuredRun& run) {
  std::vector<std::string> what;
  for (const RecordingMistake& mistake : PossibleMistakes(run)) what.push_back(mistake.what);
  return what;
}

// Tests that nothing is offered which makes a run of some ms of one of some s, or readings that no machine
// has; unless what the sidecar says is as impossible.
TEST(RecordingMistake, NothingImpossibleIsOffered) {
  using ::testing::Contains;
  using ::testing::Not;
  runs::MeasuredRun run;
  for (int k = 0; k <= 1200; ++k) {
    run.time.push_back(0.005 * k);
    run.p1.values.push_back(k);
    run.p2.values.push_back(2 * k);  // psi
    run.motor_speed.values.push_back(0.1 * k);
  }
  for (const char* unit : {"ms", "us", "ns"})
    EXPECT_THAT(Offered(run), Not(Contains("time is in " + std::string(unit))));
  EXPECT_THAT(Offered(run), Contains("p1 and p2 are in kPa"));
  EXPECT_THAT(Offered(run), Not(Contains("p1 and p2 are in MPa")));
  EXPECT_THAT(Offered(run), Contains("motor_speed is in rpm"));
  for (double& time : run.time) time *= 1e6;  // 5000 s a row
  EXPECT_THAT(Offered(run), Contains("time is in us"));
  for (double& pressure : run.p1.values) pressure *= 1e6;
  EXPECT_THAT(Offered(run), Contains("p1 and p2 are in Pa"));
}

// Tests that values, noise, and the sidecar's scale and offset are corrected together.
TEST(RecordingMistake, Correct) {
  runs::MeasuredRun run = BenchRun();
  Correct(Mistake("p1 and p2 are in bar"), &run);
  EXPECT_NEAR(run.p1.values[1], 290.075, 1e-3);
  EXPECT_NEAR(*run.p1.noise, 7.2519, 1e-4);
  EXPECT_NEAR(run.p2.source.scale, 29.0075, 1e-4);
  EXPECT_NEAR(run.p2.source.offset, 43.5113, 1e-4);
  run = BenchRun();
  Correct(Mistake("p1 and p2 are exchanged"), &run);
  Correct(Mistake("voltage has the wrong sign"), &run);
  EXPECT_THAT(run.p1.values, ElementsAre(40, 50, 60));
  EXPECT_THAT(run.voltage.values, ElementsAre(-1, -2, -3));
  run = BenchRun();
  Correct(Mistake("time is in ms"), &run);
  EXPECT_THAT(run.time, ElementsAre(0, 0.001, 0.002));
}

// Tests the lines that mend a sidecar: a unit where nothing else is said of the column, else scale and
// offset.
TEST(RecordingMistake, SidecarLines) {
  const runs::MeasuredRun run = BenchRun();
  EXPECT_EQ(SidecarLines({Mistake("time is in ms")}, run), "time = { column = \"t\", unit = \"ms\" }");
  EXPECT_EQ(SidecarLines({Mistake("voltage has the wrong sign")}, run),
            "voltage = { column = \"V\", scale = -1 }");
  EXPECT_EQ(SidecarLines({Mistake("p1 and p2 are in bar")}, run),
            "p1 = { column = \"P1\", unit = \"bar\" }; "
            "p2 = { column = \"P2\", scale = 2, offset = 3, unit = \"bar\" }");
  EXPECT_EQ(SidecarLines({Mistake("p1 and p2 are exchanged")}, run),
            "p1 = { column = \"P2\", scale = 2, offset = 3 }; p2 = { column = \"P1\" }");
}

// Tests that the columns of a log without a sidecar are named as its export has them, with the unit of the
// model.
TEST(RecordingMistake, ColumnsOfALog) {
  runs::MeasuredRun run = BenchRun();
  run.p1.source.column = run.p2.source.column = "";
  EXPECT_THAT(SidecarLines({Mistake("p1 and p2 are exchanged")}, run),
              ::testing::StartsWith("p1 = { column = \"p2_psi\""));
  run.units = kSiUnits;
  EXPECT_THAT(SidecarLines({Mistake("p1 and p2 are exchanged")}, run),
              ::testing::StartsWith("p1 = { column = \"p2_Pa\""));
}

// Tests that a unit that is stated wrongly is one of the mistakes, with the known units only; beside a sign,
// too.
TEST(RecordingMistake, StatedUnit) {
  runs::MeasuredRun run = BenchRun();
  run.p1.source.scale = run.p2.source.scale = 14.5037738;
  const std::vector<RecordingMistake> all = PossibleMistakes(run);
  std::vector<std::string> pressures;
  for (const RecordingMistake& mistake : all) {
    if (mistake.factors.size() == 2) pressures.push_back(mistake.what);
  }
  // In mbar or Pa they would be next to nothing.
  EXPECT_THAT(pressures, ElementsAre("p1 and p2 are in kPa, not in bar", "p1 and p2 are in MPa, not in bar",
                                     "p1 and p2 are in psi, not in bar"));
  const auto psi = std::find_if(
      all.begin(), all.end(), [](const auto& one) { return one.what == "p1 and p2 are in psi, not in bar"; });
  ASSERT_NE(psi, all.end());
  EXPECT_NEAR(psi->factors[0].second, 1 / 14.5037738, 1e-8);
  run = BenchRun();
  run.motor_speed = {{1, 2, 3}, {}, {"N"}};
  std::vector<RecordingMistake> both;
  for (const RecordingMistake& mistake : PossibleMistakes(run)) {
    if (mistake.what == "motor_speed is in rpm" || mistake.what == "motor_speed has the wrong sign") {
      both.push_back(mistake);
    }
  }
  EXPECT_EQ(SidecarLines(both, run), "motor_speed = { column = \"N\", scale = -1, unit = \"rpm\" }");
}

// Tests that every set of mistakes has a twin: the recording seen from the other side.
TEST(RecordingMistake, SeenFromTheOtherSide) {
  runs::MeasuredRun run = BenchRun();
  run.motor_speed = {{1, 2, 3}, {}, {"N"}};
  const auto twin = [&run](const std::vector<std::string>& what) {
    std::vector<RecordingMistake> mistakes;
    for (const RecordingMistake& one : PossibleMistakes(run)) {
      if (std::find(what.begin(), what.end(), one.what) != what.end()) mistakes.push_back(one);
    }
    std::vector<std::string> other;
    const auto seen = SeenFromTheOtherSide(mistakes, run);
    if (!seen.has_value()) return other;
    for (const RecordingMistake& one : *seen) other.push_back(one.what);
    return other;
  };
  EXPECT_THAT(twin({"voltage has the wrong sign", "p1 and p2 are exchanged", "motor_speed is in rpm"}),
              ElementsAre("motor_speed has the wrong sign", "motor_speed is in rpm"));
  EXPECT_THAT(twin({"motor_speed has the wrong sign"}),
              ElementsAre("voltage has the wrong sign", "p1 and p2 are exchanged"));
  run.p2 = {};
  EXPECT_FALSE(SeenFromTheOtherSide({}, run).has_value()) << "no sidecar can exchange one pressure";
}

// Tests which mistakes the effect sensor.sign can stand for: one sensor, never the command.
TEST(RecordingMistake, InvertedSensor) {
  runs::MeasuredRun run = BenchRun();
  run.motor_speed.values = {1, 2, 3};
  std::vector<std::string> inverted;
  for (const RecordingMistake& mistake : PossibleMistakes(run)) {
    if (!mistake.InvertedSensor().empty()) inverted.push_back(mistake.InvertedSensor());
  }
  EXPECT_THAT(inverted, ElementsAre("motor_speed", "p1", "p2"));
}

}  // namespace
}  // namespace hydro::diagnose
