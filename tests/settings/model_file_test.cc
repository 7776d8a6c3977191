#include "settings/model_file.h"

#include <cmath>
#include <random>

#include "model/sides.h"
#include "model/terms/parameter_info.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string With(const std::string& more) { return std::string(kModelText) + more; }
std::string Changed(const std::string& from, const std::string& to) { return Replaced(kModelText, from, to); }

// Tests that r and d give c = r^2 d / 2 and that all other numbers are taken as they are.
TEST(ModelFileTest, ReadsTable1) {
  const model::ModelDescription model = ParseModel(kModelText, "m.toml");
  EXPECT_EQ(model.name, "Table 1");
  EXPECT_DOUBLE_EQ(model.parameters.c, 3.68379);
  EXPECT_EQ(model.parameters.beta, 247000.0);
  EXPECT_EQ(model.parameters.c_E, 6.5e-6);
  EXPECT_EQ(model.parameters.J_a, 23.3);
  EXPECT_TRUE(model.effects.empty());
}

// Tests that c may be given instead of r and d.
TEST(ModelFileTest, TakesTheDisplacementItself) {
  EXPECT_EQ(ParseModel(Changed("r = 1.83\nd = 2.20\n", "c = 3.7\n"), "m.toml").parameters.c, 3.7);
}

// Tests that two sides give their mean and their difference, which the equations have as an effect; and the
// same by a ratio.
TEST(ModelFileTest, ReadsUnequalSides) {
  const std::string text = Replaced(
      Replaced(Changed("r = 1.83\nd = 2.20\n", "c_1 = 3\nc_2 = 5\n"), "V_ms = 3.16\n", "V_1 = 2\nV_2 = 6\n"),
      "D = 0.00796\n", "D_1 = 0.004\nD_2 = 0.012\n");
  const model::ModelDescription model = ParseModel(text, "m.toml");
  EXPECT_EQ(model.parameters.c, 4);
  EXPECT_EQ(model.parameters.V_ms, 4);
  EXPECT_EQ(model.parameters.D, 0.008);
  EXPECT_EQ(model::DifferencesOf(model),
            (model::Differences{.areas = 0.25, .volumes = 0.5, .displacements = 0.5}));
  EXPECT_EQ(model::DifferencesOf(ParseModel(FormatModel(model), "again.toml")), model::DifferencesOf(model));
  const model::ModelDescription ratio =
      ParseModel(Changed("r = 1.83\nd = 2.20\n", "c = 4\narea_ratio = 0.6\n"), "m.toml");
  EXPECT_DOUBLE_EQ(model::DifferencesOf(ratio).areas, -0.25);
  EXPECT_EQ(ratio.parameters.c, 4);
  EXPECT_TRUE(ParseModel(Changed("r = 1.83\nd = 2.20\n", "c_1 = 4\nc_2 = 4\n"), "m.toml").effects.empty());
}

// Tests that sides that contradict something are refused, with the line and what is allowed.
TEST(ModelFileTest, RefusesContradictorySides) {
  const auto error = [](const std::string& text) {
    return InputErrorOf([&] { ParseModel(text, "m.toml"); });
  };
  const auto c = [](const std::string& to) { return Changed("r = 1.83\nd = 2.20\n", to); };
  EXPECT_THAT(error(c("c_1 = 3\n")), AllOf(HasSubstr("parameters.c_2"), HasSubstr("found nothing")));
  EXPECT_THAT(error(c("c_1 = 3\nc_2 = 4\nc = 4\n")),
              HasSubstr("parameters.c: found it beside c_1, allowed c_1 and c_2, or c"));
  EXPECT_THAT(error(c("c_1 = 3\nc_2 = -4\n")), HasSubstr("parameters.c_2: found -4"));
  EXPECT_THAT(error(c("c_1 = 3\nc_2 = 4\narea_ratio = 2\n")),
              HasSubstr("parameters.area_ratio: found it beside c_1"));
  EXPECT_THAT(error(c("c_1 = 1e-12\nc_2 = 4\n")),
              HasSubstr("parameters.c_2: found 4 beside c_1 = 1e-12, allowed c_2 from c_1/39 to 39 c_1"));
  EXPECT_THAT(
      error(Replaced(c("c = 4\n"), "V_ms = 3.16\n", "V_1 = 0.1\nV_2 = 16\n")),
      AllOf(HasSubstr("m.toml:"), HasSubstr("parameters.V_2: found 16 beside V_1 = 0.1, allowed V_2 ")));
  EXPECT_THAT(error(Replaced(c("c = 4\n"), "D = 0.00796\n", "D_1 = 1\nD_2 = 0.001\n")),
              HasSubstr("parameters.D_2: found 0.001 beside D_1 = 1, allowed D_2 from D_1/"));
  EXPECT_THAT(error(c("c = 3\narea_ratio = 0\n")), HasSubstr("parameters.area_ratio: found 0"));
  EXPECT_THAT(error(c("c = 3\narea_ratio = 50\n")),
              AllOf(HasSubstr("parameters.area_ratio: found 50"), HasSubstr("39")));
  EXPECT_THAT(error(c("c_1 = 3\nc_2 = 4\n") + "[effects.\"actuator.unequal_areas\"]\ndifference = 0.1\n"),
              HasSubstr("found it beside unequal sides in [parameters], allowed one of the two"));
}

// Tests that effects keep the file's order and their parameters.
TEST(ModelFileTest, ReadsEffectsInOrder) {
  const model::ModelDescription model = ParseModel(
      With(
          "[effects.\"pump.stribeck\"]\nspeed = 3\nstatic_excess = 0.5\n[effects.\"amp.lag\"]\ntau = 1e-3\n"),
      "m.toml");
  ASSERT_EQ(model.effects.size(), 2u);
  EXPECT_EQ(model.effects[0].id, "pump.stribeck");
  EXPECT_EQ(model.effects[0].parameters.at("speed"), 3.0);
  EXPECT_EQ(model.effects[0].parameters.at("static_excess"), 0.5);
  EXPECT_EQ(model.effects[1].id, "amp.lag");
}

// Tests that a written model reads back bit by bit, also with awkward numbers and every known effect.
TEST(ModelFileTest, RoundTripsBitByBit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(1, 10);
  for (int repeat = 0; repeat < 50; ++repeat) {
    model::ModelDescription model;
    model.name = "quotes \" and \\ and \xC3\xA4\n" + std::to_string(repeat);
    const auto number = [&](const model::ParameterInfo& info) {
      const double value = mantissa(random) * std::pow(10, static_cast<int>(random() % 12) - 8);
      if (value >= info.min && value <= info.max) return value;
      return std::isfinite(info.max) ? info.min + (info.max - info.min) * (value - std::floor(value))
                                     : info.min + value;
    };
    for (const model::BaseParameter& parameter : model::BaseParameters()) {
      model.parameters.*parameter.member = number(parameter.info);
    }
    for (const model::EffectInfo& info : model::EffectCatalogue()) {
      model::EffectDescription effect;
      effect.id = info.id;
      for (const model::ParameterInfo& parameter : info.parameters) {
        if (parameter.is_name()) {
          effect.names[parameter.name] = parameter.names.back();
        } else {
          effect.parameters[parameter.name] = number(parameter);
        }
      }
      model.effects.insert(repeat % 2 == 0 ? model.effects.end() : model.effects.begin(), effect);
    }
    const model::ModelDescription back = ParseModel(FormatModel(model), "m.toml");
    EXPECT_EQ(back.name, model.name);
    for (const model::BaseParameter& parameter : model::BaseParameters()) {
      EXPECT_EQ(back.parameters.*parameter.member, model.parameters.*parameter.member) << parameter.info.name;
    }
    ASSERT_EQ(back.effects.size(), model.effects.size());
    for (size_t i = 0; i < model.effects.size(); ++i) {
      EXPECT_EQ(back.effects[i].id, model.effects[i].id);
      EXPECT_EQ(back.effects[i].parameters, model.effects[i].parameters);
      EXPECT_EQ(back.effects[i].names, model.effects[i].names);
    }
  }
}

// Tests that [uncertainty] is read and written, and that wrong keys and values are refused.
TEST(ModelFileTest, Uncertainty) {
  const model::ModelDescription model = ParseModel(With("[uncertainty]\nT_s = 0.4\nJ = 0.02\n"), "m.toml");
  EXPECT_EQ(model.uncertainty, (std::map<std::string, double>{{"J", 0.02}, {"T_s", 0.4}}));
  EXPECT_EQ(model::UncertaintyOf(model, model::BasePlace("T_s")), 0.4);
  EXPECT_EQ(model::UncertaintyOf(model, model::BasePlace("c")), 0.01);
  EXPECT_EQ(ParseModel(FormatModel(model), "m.toml").uncertainty, model.uncertainty);
  EXPECT_THAT(InputErrorOf([&] { ParseModel(With("[uncertainty]\nT_s = 0\n"), "m.toml"); }),
              HasSubstr("uncertainty.T_s: found 0"));
  EXPECT_THAT(InputErrorOf([&] { ParseModel(With("[uncertainty]\nT_x = 0.1\n"), "m.toml"); }),
              HasSubstr("T_x"));
}

// Tests that the uncertainty of unequal sides may be given by their names: the larger one is that of the
// mean.
TEST(ModelFileTest, UncertaintyOfSides) {
  const auto uncertainty = [](const std::string& keys) {
    return ParseModel(With("[uncertainty]\n" + keys), "m.toml").uncertainty;
  };
  using Map = std::map<std::string, double>;
  EXPECT_EQ(uncertainty("c_1 = 0.02\nc_2 = 0.05\nV_1 = 0.3\nV_2 = 0.1\nD_1 = 0.2\nD_2 = 0.2\n"),
            (Map{{"c", 0.05}, {"V_ms", 0.3}, {"D", 0.2}}));
  // The other side is known to the 1 % of its kind.
  EXPECT_EQ(uncertainty("c_1 = 0.02\n"), (Map{{"c", 0.02}}));
  EXPECT_EQ(uncertainty("c_2 = 0.001\n"), (Map{{"c", 0.01}}));
  EXPECT_THAT(InputErrorOf([&] { uncertainty("c = 0.1\nc_2 = 0.2\n"); }),
              HasSubstr("uncertainty.c: found it beside c_2, allowed c_1 and c_2, or c, not both"));
  EXPECT_THAT(InputErrorOf([&] { uncertainty("D_1 = 0\n"); }), HasSubstr("uncertainty.D_1: found 0"));
}

constexpr char kCurve[] =
    "[effects.\"closure.flow_1\"]\nagainst = [\"p1\", \"arm_angle\"]\nknots = [0, 1e2]\nknots_2 = [-0.1, "
    "0.1, 0.3]\n"
    "values = [0.1, 0.2, 0.30000000000000004, -1, 2, 3]\n";

// Tests that lists of names and numbers are read, and written so that they read back bit by bit.
TEST(ModelFileTest, Lists) {
  const model::ModelDescription model = ParseModel(With(kCurve), "m.toml");
  ASSERT_EQ(model.effects.size(), 1u);
  EXPECT_EQ(model.effects[0].name_lists.at("against"), (std::vector<std::string>{"p1", "arm_angle"}));
  EXPECT_EQ(model.effects[0].lists.at("knots"), (std::vector<double>{0, 100}));
  EXPECT_EQ(model.effects[0].lists.at("values")[2], 0.1 + 0.2);
  const std::string text = FormatModel(model);
  const model::ModelDescription back = ParseModel(text, "m.toml");
  EXPECT_EQ(back.effects[0].lists, model.effects[0].lists);
  EXPECT_EQ(back.effects[0].name_lists, model.effects[0].name_lists);
  EXPECT_EQ(FormatModel(back), text);
}

// Tests that wrong lists are refused with line, key, what was found and what is allowed.
TEST(ModelFileTest, RefusesWrongLists) {
  const struct {
    const char *from, *to, *says;
  } lists[] = {
      {"knots = [0, 1e2]\n", "",
       "m.toml:20: effects.closure.flow_1.knots: found nothing, allowed a list of two or more"},
      {"[0, 1e2]", "7", "m.toml:22: effects.closure.flow_1.knots: found 7, allowed a list"},
      {"[0, 1e2]", "[0]", "knots: found a list of 1, allowed a list of two or more finite numbers"},
      {"[0, 1e2]", "[0, \"a\"]", "knots: found \"a\", allowed"},
      {"[0, 1e2]", "[0, inf]", "knots: found inf, allowed"},
      {"[-0.1, 0.1, 0.3]", "[-0.1, 0.1, 0.1]", "knots_2: found 0.1 after 0.1, allowed"},
      {"knots_2 = [-0.1, 0.1, 0.3]\n", "",
       "knots_2: found nothing, allowed the knots of the second variable"},
      {"-1, 2, 3]", "-1, 2]",
       "m.toml:24: effects.closure.flow_1.values: found 5 values, allowed 6: one a knot"},
      {"-1, 2, 3]", "-1, 2, nan]", "values: found nan, allowed a list of finite numbers (in^3/s,"},
      {"[\"p1\", \"arm_angle\"]", "\"p1\"", "against: found \"p1\", allowed a list with some of"},
      {"[\"p1\", \"arm_angle\"]", "[]", "against: found an empty list, allowed"},
      {"\"arm_angle\"", "\"arm_angel\"", "did you mean \"arm_angle\"?"},
      {"\"arm_angle\"", "\"p1\"", "against: found 2 names, allowed one variable, or two that differ"},
      {"values", "value", "\"value\": found an unknown key"}};
  for (const auto& one : lists) {
    const std::string text = With(Replaced(kCurve, one.from, one.to));
    EXPECT_THAT(InputErrorOf([&] { ParseModel(text, "m.toml"); }), HasSubstr(one.says)) << one.to;
  }
}

// Tests that units are labels: the numbers stay, the errors name the model's units, and the text keeps them.
TEST(ModelFileTest, Units) {
  EXPECT_EQ(ParseModel(kModelText, "m.toml").units, UnitSystem{});
  const struct {
    const char* text;
    UnitSystem units;
    const char* c;
  } models[] = {
      {"units = \"si\"\n", kSiUnits, "m^3/rad"},
      {"units = { length = \"m\", force = \"N\", time = \"s\", angle = \"rad\" }\n", kSiUnits, "m^3/rad"},
      {"units = { length = \"mm\", force = \"N\" }\n", {"mm", "N", false}, "mm^3/rad"},
      {"units = { arm = \"in\" }\n", {"in", "lbf", true}, "in^2"},
      {"units = { arm = \"mm\", length = \"mm\", force = \"kN\" }\n", {"mm", "kN", true}, "mm^2"},
      {"units = { arm = \"rad\" }\n", {}, "in^3/rad"}};
  for (const auto& one : models) {
    const model::ModelDescription model = ParseModel(one.text + std::string(kModelText), "m.toml");
    EXPECT_EQ(model.units, one.units) << one.text;
    EXPECT_EQ(model.parameters.beta, 247000.0);
    const std::string text = FormatModel(model);
    EXPECT_EQ(ParseModel(text, "m.toml").units, one.units) << text;
    EXPECT_EQ(FormatModel(ParseModel(text, "m.toml")), text);
    EXPECT_EQ(ParseModelUnits(one.text, "log"), one.units);
    EXPECT_THAT(InputErrorOf([&] { ParseModel(one.text + Changed("r = 1.83\nd = 2.20\n", ""), "m.toml"); }),
                HasSubstr("parameters.c: found nothing, allowed a finite number above 0 (" +
                          std::string(one.c) + ","));
  }
  EXPECT_THAT(FormatModel(ParseModel(kModelText, "m.toml")), Not(HasSubstr("units")));
  EXPECT_THAT(FormatModel(ParseModel("units = \"si\"\n" + std::string(kModelText), "m.toml")),
              HasSubstr("units = \"si\"\n"));
}

// Tests that each malformed model is refused with file and line, key, what was found and what is allowed.
TEST(ModelFileTest, RefusesMalformedModels) {
  const struct {
    std::string text;
    std::string place;
    std::string says;
  } models[] = {
      {Changed("k_1 = 4.0", "k_1 = "), "m.toml:3: ", "syntax: "},
      {Changed("k_1 = 4.0", "k_1 = 4.0\nk_1 = 5.0"), "m.toml:4: ", "syntax: "},
      {Changed("k_1 = 4.0\n", ""),
       "m.toml:2: ", "parameters.k_1: found nothing, allowed a finite number above 0"},
      {Changed("k_1 = 4.0", "K_1 = 4.0"), "m.toml:3: ", "\"K_1\": found an unknown key, allowed \"k_1\""},
      {Changed("k_1 = 4.0", "K_1 = 4.0"), "m.toml:3: ", "did you mean \"k_1\"?"},
      {Changed("p_3 = 100.0", "p3 = 100.0"), "m.toml:16: ", "did you mean \"p_3\"?"},
      {Changed("k_1 = 4.0", "k_1 = \"4.0\""),
       "m.toml:3: ", "parameters.k_1: found \"4.0\", allowed a finite number"},
      {Changed("k_1 = 4.0", "k_1 = nan"),
       "m.toml:3: ", "parameters.k_1: found nan, allowed a finite number above 0"},
      {Changed("k_1 = 4.0", "k_1 = inf"), "m.toml:3: ", "parameters.k_1: found inf"},
      {Changed("k_1 = 4.0", "k_1 = 0"),
       "m.toml:3: ", "parameters.k_1: found 0, allowed a finite number above 0"},
      {Changed("k_1 = 4.0", "k_1 = [4.0]"), "m.toml:3: ", "parameters.k_1: found an array"},
      {Changed("k_1 = 4.0", "k_1 = 2020-01-01"), "m.toml:3: ", "parameters.k_1: found a date or time"},
      {Changed("b = 0.01455", "b = -1"),
       "m.toml:7: ", "parameters.b: found -1, allowed a finite number of at least 0"},
      {Changed("beta = 247000", "beta = -247000"), "m.toml:10: ", "parameters.beta: found -247000"},
      {Changed("r = 1.83\n", ""), "m.toml:2: ", "parameters.r: found nothing, allowed"},
      {Changed("d = 2.20\n", ""), "m.toml:2: ", "parameters.d: found nothing, allowed"},
      {Changed("r = 1.83\nd = 2.20\n", ""), "m.toml:2: ", "parameters.c: found nothing, allowed"},
      {Changed("r = 1.83", "c = 3\nr = 1.83"),
       "m.toml:13: ", "parameters.r: found it beside c, allowed r and d, or c, not both"},
      {Changed("r = 1.83", "c = 3"),
       "m.toml:13: ", "parameters.d: found it beside c, allowed r and d, or c, not both"},
      {Changed("r = 1.83", "r = -1.83"),
       "m.toml:12: ", "parameters.r: found -1.83, allowed a finite number above 0"},
      {Changed("r = 1.83", "r = 1e200"), "m.toml:12: ", "parameters.r: found r^2 d / 2 = inf"},
      {Changed("name = \"Table 1\"", "name = 1"), "m.toml:1: ", "name: found 1, allowed a string"},
      {Changed("[parameters]", "[parameter]"), "m.toml:2: ", "\"parameter\": found an unknown key, allowed"},
      {"name = \"x\"\n", "m.toml: ", "parameters: found nothing, allowed a section [parameters]"},
      {"", "m.toml: ", "parameters: found nothing"},
      {"parameters = 3\n", "m.toml:1: ", "parameters: found 3, allowed a section [parameters]"},
      {With("[effects.\"pump.stribek\"]\nspeed = 3\n"),
       "m.toml:20: ", "unknown effect \"pump.stribek\", allowed"},
      {With("[effects.\"pump.stribek\"]\nspeed = 3\n"), "m.toml:20: ", "did you mean \"pump.stribeck\"?"},
      {With("[effects.pump.stribeck]\nspeed = 3\nstatic_excess = .5\n"), "m.toml:", ""},
      {With("[effects.pump.stribeck]\nspeed = 3\nstatic_excess = 0.5\n"),
       "m.toml:20: ", "the id needs quotes"},
      {With("[effects.\"pump.stribeck\"]\nspeed = 3\n"),
       "m.toml:20: ", "effects.pump.stribeck.static_excess: found nothing"},
      {With("[effects.\"pump.stribeck\"]\nspeed = 3\nstatic_excess = 1\nx = 2\n"),
       "m.toml:23: ", "\"x\": found an unknown key"},
      {With("[effects.\"pump.stribeck\"]\nspeed = 0\nstatic_excess = 1\n"),
       "m.toml:21: ", "effects.pump.stribeck.speed: found 0"},
      {With("[effects]\n\"amp.lag\" = 3\n"), "m.toml:21: ", "effects.amp.lag: found 3, allowed a section"},
      {With("[[effects]]\nid = \"amp.lag\"\n"), "m.toml:20: ", "effects: found an array, allowed a section"},
      {"units = \"metric\"\n" + With(""),
       "m.toml:1: ", "units: found \"metric\", allowed \"si\", or a table"},
      {"units = 1\n" + With(""), "m.toml:1: ", "units: found 1, allowed \"si\""},
      {"units = { length = \"N\" }\n" + With(""), "m.toml:1: ", "units.length: found \"N\", allowed \"m\""},
      {"units = { force = \"bar\" }\n" + With(""), "m.toml:1: ", "units.force: found \"bar\", allowed \"N\""},
      {"units = { time = \"ms\" }\n" + With(""), "m.toml:1: ", "units.time: found \"ms\", allowed \"s\""},
      {"units = { arm = \"mm\" }\n" + With(""),
       "m.toml:1: ", "units.arm: found \"mm\", allowed \"rad\" or \"in\""},
      {"units = { pressure = \"bar\" }\n" + With(""), "m.toml:1: ", "\"pressure\": found an unknown key"},
      {With("[extra]\n"), "m.toml:20: ",
       "\"extra\": found an unknown key, allowed \"name\", \"units\", \"parameters\", \"effects\" or "
       "\"uncertainty\""},
  };
  for (const auto& model : models) {
    const std::string error = InputErrorOf([&] { ParseModel(model.text, "m.toml"); });
    EXPECT_THAT(error, AllOf(HasSubstr(model.place), HasSubstr(model.says)));
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

using ModelFileFolderTest = FolderTest;

// Tests that files that cannot be read are named with the reason.
TEST_F(ModelFileFolderTest, NamesUnreadableFiles) {
  const std::string none = (folder_ / "none.toml").string();
  EXPECT_EQ(InputErrorOf([&] { LoadModelFile(none); }),
            none + ": cannot be read: No such file or directory; is its path right?");
  EXPECT_THAT(InputErrorOf([&] { LoadModelFile(folder_.string()); }),
              HasSubstr("found a folder, allowed: a file"));
  EXPECT_EQ(LoadModelFile(Write("m.toml", kModelText)).parameters.k_2, 3.68);
}

// Tests that the error of a misspelt key lists the optional keys too.
TEST(ModelFileTest, ListsOptionalKeysOfAnEffect) {
  const std::string text = With("[effects.\"motor.back_emf\"]\nk_e = 0.1\nta = 0.002\n");
  EXPECT_THAT(InputErrorOf([&] { ParseModel(text, "m.toml"); }),
              HasSubstr("\"ta\": found an unknown key, allowed \"k_e\" or \"tau\""));
}

// Tests that effects that cannot be in one model are refused where the file is read, and that the error names
// it.
TEST_F(ModelFileFolderTest, RefusesEffectsThatExcludeEachOther) {
  const std::string file =
      Write("two.toml", With("[effects.\"accumulator.gas\"]\nvolume = 1\nexponent = 1.2\n"
                             "[effects.\"accumulator.stiffness\"]\nstiffness = 20\n"));
  EXPECT_THAT(InputErrorOf([&] { LoadModelFile(file); }),
              AllOf(HasSubstr(file + ": effect \"accumulator."), HasSubstr("second of its kind")));
}

}  // namespace
}  // namespace hydro::settings
