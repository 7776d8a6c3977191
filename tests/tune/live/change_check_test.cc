#include "tune/live/change_check.h"

#include <algorithm>

#include "pressure_ctrl/law/pressure_law.h"
#include "settings/trajectory_spec.h"
#include "tests/model_in_units.h"
#include "tests/settings/texts.h"
#include "tune/live/tunable_keys.h"

namespace hydro::tuning {
namespace {

using settings::InputErrorOf;
using settings::kConfigText;
using settings::Parsed;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// At 5 kHz: at 1 kHz these gains are unstable where both sides compress.
const std::string kFast = settings::Replaced(kConfigText, "rate_hz = 1000", "rate_hz = 5000");

double ValueOf(const tuned_settings_t& message, const std::string& name) {
  for (size_t i = 0; i < message.names.size(); ++i) {
    if (message.names[i] == name) return message.values[i];
  }
  ADD_FAILURE() << name;
  return 0;
}

PreparedChange Prepared(const std::vector<std::string>& changes, const Situation& situation = {},
                        const std::string& config = kFast) {
  const settings::StackConfig configured = Parsed(config);
  return PrepareChange(configured, configured, changes, situation);
}

TEST(ParseChanges, ReadsLines) {
  EXPECT_THAT(ParseChanges("position.c2=900\n\n pressure.k_p = 0.1 \n"),
              ElementsAre("position.c2=900", " pressure.k_p = 0.1 "));
  EXPECT_THAT(InputErrorOf([] { ParseChanges("position.c2"); }),
              HasSubstr("\"position.c2\": allowed key=value"));
  EXPECT_THAT(InputErrorOf([] { ParseChanges("a.b=1\na.b=2"); }), HasSubstr("a.b: found twice"));
  EXPECT_THAT(InputErrorOf([] { ParseChanges("\n"); }), HasSubstr("found no value"));
  std::string many;
  for (int i = 0; i < 65; ++i) many += "k" + std::to_string(i) + "=1\n";
  EXPECT_THAT(InputErrorOf([&] { ParseChanges(many); }), HasSubstr("more than 64 values"));
}

// Tests that gains follow from natural frequency and damping ratio, and that the message has what differs.
TEST(PrepareChange, DerivesGainsAnew) {
  const PreparedChange change = Prepared({"pressure.natural_frequency_rad_s=120", "position.c2=400"});
  ASSERT_NE(change.config, nullptr) << change.text;
  const auto gains =
      pressure_ctrl::DerivePressureGains(change.config->model.description.parameters, 0, 120, 0.5, 2);
  EXPECT_EQ(ValueOf(change.message, "pressure.k_p"), gains.k_p);
  EXPECT_EQ(ValueOf(change.message, "position.c2"), 400);
  EXPECT_EQ(change.message.changes, "position.c2 = 400\npressure.natural_frequency_rad_s = 120\n");
  EXPECT_THAT(change.text,
              StartsWith("position.c2 = 400, pressure.natural_frequency_rad_s = 120; pressure loop: "));
  EXPECT_EQ(change.message.reference, "");
  EXPECT_FALSE(change.new_reference);
}

// Tests that gains take the place of what they were derived from, and the other way round.
TEST(PrepareChange, OneAlternativeTakesTheOthersPlace) {
  const settings::StackConfig configured = Parsed(kFast);
  const PreparedChange gains =
      PrepareChange(configured, configured, {"pressure.k_p=0.13", "pressure.k_v=8"}, {});
  ASSERT_NE(gains.config, nullptr) << gains.text;
  EXPECT_FALSE(gains.config->pressure.natural_frequency_rad_s);
  const PreparedChange back = PrepareChange(
      configured, *gains.config, {"pressure.natural_frequency_rad_s=140", "pressure.damping_ratio=0.5"}, {});
  ASSERT_NE(back.config, nullptr) << back.text;
  EXPECT_FALSE(back.config->pressure.k_p);
  EXPECT_EQ(back.message.changes, "pressure.natural_frequency_rad_s = 140\n");
  EXPECT_EQ(settings::Changed(configured, ParseChanges(back.message.changes)).text, back.config->text);
}

TEST(PrepareChange, RefusesWithTheReason) {
  const struct {
    std::vector<std::string> changes;
    const char* says;
  } cases[] = {
      {{"position.c3=1"}, "position.c3: no such value, did you mean \"position.c1\"?"},
      {{"plant.rate_hz=2000"}, "plant.rate_hz: cannot be changed while the stack runs"},
      {{"bus.url=udpm://239.1.1.1:7"}, "bus.url: cannot be changed"},
      {{"position.c2=abc"}, "position.c2=abc: position.c2: found \"abc\""},
      {{"position.c2=-1"}, "found -1, allowed"},
      {{"pressure.natural_frequency_rad_s=1"}, "must be above the open loop's"},
      {{"position.c1=10500", "position.c2=5000"}, "would be unstable: "},
      {{"limits.pressure=2500"},
       "limits.pressure: found 2500 psi, allowed up to 2000 psi, which is in force"},
      {{"limits.pressure=inf"}, "allowed up to 2000"},
      {{"noise.p1=1"}, "noise.p1: the rig is a real one"},
      {{"reference.steps=[[0, 2.5]]"}, "reference.steps: found arm angle 2.5 rad"},
      {{"limits.arm_angle=0.05"}, "allowed |alpha| <= 0.05 rad (2.865 deg), which is limits.arm_angle"},
      {{"limits.motor_speed=100", "reference.kind=sine", "reference.amplitude=0.2",
        "reference.frequency_hz=2"},
       "reference: found a speed of 2.513 rad/s, allowed 0.2161 rad/s (limits.motor_speed at the arm)"},
      {{"reference.signal=\"pressure\""}, "reference.signal: cannot be changed while the stack runs"},
      {{"reference.file=other.csv"}, "reference.file: cannot be changed while the stack runs"},
      {{"driver.watchdog_s=1"}, "driver.watchdog_s: cannot be changed while the stack runs"},
      {{"limb.telemetry_hz=5"}, "limb.telemetry_hz: cannot be changed while the stack runs"},
      {{"nonsense=5"}, "nonsense: no such value; hydro-set --list shows what can be changed"},
      {{"reference.amplitud=1"}, "reference.amplitud: no such value, did you mean \"reference.amplitude\"?"},
      {{"plant.nonsense=5"}, "plant.nonsense: no such value; hydro-set --list"},
  };
  for (const auto& c : cases) {
    const PreparedChange change = Prepared(c.changes);
    EXPECT_EQ(change.config, nullptr) << c.changes.front();
    EXPECT_THAT(change.text, HasSubstr(c.says)) << c.changes.front();
    EXPECT_EQ(change.text.find('\n'), std::string::npos);
  }
}

// Tests that gains whose loops cannot be judged are refused with the reason, however small, for each reason
// that there is; that what touches no loop is accepted; and that the way back to the configuration stays
// open.
TEST(PrepareChange, RefusesWhatCannotBeJudged) {
  const struct {
    const char* effect;
    const char* rates;
    const char* says;
  } cases[] = {
      {"[effects.\"amp.delay\"]\ndelay = 0.07\n", "rate_hz = 1000",
       "amp.delay of 0.07 s is more than 60 ticks"},
      {"[effects.\"sensor.skew\"]\nsignal = \"arm_angle\"\ndelay = 0.02\n", "rate_hz = 5000",
       "sensor.skew of 0.02 s is more than 60 ticks"},
  };
  for (const auto& c : cases) {
    const settings::StackConfig configured =
        settings::ParseStackConfig(settings::Replaced(kConfigText, "rate_hz = 1000", c.rates), "stack.toml",
                                   std::string(settings::kModelText) + c.effect, "model.toml");
    for (const std::vector<std::string>& changes :
         {std::vector<std::string>{"position.c1=100000", "position.c2=100000"},
          {"position.c2=1201"},
          {"pressure.damping_ratio=0.6"}}) {
      const PreparedChange change = PrepareChange(configured, configured, changes, {});
      EXPECT_EQ(change.config, nullptr) << changes.front();
      EXPECT_THAT(change.text, StartsWith("the loops cannot be judged: "));
      EXPECT_THAT(change.text, HasSubstr(c.says));
      EXPECT_THAT(change.text, HasSubstr("change these in the configuration, and restart"));
    }
    EXPECT_NE(PrepareChange(configured, configured, {"limits.pressure_psi=1500"}, {}).config, nullptr);
    const settings::StackConfig other = settings::Changed(configured, {"position.c2=300"});
    const auto back = std::make_shared<const settings::StackConfig>(configured);
    EXPECT_NE(PrepareChange(configured, other, back, {}).config, nullptr);
    EXPECT_EQ(PrepareChange(other, other, back, {}).config, nullptr);
  }
}

// Tests that one bad value of several leaves all as they were.
TEST(PrepareChange, AllOrNone) { EXPECT_EQ(Prepared({"position.c2=400", "position.c1=-1"}).config, nullptr); }

TEST(PrepareChange, LimitsAreLoosenedOnlyWhileHeld) {
  EXPECT_NE(Prepared({"limits.pressure=1500"}).config, nullptr);
  EXPECT_EQ(Prepared({"limits.pressure=2500"}).config, nullptr);
  EXPECT_NE(Prepared({"limits.pressure=2500"}, {.held = true}).config, nullptr);
}

// Tests that a reference which takes the arm where the loops are not stable is refused like gains that are
// not stable there.
TEST(PrepareChange, LoopsAreJudgedWhereTheReferenceGoes) {
  const PreparedChange far = Prepared({"reference.steps=[[0.6, 0.8]]"});
  EXPECT_EQ(far.config, nullptr);
  EXPECT_THAT(far.text, HasSubstr("would be unstable"));
  EXPECT_THAT(far.text, HasSubstr("0.8"));
  EXPECT_NE(Prepared({"reference.steps=[[0.6, 0.3]]"}).config, nullptr);
}

// Tests that from an unstable loop a change may only lead towards stable ones, and says so; that no change
// which makes it worse, or as bad, is taken; and that an undo, which somebody asks for, always goes back.
TEST(PrepareChange, FromAnUnstableLoop) {
  const auto with = [](const std::vector<std::string>& changes) {
    return settings::Changed(Parsed(kFast), changes);
  };
  const settings::StackConfig configured = with({"position.c1=10500", "position.c2=5000"});
  for (const char* worse : {"position.c2=5500", "position.c1=10501", "pressure.damping_ratio=0.4"}) {
    const PreparedChange change = PrepareChange(configured, configured, {worse}, {});
    EXPECT_EQ(change.config, nullptr) << worse;
    EXPECT_THAT(change.text, StartsWith("would be unstable: "));
    EXPECT_THAT(change.text,
                HasSubstr("what is in force is unstable, too: allowed is what makes it more stable"));
  }
  const PreparedChange better = PrepareChange(configured, configured, {"position.c2=4500"}, {});
  ASSERT_NE(better.config, nullptr) << better.text;
  EXPECT_THAT(better.text, HasSubstr("still UNSTABLE, but less than what was in force"));
  const PreparedChange stable =
      PrepareChange(configured, configured, {"position.c2=450", "position.c1=2000"}, {});
  ASSERT_NE(stable.config, nullptr) << stable.text;
  EXPECT_THAT(stable.text, ::testing::Not(HasSubstr("UNSTABLE")));
  for (const auto& from : {better.config, stable.config}) {
    const auto back = std::make_shared<const settings::StackConfig>(configured);
    const PreparedChange undone = PrepareChange(configured, *from, back, {.undo = true});
    ASSERT_NE(undone.config, nullptr) << undone.text;
    EXPECT_THAT(undone.text, HasSubstr("an UNSTABLE loop, as it was when these values were in force before"));
    EXPECT_EQ(PrepareChange(configured, *from, back, {}).config, nullptr) << "a set is no undo";
  }
  // An undo is no way around limits.
  const settings::StackConfig tight = settings::Changed(configured, {"limits.pressure=1500"});
  EXPECT_EQ(PrepareChange(configured, tight, std::make_shared<const settings::StackConfig>(configured),
                          {.undo = true})
                .config,
            nullptr);
}

// Tests that an undo that would loosen a limit says what to set instead, or that nothing else would change.
TEST(PrepareChange, AnUndoThatWouldLoosenALimit) {
  const settings::StackConfig configured = Parsed(kFast);
  const auto undone = [&](const std::vector<std::string>& changes) {
    return PrepareChange(configured, settings::Changed(configured, changes),
                         std::make_shared<const settings::StackConfig>(configured), {.undo = true})
        .text;
  };
  EXPECT_THAT(
      undone({"limits.pressure=1500", "position.c2=400", "pressure.damping_ratio=0.6"}),
      AllOf(StartsWith("limits.pressure: found 2000 psi, allowed up to 1500 psi"),
            ::testing::EndsWith("; to take back the rest alone, set it: hydro-set CONFIG position.c2=350 "
                                "pressure.damping_ratio=0.5")));
  EXPECT_THAT(undone({"limits.pressure=1500", "reference.steps=[[0.6, 0.1]]"}),
              ::testing::ContainsRegex("hydro-set CONFIG 'reference.steps=\\[\\[.*'$"));
  EXPECT_THAT(undone({"limits.pressure=1500"}), HasSubstr("; nothing else would change"));
}

// Tests that what is stable by a hair is accepted with a warning, and what is well stable without.
TEST(PrepareChange, WarnsOfWhatIsHardlyStable) {
  const PreparedChange good = Prepared({"position.c2=450"});
  ASSERT_NE(good.config, nullptr) << good.text;
  EXPECT_THAT(good.text, ::testing::Not(HasSubstr("HARDLY")));
  // The gain at which the loop becomes unstable, and a little less.
  double c1 = 1000;
  while (Prepared({"position.c1=" + std::to_string(c1)}).config != nullptr) c1 *= 1.05;
  const PreparedChange edge = Prepared({"position.c1=" + std::to_string(c1 / 1.06)});
  ASSERT_NE(edge.config, nullptr) << edge.text;
  EXPECT_THAT(edge.text, HasSubstr("HARDLY STABLE"));
}

TEST(PrepareChange, AReferenceTravelsAsText) {
  const PreparedChange change =
      Prepared({"reference.kind=sine", "reference.amplitude=0.05", "reference.frequency_hz=0.5"});
  ASSERT_NE(change.config, nullptr) << change.text;
  EXPECT_TRUE(change.new_reference);
  const settings::ReferenceSection reference = settings::ParseReference(change.message.reference);
  EXPECT_EQ(reference.trajectory.kind, settings::TrajectorySpec::Kind::kSine);
  EXPECT_EQ(reference.trajectory.amplitude, 0.05);
  EXPECT_EQ(reference.signal, settings::ReferenceSignal::kArmAngle);
}

// A configuration in which the row's key has a meaning.
std::string ConfigFor(const TunableKey& row) {
  const std::string last(row.key.substr(row.key.find('.') + 1));
  if (!row.key.starts_with("reference.")) return kFast;
  std::vector<std::string> kind;
  for (const char* name : {"steps", "sine", "chirp", "planner"}) {
    const auto keys = settings::KeysOfTrajectory(name);
    if (kind.empty() && std::find(keys.begin(), keys.end(), last) != keys.end()) {
      kind = {std::string("reference.kind=") + name};
    }
  }
  if (last == "points" || last == "interpolation")
    kind = {"reference.kind=csv", "reference.points=[[0, 0], [1, 0.1]]"};
  return settings::Changed(Parsed(kFast), kind).text;
}

// Tests that every row of the table is a key of the configuration: with a value that no key allows, it is the
// value that is refused.
TEST(TunableKeys, AreKeysOfTheConfiguration) {
  for (const TunableKey& row : TunableKeys()) {
    const std::string key(row.key);
    const std::string config = ConfigFor(row);
    const PreparedChange change = Prepared({key + "={}"}, {.held = true, .simulated = true}, config);
    EXPECT_EQ(change.config, nullptr);
    EXPECT_THAT(change.text, ::testing::AnyOf(HasSubstr(key + ": found"), HasSubstr(key + "[")));
  }
}

settings::StackConfig InSi(const std::string& config) {
  const model::ModelDescription model = settings::ParseModel(settings::kModelText, "model.toml");
  return Parsed(config, settings::FormatModel(testing::InUnits(model, kSiUnits)));
}

// Tests that units are those of the running stack's model and of its reference's signal, and come from no
// other list.
TEST(TunableKeys, UnitsAreThoseOfTheModel) {
  const settings::StackConfig si = InSi(kFast);
  settings::StackConfig pressure = si;
  pressure.reference.signal = settings::ReferenceSignal::kPressure;
  const auto unit = [](const char* key, const settings::StackConfig& config) {
    return UnitOf(*FindTunable(key), config);
  };
  EXPECT_EQ(unit("limits.pressure", Parsed(kFast)), "psi");
  EXPECT_EQ(unit("limits.pressure", si), "Pa");
  EXPECT_EQ(unit("limits.arm_torque", si), "N m");
  EXPECT_EQ(unit("pressure.k_p", si), "V/Pa");
  EXPECT_EQ(unit("position.c2", si), "Pa s/rad");
  EXPECT_EQ(unit("reference.steps", si), "s, rad");
  EXPECT_EQ(unit("reference.amplitude", pressure), "Pa");
  EXPECT_EQ(unit("reference.frequency_hz", pressure), "Hz");
  EXPECT_EQ(unit("pressure.damping_ratio", si), "");
  for (const TunableKey& row : TunableKeys()) {
    EXPECT_EQ(UnitOf(row, si).find("psi"), std::string::npos) << row.key;
  }
}

// Tests that a change may be a text with a unit, and may name a key as it was once called where that is true.
TEST(PrepareChange, TakesTextsWithUnits) {
  const settings::StackConfig si = InSi(kFast);
  const auto prepared = [](const settings::StackConfig& config, const std::string& line) {
    return PrepareChange(config, config, {line}, {});
  };
  const PreparedChange bar = prepared(si, "limits.pressure=100 bar");
  ASSERT_NE(bar.config, nullptr) << bar.text;
  EXPECT_EQ(bar.message.changes, "limits.pressure = 1e+07\n");
  EXPECT_DOUBLE_EQ(ValueOf(bar.message, "limits.pressure"), 1e7);
  EXPECT_THAT(prepared(si, "limits.pressure=200 bar").text, HasSubstr("found 20000000 Pa, allowed up to"));
  EXPECT_THAT(prepared(si, "limits.pressure=30 mm").text, HasSubstr("limits.pressure: found \"30 mm\""));
  EXPECT_THAT(prepared(si, "limits.pressure_psi=1500").text, HasSubstr("a key in psi, and a model in Pa"));
  const PreparedChange former = Prepared({"limits.pressure_psi=1500"});
  ASSERT_NE(former.config, nullptr) << former.text;
  EXPECT_EQ(former.message.changes, "limits.pressure = 1500\n");
}

// Tests that the table's ranges are those of the configuration, at both sides of their ends.
TEST(TunableKeys, RangesAreThoseOfTheConfiguration) {
  int checked = 0;
  for (const TunableKey& row : TunableKeys()) {
    const bool positive = row.range.starts_with("> 0"), from_zero = row.range == ">= 0";
    if (!positive && !from_zero) continue;
    ++checked;
    const std::string key(row.key), config = ConfigFor(row);
    const auto refused = [&](const char* value) {
      std::vector<std::string> changes{key + "=" + value};
      if (key == "pressure.k_p") changes.emplace_back("pressure.k_v=1");  // both or none
      if (key == "pressure.k_v") changes.emplace_back("pressure.k_p=1");
      const PreparedChange change = Prepared(changes, {.held = true, .simulated = true}, config);
      return change.config == nullptr && change.text.find(key + ": found") != std::string::npos;
    };
    EXPECT_TRUE(refused("-1e-9")) << key;
    EXPECT_EQ(refused("0"), positive) << key;
    const bool above_the_start =
        key == "limits.pressure";  // besides, it must allow the pressure at the start
    EXPECT_FALSE(refused(above_the_start ? "101" : "1e-9")) << key;
  }
  EXPECT_GT(checked, 15);
}

}  // namespace
}  // namespace hydro::tuning
