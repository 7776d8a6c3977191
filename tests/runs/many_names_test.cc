// Files with very many names: what they cost must grow with their number, and not with its square, and what
// is said of them must stay short.
#include <gmock/gmock.h>

#include <functional>

#include "base/tables/table.h"
#include "settings/effect_file.h"
#include "settings/joint_documents.h"
#include "settings/model_file.h"
#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"
#include "tests/runs/count_comparisons.h"
#include "tests/runs/log/log_fixture.h"
#include "tests/settings/small_texts.h"

namespace hydro::runs {
namespace {

using testing::HasSubstr;

constexpr int kNames = 1500;

class ManyNamesTest : public log::LogTest {
 protected:
  // Comparisons that `work` takes with so many names, after `prepare`. It may refuse them.
  static int64_t Cost(int names, const std::function<std::function<void()>(int)>& prepare) {
    const std::function<void()> work = prepare(names);
    const int64_t before = ComparisonCount();
    try {
      work();
    } catch (const InputError& error) {
      EXPECT_LT(std::string(error.what()).size(), 8000u) << "not all of them are named";
    }
    return ComparisonCount() - before;
  }

  // A sorted list takes a little more than twice as much for twice as many names, a search one by one four
  // times as much.
  static void ExpectLinear(const char* what, const std::function<std::function<void()>(int)>& prepare) {
    const int64_t once = Cost(kNames, prepare), twice = Cost(2 * kNames, prepare);
    EXPECT_GT(once, 0) << what << ": comparisons are counted";
    EXPECT_LT(static_cast<double>(twice), 2.6 * static_cast<double>(once) + 1000)
        << what << ": " << once << " and " << twice;
  }
};

std::string Keys(int count) {
  std::string keys;
  for (int i = 0; i < count; ++i) keys += "unknown_" + std::to_string(1000000 + i) + " = 1\n";
  return keys;
}

// Tests unknown keys wherever a document may have them: at its top, in a section, in a joint's own section
// that is laid over the common one, in an effect; and very many parameters of an effect, joints and effects.
TEST_F(ManyNamesTest, KeysOfADocument) {
  const std::string joint = "[[joint]]\nname = \"hip\"\n[joint.limits]\n";
  const auto config = [](const std::string& text) {
    return [text] { settings::ParseStackConfig(text, "test.toml", settings::kModelText, "model.toml"); };
  };
  const auto limb = [](const std::string& text) {
    return [text] { settings::SplitJoints(settings::ParseToml(text, "limb.toml"), {}); };
  };
  ExpectLinear("at the top", [&](int count) { return config(Keys(count)); });
  ExpectLinear("in a section", [&](int count) { return config("[limits]\n" + Keys(count)); });
  ExpectLinear("in a model", [&](int count) -> std::function<void()> {
    return [text = "[parameters]\n" + Keys(count)] { settings::ParseModel(text, "model.toml"); };
  });
  ExpectLinear("in a joint", [&](int count) { return limb(joint + Keys(count)); });
  ExpectLinear("in both", [&](int count) { return limb("[limits]\n" + Keys(count) + joint + Keys(count)); });
  ExpectLinear("joints", [&](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "[[joint]]\nname = \"j" + std::to_string(1000000 + i) + "\"\n";
    return std::function<void()>([text] { settings::JointNames(settings::ParseToml(text, "limb.toml")); });
  });
  ExpectLinear("parameters of an effect", [&](int count) -> std::function<void()> {
    std::string text = "id = \"arm.spring\"\nsummary = \"a spring\"\nequation = \"arm_torque -= alpha\"\n";
    for (int i = 0; i < count; ++i)
      text += "[parameters.p" + std::to_string(1000000 + i) + "]\nmeaning = \"none\"\nexample = 1\n";
    const std::string file = Path("effect.toml");
    log::WriteBytes(file, text);
    return [file] { settings::LoadEffectFile(file); };
  });
}

// Tests that a limb has no more joints than its logs can have.
TEST_F(ManyNamesTest, MostJoints) {
  std::string text;
  for (size_t i = 0; i <= settings::kMostJoints; ++i)
    text += "[[joint]]\nname = \"j" + std::to_string(i) + "\"\n";
  EXPECT_THAT(log::InputErrorOf([&] { settings::JointNames(settings::ParseToml(text, "limb.toml")); }),
              HasSubstr("limb.toml:2001: joint: found 1001 joints, allowed up to 1000"));
}

// Tests that an effect has no more parameters than anybody would write.
TEST_F(ManyNamesTest, MostParametersOfAnEffect) {
  std::string text = "id = \"arm.spring\"\nsummary = \"a spring\"\nequation = \"arm_torque -= alpha\"\n";
  for (int i = 0; i < 257; ++i) text += "[parameters.p" + std::to_string(i) + "]\nmeaning = \"none\"\n";
  log::WriteBytes(Path("effect.toml"), text);
  EXPECT_THAT(log::InputErrorOf([&] { settings::LoadEffectFile(Path("effect.toml")); }),
              HasSubstr(": parameters: found 257 of them, allowed up to 256"));
}

// Tests a MAT file of many variables, of all of them and of one that is asked for.
TEST_F(ManyNamesTest, VariablesOfAMatFile) {
  for (const bool all : {true, false}) {
    ExpectLinear(all ? "all" : "one asked for", [&](int count) -> std::function<void()> {
      tables::Table table;
      for (int i = 0; i < count; ++i) table.columns.push_back({"v" + std::to_string(1000000 + i), {1, 2}});
      const std::string file = Path("many.mat");
      ForgetRead(file);
      tables::WriteMat(table, file);
      return [file, all, count] {
        const tables::Table read =
            tables::ReadMat(file, all ? tables::AskedColumns{} : tables::AskedColumns{{"v1000007"}, "", ""});
        EXPECT_EQ(read.columns.size(), static_cast<size_t>(count));
      };
    });
  }
}

}  // namespace
}  // namespace hydro::runs
