#include "settings/quantity_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/units.h"
#include "model/terms/parameter_info.h"
#include "settings/read_quantities.h"
#include "tests/model_in_units.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::HasSubstr;

// Table 1 as a model file in these units.
std::string ModelIn(const UnitSystem& units) {
  model::ModelDescription model = ParseModel(kModelText, "model.toml");
  model.units.linear_arm = units.linear_arm;
  return FormatModel(testing::InUnits(model, units));
}

StackConfig With(const std::vector<std::string>& lines, const UnitSystem& units) {
  std::string text = kConfigText;
  for (const std::string& line : lines) text += line + "\n";
  return Parsed(text, ModelIn(units));
}

TomlNode Read(const std::string& text, const UnitSystem& units,
              FormerNames former = FormerNames::kMustBeTrue) {
  TomlNode root = ParseToml(text, "stack.toml");
  ReadQuantities(&root, units, former);
  return root;
}

double Value(const TomlNode& root, const std::string& section, const std::string& key) {
  const TomlNode* node = root.Find(section)->Find(key);
  EXPECT_NE(node, nullptr) << key;
  return node == nullptr ? 0 : node->AsDouble();
}

constexpr UnitSystem kLinear{"mm", "N", true};

// Tests that a text with a unit becomes a number in the model's unit, whichever that is; a number stays what
// it is.
TEST(QuantityKeys, TextsAreInTheModelsUnits) {
  const std::string text = R"([limits]
pressure = "138 bar"
motor_speed = "6000 rpm"
arm_torque = "50 N m"
stale_input_s = "80 ms"
[noise]
p1 = 2.5
p2 = "1e3Pa"
[position]
c1 = "40 MPa/rad"
)";
  const TomlNode si = Read(text, kSiUnits);
  EXPECT_DOUBLE_EQ(Value(si, "limits", "pressure"), 13.8e6);
  EXPECT_DOUBLE_EQ(Value(si, "limits", "motor_speed"), 6000 * kRpm);
  EXPECT_DOUBLE_EQ(Value(si, "limits", "arm_torque"), 50);
  EXPECT_DOUBLE_EQ(Value(si, "limits", "stale_input_s"), 0.08);
  EXPECT_EQ(Value(si, "noise", "p1"), 2.5);
  EXPECT_DOUBLE_EQ(Value(si, "noise", "p2"), 1000);
  EXPECT_DOUBLE_EQ(Value(si, "position", "c1"), 40e6);
  const TomlNode paper = Read(text, {});
  EXPECT_DOUBLE_EQ(Value(paper, "limits", "pressure"), 13.8e6 / kPsi);
  EXPECT_DOUBLE_EQ(Value(paper, "limits", "arm_torque"), 50 / kInchPound);
  const TomlNode bar = Read(text, {"cm", "daN"});
  EXPECT_DOUBLE_EQ(Value(bar, "limits", "pressure"), 138);
}

// Tests that a reference's values are in the unit of its signal, also in lists, and a motion's in that of the
// arm.
TEST(QuantityKeys, ReferencesAreInTheUnitOfTheirSignal) {
  const TomlNode arm = Read(
      "[reference]\nsteps = [[\"200 ms\", \"3 cm\"], [1, 12]]\ninitial = \"1 cm\"\nmax_speed = \"0.1 m/s\"\n"
      "[model.motion]\namplitude = \"5 mm\"\n",
      kLinear);
  const std::vector<TomlNode>& steps = arm.Find("reference")->Find("steps")->items;
  EXPECT_DOUBLE_EQ(steps[0].items[0].AsDouble(), 0.2);
  EXPECT_DOUBLE_EQ(steps[0].items[1].AsDouble(), 30);
  EXPECT_EQ(steps[1].items[1].AsDouble(), 12);
  EXPECT_DOUBLE_EQ(Value(arm, "reference", "initial"), 10);
  EXPECT_DOUBLE_EQ(Value(arm, "reference", "max_speed"), 100);
  EXPECT_DOUBLE_EQ(Value(*arm.Find("model"), "motion", "amplitude"), 5);
  const TomlNode pressure = Read("[reference]\nsignal = \"pressure\"\namplitude = \"5 bar\"\n", kSiUnits);
  EXPECT_DOUBLE_EQ(Value(pressure, "reference", "amplitude"), 5e5);
  EXPECT_THAT(InputErrorOf([] { Read("[reference]\nsignal = \"torque\"\namplitude = \"5 bar\"\n", {}); }),
              HasSubstr("stack.toml:3: reference.amplitude: found \"5 bar\", allowed a number (in in-lbf)"));
}

// Tests that a former name is read where its unit is the model's, and refused with the lines to write where
// not.
TEST(QuantityKeys, FormerNamesMustBeTrue) {
  EXPECT_EQ(Value(Read("[limits]\npressure_psi = 1500\n", {}), "limits", "pressure"), 1500);
  EXPECT_EQ(Value(Read("[limits]\narm_angle_rad = 0.5\n", kSiUnits), "limits", "arm_angle"), 0.5);
  EXPECT_EQ(InputErrorOf([] { Read("[limits]\n\npressure_psi = 13.7895e6\n", kSiUnits); }),
            "stack.toml:3: limits.pressure_psi: found a key in psi, and a model in Pa, allowed the line "
            "pressure = 13789500 if that is in Pa, or pressure = \"13789500 psi\"");
  EXPECT_THAT(InputErrorOf([] { Read("[model]\narm_angle_rad = 0.1\n", kLinear); }),
              HasSubstr("found a key in rad, and a model in mm, allowed the line arm_angle = 0.1"));
  EXPECT_THAT(InputErrorOf([] {
                Read("[limits]\narm_torque_in_lbf = 1\n", UnitSystem{"in", "lbf", true});
              }),
              HasSubstr("a model in lbf"));
  EXPECT_THAT(InputErrorOf([] { Read("[limits]\npressure_psi = \"138 bar\"\n", {}); }),
              HasSubstr("allowed the line pressure = \"138 bar\""));
  EXPECT_THAT(InputErrorOf([] { Read("[noise]\np1_psi = 1\np1 = 1\n", {}); }),
              HasSubstr("stack.toml:2: noise.p1_psi: found it beside p1, its present name"));
  // What a log has recorded meant the model's unit.
  EXPECT_EQ(
      Value(Read("[limits]\npressure_psi = 2e6\n", kSiUnits, FormerNames::kAsMeant), "limits", "pressure"),
      2e6);
}

// Tests that a unit of another kind, an unknown unit and a text that is no number are refused.
TEST(QuantityKeys, OtherUnitsAreRefused) {
  const auto error = [](const std::string& line) {
    return InputErrorOf([&] { Read("[limits]\n" + line, kSiUnits); });
  };
  EXPECT_EQ(
      error("pressure = \"30 mm\"\n"),
      "stack.toml:2: limits.pressure: found \"30 mm\", allowed a number (in Pa), or a text of a number and a "
      "unit: Pa, hPa, kPa, MPa, mbar, bar, psi");
  EXPECT_THAT(error("arm_torque = \"50 Nm\"\n"), HasSubstr("and a unit: N m; did you mean \"50 N m\"?"));
  EXPECT_THAT(error("pressure = \"13.8 mpa\"\n"), HasSubstr("; did you mean \"13.8 MPa\"?"));
  EXPECT_THAT(error("pressure = \"13,8 MPa\"\n"),
              HasSubstr("; decimals begin with a point, and thousands with nothing"));
  EXPECT_THAT(InputErrorOf([] { Read("[limits]\narm_torque = \"50 psi\"\n", UnitSystem{}); }),
              HasSubstr("and a unit: in-lbf, N m"));
  EXPECT_THAT(error("pressure = \"30 furlong\"\n"), HasSubstr("found \"30 furlong\""));
  EXPECT_THAT(error("pressure = \"30\"\n"), HasSubstr("found \"30\""));
  EXPECT_THAT(error("pressure = \"1e308 MPa\"\n"), HasSubstr("found \"1e308 MPa\"")) << "beyond all numbers";
  EXPECT_THAT(error("pressure = \"1.2.3 Pa\"\n"), ::testing::IsEmpty())
      << "for the key's reader, which says what is allowed";
  EXPECT_THAT(InputErrorOf([] {
                With({"[limits]", "pressure = \"much\""}, kSiUnits);
              }),
              HasSubstr("limits.pressure: found \"much\", allowed a finite number above 0"));
}

// Tests that every former name has a key that the configuration knows, and is read as that key.
TEST(QuantityKeys, EveryFormerNameIsRead) {
  int former = 0;
  for (const QuantityKey& quantity : QuantityKeys()) {
    if (quantity.old.empty()) continue;
    ++former;
    const std::string section(quantity.section);
    const std::string dotted = section + "." + std::string(quantity.old);
    EXPECT_EQ(PresentName(dotted), section + "." + std::string(quantity.key));
    TomlNode root = ParseToml("[" + section + "]\n" + std::string(quantity.old) + " = 0.25\n", "a");
    ReadQuantities(&root, {});
    EXPECT_EQ(Value(root, section, std::string(quantity.key)), 0.25) << dotted;
    EXPECT_TRUE(ParseUnit(quantity.unit).has_value()) << dotted;
  }
  EXPECT_GE(former, 20);
}

// Tests that --set takes either name over either in the file, the last word winning.
TEST(QuantityKeys, OverridesKnowBothNames) {
  for (const char* in_file : {"pressure_psi", "pressure"}) {
    for (const char* option :
         {"limits.pressure_psi=1200", "limits.pressure=1200", "limits.pressure=1200 psi"}) {
      const StackConfig config = Changed(With({"[limits]", std::string(in_file) + " = 1500"}, {}), {option});
      EXPECT_EQ(config.limits.pressure_psi, 1200) << in_file << " " << option;
    }
  }
  EXPECT_THAT(InputErrorOf([] { Changed(With({}, kSiUnits), {"limits.pressure_psi=1200"}); }),
              HasSubstr("--set limits.pressure_psi=1200: limits.pressure_psi: found a key in psi"));
  EXPECT_DOUBLE_EQ(Changed(With({}, kSiUnits), {"limits.pressure=120 bar"}).limits.pressure_psi, 12e6);
}

// Tests that the defaults that have a unit are the paper's in every system.
TEST(QuantityKeys, DefaultsAreThePapers) {
  for (const UnitSystem& units : testing::kSystems) {
    const StackConfig config = With({}, units);
    const double psi = testing::Factor("psi", 0, units, {});
    EXPECT_NEAR(config.limits.pressure_psi * psi, 2000, 1e-9) << units.length;
    EXPECT_NEAR(config.position.dac_range_psi * psi, 2000, 1e-9) << units.length;
  }
  EXPECT_EQ(With({}, {}).limits.pressure_psi, 2000);
}

// Tests that the effective text says numbers under present names, so that what a log records depends on no
// unit in a text.
TEST(QuantityKeys, TheEffectiveTextHasNumbers) {
  const StackConfig config = With({"[limits]", "pressure = \"2000 psi\"", "arm_angle_rad = 0.5"}, {});
  EXPECT_THAT(config.text, HasSubstr("pressure = 2000"));
  EXPECT_THAT(config.text, HasSubstr("arm_angle = 0.5"));
  EXPECT_THAT(config.text, ::testing::Not(HasSubstr("psi")));
}

}  // namespace
}  // namespace hydro::settings
