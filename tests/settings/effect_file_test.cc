// Effects written as text: the whole catalogue so written moves as the catalogue does, and what is wrong is
// named.
#include "settings/effect_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/text_file.h"
#include "model/actuator.h"
#include "model/response.h"
#include "model/terms/model_error.h"
#include "model/terms/parameter_info.h"
#include "model/terms/state.h"
#include "settings/model_file.h"
#include "tests/table1.h"

namespace hydro::settings {
namespace {

const std::string kEffectFolder = std::string(HYDRO_SOURCE_DIR) + "/examples/effects";

// The file of an effect of the catalogue: "amp.lag" is in amp_lag.toml.
std::string FileOf(const std::string& id) {
  std::string name = id;
  std::replace(name.begin(), name.end(), '.', '_');
  return kEffectFolder + "/catalogue/" + name + ".toml";
}

bool Delays(const std::string& id) { return id == "amp.delay" || id == "sensor.skew"; }

std::vector<std::string> WithoutDelay() {
  std::vector<std::string> ids;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (!Delays(info.id)) ids.push_back(info.id);
  }
  return ids;
}

model::ModelDescription ModelWithEffect(const model::EffectDescription& effect) {
  model::ModelDescription model;
  model.parameters = testing::Table1();
  model.effects = {effect};
  return model;
}

// The effect as the catalogue has it, and as its file says it, with the same values.
struct Pair {
  explicit Pair(const std::string& id) {
    const auto formulas = LoadEffectFile(FileOf(id));
    const std::vector<model::ParameterInfo>& own = formulas->info().parameters;
    const std::vector<model::ParameterInfo>& known = model::FindEffect(id)->parameters;
    EXPECT_EQ(own.size(), known.size()) << id;
    compiled.id = id;
    written.id = formulas->info().id;
    written.formulas = formulas;
    for (size_t i = 0; i < known.size(); ++i) {
      EXPECT_EQ(own[i].unit, known[i].is_name() ? "1" : known[i].unit) << id;
      EXPECT_EQ(own[i].role, known[i].role) << id;
      if (known[i].is_name()) {
        compiled.names[known[i].name] = written.names[own[i].name] = "p2";
      } else {
        const double value =
            known[i].name == "no_load_speed" ? 20 : known[i].example;  // rad/s, which the commands reach
        compiled.parameters[known[i].name] = written.parameters[own[i].name] = value;
      }
    }
  }
  model::EffectDescription compiled, written;
};

// Commands that drive, brake and rest: forward, backward, and a wave that stops and turns the pump.
double Voltage(double time) {
  if (time < 0.05) return 4;
  if (time < 0.1) return -5;
  if (time < 0.13) return 0;
  return 5 * std::sin(60 * time);
}

std::vector<model::Measurement> ModelTrajectory(const model::EffectDescription& effect,
                                                const model::ActuatorOptions& options) {
  model::Actuator actuator(ModelWithEffect(effect), options);
  std::vector<model::Measurement> all;
  for (int tick = 0; tick < 250; ++tick) {
    actuator.Advance(Voltage(1e-3 * tick), 1e-3 * (tick + 1));
    all.push_back(actuator.Measure());
  }
  return all;
}

// The largest difference in a channel, over the largest number in it.
double Difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0, difference = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i]));
    difference = std::max(difference, std::abs(a[i] - b[i]));
  }
  return largest == 0 ? difference : difference / largest;
}

double Difference(const std::vector<model::Measurement>& a, const std::vector<model::Measurement>& b) {
  double worst = 0;
  for (size_t channel = 0; channel < model::kChannels; ++channel) {
    std::vector<double> left, right;
    for (size_t i = 0; i < a.size(); ++i) {
      left.push_back(model::ChannelOf(a[i], channel));
      right.push_back(model::ChannelOf(b[i], channel));
    }
    worst = std::max(worst, Difference(left, right));
  }
  return worst;
}

class WrittenCatalogue : public ::testing::TestWithParam<std::string> {};

// Tests that an effect of the catalogue, written as text, gives the same trajectories to 1e-9: with the shaft
// free, clamped, and with the bypass open.
TEST_P(WrittenCatalogue, MovesAsTheCompiledOne) {
  const Pair pair(GetParam());
  for (const bool clamped : {false, true}) {
    for (const bool bypass : {false, true}) {
      model::ActuatorOptions options;
      options.shaft = clamped ? model::Shaft::kClamped : model::Shaft::kFree;
      options.bypass = bypass;
      const std::vector<model::Measurement> compiled = ModelTrajectory(pair.compiled, options);
      EXPECT_LT(Difference(compiled, ModelTrajectory(pair.written, options)), 1e-9) << clamped << bypass;
    }
  }
}

// Tests that the effect does something there at all.
TEST_P(WrittenCatalogue, Acts) {
  const Pair pair(GetParam());
  model::ActuatorOptions clamped;
  clamped.shaft = model::Shaft::kClamped;
  double most = 0;
  for (const model::ActuatorOptions& options : {clamped, model::ActuatorOptions{}}) {
    model::ModelDescription plain;
    plain.parameters = testing::Table1();
    model::Actuator actuator(plain, options);
    std::vector<model::Measurement> without;
    for (int tick = 0; tick < 250; ++tick) {
      actuator.Advance(Voltage(1e-3 * tick), 1e-3 * (tick + 1));
      without.push_back(actuator.Measure());
    }
    most = std::max(most, Difference(without, ModelTrajectory(pair.written, options)));
  }
  EXPECT_GT(most, 1e-4);
}

// Tests that its derivatives by its parameters are those of the compiled one.
TEST_P(WrittenCatalogue, HasTheDerivatives) {
  const Pair pair(GetParam());
  model::Stimulus stimulus;
  for (int tick = 0; tick < 200; ++tick) {
    stimulus.time.push_back(1e-3 * tick);
    stimulus.voltage.push_back(Voltage(1e-3 * tick));
  }
  model::StartState start{};
  start[model::kP1] = start[model::kP2] = testing::Table1().p_3;
  std::vector<model::Unknown> unknowns = {{model::Unknown::Kind::kBase, model::BasePlace("b")}};
  for (size_t i = 0; i < pair.compiled.parameters.size(); ++i)
    unknowns.push_back({model::Unknown::Kind::kEffect, i});
  const model::Response compiled =
      model::Respond(ModelWithEffect(pair.compiled), stimulus, start, unknowns, {});
  const model::Response written =
      model::Respond(ModelWithEffect(pair.written), stimulus, start, unknowns, {});
  for (size_t channel = 0; channel < model::kChannels; ++channel) {
    EXPECT_LT(Difference(compiled.values[channel], written.values[channel]), 1e-9);
    for (size_t i = 0; i < unknowns.size(); ++i) {
      EXPECT_LT(Difference(compiled.derivatives[i][channel], written.derivatives[i][channel]), 1e-7)
          << "unknown " << i << " of channel " << channel;
    }
  }
}

// Tests that a model's text has the whole effect, and reads back as it.
TEST_P(WrittenCatalogue, IsKeptInAModelsText) {
  const Pair pair(GetParam());
  const std::string text = FormatModel(ModelWithEffect(pair.written));
  const model::ModelDescription back = ParseModel(text, "back.toml");
  EXPECT_EQ(FormatModel(back), text);
  model::ActuatorOptions options;
  EXPECT_EQ(Difference(ModelTrajectory(pair.written, options), ModelTrajectory(back.effects[0], options)), 0);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, WrittenCatalogue, ::testing::ValuesIn(WithoutDelay()),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

class EffectFileTest : public ::testing::Test {
 protected:
  // What reading this file throws, without the folder.
  std::string ErrorOf(const std::string& text) {
    // ctest runs each test in a process of its own, several at once.
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    const std::string file = ::testing::TempDir() + "/" + name + "_effect_file_test.toml";
    std::ofstream(file) << text;
    try {
      LoadEffectFile(file);
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.substr(what.find("effect_file_test"));
    }
    return "no error";
  }
  std::string ErrorOfEquation(const std::string& equation, const std::string& more = "") {
    return ErrorOf("id = \"arm.spring\"\nsummary = \"a spring\"\nequation = '" + equation + "'\n" + more +
                   "[parameters.stiffness]\nunit = \"in-lbf/rad\"\nmeaning = \"torque per angle\"\n");
  }
};

// Tests that errors name line, column and symbol, and what was probably meant.
TEST_F(EffectFileTest, ErrorsNameLineAndSymbol) {
  using ::testing::HasSubstr;
  EXPECT_EQ(ErrorOfEquation("arm_torque -= stiffness * alpha"), "no error");
  EXPECT_THAT(
      ErrorOfEquation("arm_torque -= stifness * alpha"),
      HasSubstr(
          "effect_file_test.toml:3: equation: found the unknown name \"stifness\" at column 15, allowed"));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= stifness * alpha"), HasSubstr("did you mean \"stiffness\"?"));
  EXPECT_THAT(ErrorOfEquation("arm_tork -= stiffness * alpha"), HasSubstr("did you mean \"arm_torque\"?"));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= stiffness * (alpha"),
              HasSubstr("found the end at column 33, allowed an operator or"));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= stiffness * sine(alpha)"),
              HasSubstr("the unknown function \"sine\" at column 27"));
  EXPECT_THAT(ErrorOfEquation("arm_torque = = 3"), HasSubstr("found \"=\" at column 14"));
  EXPECT_THAT(ErrorOfEquation("arm_torque =- stiffness * alpha"),
              HasSubstr("found \"=-\" at column 12, allowed -= or +="));
  EXPECT_EQ(ErrorOfEquation("arm_torque = -stiffness * alpha"), "no error");
  EXPECT_THAT(ErrorOfEquation("arm_torque"), HasSubstr("allowed =, +=, -=, *= or /="));
  EXPECT_THAT(ErrorOfEquation("D *= 1 + load"),
              HasSubstr("\"load\", which is not known yet among the properties at column 10"));
  EXPECT_THAT(ErrorOfEquation("arm_angle = 0"), HasSubstr("a change of \"arm_angle\""));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= if(p1 == p2, 1, 0)"), HasSubstr("== of quantities that change"));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= if(p1 > p2, 1)"),
              HasSubstr("found if of 2 at column 15, allowed if of 3"));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= arm_load"),
              HasSubstr("\"arm_load\", which this effect does not set"));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= a", "where = { a = 'b_', b_ = 'a' }\n"),
              HasSubstr("which stands for itself"));
  // 60 names, each twice the one before: read once each, not 2^60 times.
  std::string doubled = "where = { n_0 = 'alpha'";
  for (int i = 1; i < 60; ++i) {
    const std::string before = "n_" + std::to_string(i - 1);
    doubled += ", n_" + std::to_string(i) + " = '" + before + " + " + before + "'";
  }
  EXPECT_EQ(ErrorOfEquation("arm_torque -= n_59", doubled + " }\n"), "no error");
  EXPECT_THAT(ErrorOfEquation("arm_torque -= " + std::string(9000, '1')),
              HasSubstr("found 9014 characters at column 8193, allowed 8192 at most"));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= alpha", "where = { load = '3' }\n"),
              HasSubstr("where.load: found \"load\", which the model has already"));
  EXPECT_THAT(ErrorOfEquation("arm_torque -= \"p1\""), HasSubstr("found the text \"p1\" at column 15"));
}

// Tests that what no formula needs is an error and not a crash: depth, size, characters.
TEST_F(EffectFileTest, HostileFormulas) {
  using ::testing::HasSubstr;
  EXPECT_THAT(ErrorOfEquation("load = " + std::string(5000, '(')), HasSubstr("64 of them at most"));
  EXPECT_THAT(ErrorOfEquation("load = " + std::string(5000, '-') + "1"), HasSubstr("64 of them at most"));
  std::string sum = "1";
  for (int i = 0; i < 300; ++i) sum += " + " + std::to_string(i) + " * alpha";
  EXPECT_THAT(ErrorOfEquation("load = " + sum), HasSubstr("more than 256 operations"));
  EXPECT_THAT(ErrorOfEquation("load = 1 $ 2"), HasSubstr("found \"$\" at column 10"));
  EXPECT_THAT(ErrorOfEquation("load = 1e999"), HasSubstr("found \"1e999\""));
  EXPECT_THAT(ErrorOfEquation("load = 1.2.3"), HasSubstr("found \"1.2.3\""));
  EXPECT_THAT(ErrorOfEquation("load = "), HasSubstr("found the end"));
}

// Tests that an error quotes the beginning of a long formula or name, on one line.
TEST_F(EffectFileTest, LongFormulasAreCut) {
  using ::testing::EndsWith;
  using ::testing::HasSubstr;
  const std::string x(400'000, 'x'), start(60, 'x');
  EXPECT_THAT(ErrorOfEquation("load += " + x), EndsWith(" of \"load += " + start.substr(8) + "...\""));
  EXPECT_THAT(ErrorOfEquation("load += y", "where = { y = '" + x + "' }\n"),
              EndsWith(" of \"" + start + "...\""));
  const std::string name(8000, 'x');
  for (const std::string& equation :
       {"load += " + name, "load += " + name + "(1)", name + " += 1", "1 " + name})
    EXPECT_LT(ErrorOfEquation(equation).size(), 600u) << equation.substr(0, 12);
  EXPECT_THAT(ErrorOfEquation("load += y", "where = { \"" + name + "-\" = 'alpha' }\n"),
              HasSubstr("found the name \"" + start + "...\", allowed letters"));
  // Three quotes begin a text of several lines.
  EXPECT_THAT(ErrorOfEquation("''load +=\n stifness''"), EndsWith(" of \"load +=  stifness\""));
}

// Tests that ids, parameters and states are checked, and unknown keys named.
TEST_F(EffectFileTest, TheRestOfTheFile) {
  using ::testing::HasSubstr;
  const std::string good = "summary = \"s\"\nequation = \"load += k\"\n[parameters.k]\nmeaning = \"m\"\n";
  EXPECT_EQ(ErrorOf("id = \"a.b\"\n" + good), "no error");
  EXPECT_THAT(ErrorOf(good), HasSubstr("id: found nothing"));
  EXPECT_THAT(ErrorOf("id = \"spring\"\n" + good), HasSubstr("id: found \"spring\", allowed two names"));
  EXPECT_THAT(ErrorOf("id = \"valve.relief\"\n" + good),
              HasSubstr("\"valve.relief\", a built-in effect, allowed another id"));
  EXPECT_THAT(ErrorOf("id = \"a.b\"\ncolour = 3\n" + good), HasSubstr("colour"));
  EXPECT_THAT(ErrorOf("id = \"a.b\"\n" + good + "min = 3\nmax = 2\n"), HasSubstr("allowed a min"));
  EXPECT_THAT(ErrorOf("id = \"a.b\"\n" + good + "starts = []\n"),
              HasSubstr("parameters.k.starts: found an empty list"));
  EXPECT_THAT(ErrorOf("id = \"a.b\"\n" + good + "role = \"periods\"\n"), HasSubstr("Role::kPeriods"));
  EXPECT_THAT(ErrorOf("id = \"a.b\"\n" + good + "[parameters.alpha]\nmeaning = \"m\"\n"),
              HasSubstr("found \"alpha\", which the model has already"));
  // A model's section of the effect has the definition under this key, beside the values.
  EXPECT_THAT(ErrorOf("id = \"a.b\"\n" + good + "[parameters.definition]\nmeaning = \"m\"\n"),
              HasSubstr(":6: parameters.definition: found it as the name of a parameter, allowed another"));
  EXPECT_THAT(ErrorOf("id = \"a.b\"\n" + good + "[states.z]\nunit = \"1\"\n"),
              HasSubstr("states.z.rate: found nothing"));
  EXPECT_THAT(ErrorOf("id = \"a.b\"\n" + good + "[switches.z]\nmargin = \"1\"\n"),
              HasSubstr("switches.z.next: found nothing"));
}

// Tests that what reports print in the middle of a line is one line.
TEST_F(EffectFileTest, LinesThatAreTwo) {
  using ::testing::HasSubstr;
  const std::string begin = "id = \"a.b\"\nequation = \"load += k\"\n";
  const std::string parameter = "[parameters.k]\nmeaning = \"m\"\n";
  const std::string good = "summary = \"s\"\n";
  EXPECT_EQ(ErrorOf(begin + "summary = \"s\\tt\"\n" + parameter), "no error");
  EXPECT_THAT(ErrorOf(begin + "summary = \"s\\nt\"\n" + parameter),
              HasSubstr(":3: summary: found \"s\\nt\", allowed one line, without control characters"));
  EXPECT_THAT(ErrorOf(begin + "summary = \"s\\u001b[2J\"\n" + parameter), HasSubstr("summary: found"));
  EXPECT_THAT(ErrorOf(begin + good + "confused_with = \"a\\nb\"\n" + parameter),
              HasSubstr("confused_with: found"));
  EXPECT_THAT(ErrorOf(begin + good + parameter + "unit = \"N\\nm\"\n"),
              HasSubstr(":6: parameters.k.unit: found"));
  EXPECT_THAT(ErrorOf(begin + good + "[parameters.k]\nmeaning = \"m\\nn\"\n"),
              HasSubstr(":5: parameters.k.meaning: found"));
}

// Tests that a formula that gives what is no number ends the simulation: the pump would stick for ever.
TEST_F(EffectFileTest, NotANumber) {
  for (const char* equation :
       {"load += k * sqrt(-1 - motor_speed^2)", "arm_torque += log(-k)", "coulomb = sqrt(0.5 - t) * k"}) {
    const std::string name = ::testing::TempDir() + "/not_a_number.toml";
    std::ofstream(name) << "id = \"my.nan\"\nsummary = \"s\"\nequation = \"" << equation
                        << "\"\n[parameters.k]\nmeaning = \"m\"\n";
    model::EffectDescription effect{"my.nan", {{"k", 1}}, {}};
    effect.formulas = LoadEffectFile(name);
    model::Actuator actuator(ModelWithEffect(effect), {});
    EXPECT_THROW(
        {
          for (int tick = 0; tick < 1000; ++tick) actuator.Advance(3, 1e-3 * (tick + 1));
        },
        model::ModelError)
        << equation;
  }
}

// Tests that a model file finds the effect's file beside itself, that its text then says everything, and that
// the text of a model from anywhere else opens no file.
TEST_F(EffectFileTest, AModelNamesItsFile) {
  const std::string folder = ::testing::TempDir() + "/own_effect_model";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(kEffectFolder + "/arm_spring.toml", folder + "/arm_spring.toml",
                             std::filesystem::copy_options::overwrite_existing);
  const std::string model =
      ReadTextFile(std::string(HYDRO_SOURCE_DIR) + "/config/models/table1.toml") +
      "\n[effects.\"arm.spring\"]\ndefinition = \"arm_spring.toml\"\nstiffness = 2500\nrest = 0.1\n";
  std::ofstream(folder + "/model.toml") << model;
  const ModelWithText loaded = LoadModelWithText(folder + "/model.toml");
  ASSERT_EQ(loaded.description.effects.size(), 1u);
  EXPECT_EQ(loaded.description.effects[0].parameters.at("stiffness"), 2500);
  const model::ModelDescription from_text = ParseModel(loaded.text, "log");
  EXPECT_EQ(FormatModel(from_text), FormatModel(loaded.description));
  EXPECT_THROW(ParseModel(model, folder + "/model.toml"), InputError);
  std::filesystem::remove(folder + "/arm_spring.toml");
  try {
    LoadModelWithText(folder + "/model.toml");
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::ContainsRegex(
                                  "model.toml:[0-9]+: effects.arm.spring.definition: .*arm_spring.toml"));
  }
}

}  // namespace
}  // namespace hydro::settings
