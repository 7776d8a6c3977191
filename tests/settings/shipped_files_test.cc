#include <cmath>

#include "settings/limb_config.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

const std::filesystem::path kConfig = std::filesystem::path(HYDRO_SOURCE_DIR) / "config";

// Tests that every shipped model loads and says what it assumes, where it is not the paper's own.
TEST(ShippedFilesTest, ModelsLoad) {
  int models = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig / "models")) {
    const std::string file = entry.path().string();
    EXPECT_EQ(InputErrorOf([&] { LoadModelFile(file); }), "") << file;
    ++models;
  }
  EXPECT_GE(models, 4);
}

// Tests that every shipped stack loads with the model it names.
TEST(ShippedFilesTest, StacksLoad) {
  int stacks = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig)) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_EQ(InputErrorOf([&] { LoadCommonConfig(entry.path().string()); }), "") << entry.path();
    ++stacks;
  }
  EXPECT_GE(stacks, 1);
}

// Tests that a model in other units is refused under the numbers of a configuration, in both directions, and
// taken where the numbers that it changes have a unit of their own or are given with it; and that numbers for
// another model are told from a limit.
TEST(ShippedFilesTest, AModelInOtherUnits) {
  const auto error = [](const char* config, std::vector<std::string> overrides) {
    return InputErrorOf([&] { LoadStackConfig((kConfig / config).string(), overrides); });
  };
  EXPECT_THAT(error("demo_si.toml", {"model.file=models/table1.toml"}),
              ::testing::HasSubstr(
                  "model.file: found a model in in, lbf, psi, and numbers for one in m, N, Pa (position.c1 = "
                  "41368500), allowed a model in the same units, or values with a unit of their own"));
  EXPECT_THAT(error("demo.toml", {"model.file=models/table1_si.toml"}),
              ::testing::HasSubstr(
                  "found a model in m, N, Pa, and numbers for one in in, lbf, psi (position.c1 = 6000)"));
  EXPECT_EQ(error("demo.toml", {"model.file=models/table1_gravity.toml"}), "");
  EXPECT_EQ(error("demo.toml",
                  {"model.file=models/table1_si.toml", "position.c1=41e6", "position.c2=8e6",
                   "limits.arm_torque=50", "limits.pressure=14e6", "noise.p1=7000", "noise.p2=\"1 psi\""}),
            "");
  EXPECT_THAT(
      error("demo.toml", {"limits.pressure=13.8e6"}),
      ::testing::HasSubstr("found 13800000 psi, allowed up to 2470000 psi, ten times the oil's beta"));
  EXPECT_EQ(error("demo.toml", {"limits.pressure=inf"}), "");
}

// Tests that of a model that cannot be read, or is none, its own error is told, not its units; that the model
// in whose place it stands need not be there; and that the joints of a limb are judged like a stack.
TEST(ShippedFilesTest, AModelThatCannotBeRead) {
  using ::testing::HasSubstr;
  const auto error = [](const char* config, const std::string& model) {
    return InputErrorOf([&] { LoadCommonConfig((kConfig / config).string(), {"model.file=" + model}); });
  };
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "models_of_none";
  std::filesystem::create_directories(folder);
  const auto written = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  };
  const std::string torn = written("torn.toml", "name = [");
  const std::string half = written("half.toml", "units = \"si\"\n[parameters]\nk_1 = 4\n");
  for (const char* config : {"demo_si.toml", "demo.toml", "limb.toml"}) {
    EXPECT_THAT(error(config, "models/none.toml"),
                HasSubstr("model.file: found \"models/none.toml\", and there is no \""))
        << config;
    EXPECT_THAT(error(config, torn), HasSubstr(torn + ":1: syntax")) << config;
    EXPECT_THAT(error(config, half), HasSubstr(half)) << config;
    EXPECT_THAT(error(config, half), ::testing::Not(HasSubstr("numbers for one in"))) << config;
    EXPECT_THAT(error(config, "demo.toml"), HasSubstr("found the configuration of a stack, allowed a model"))
        << config;
    EXPECT_THAT(error(config, "models"), HasSubstr("found a folder")) << config;
  }
  EXPECT_THAT(error("limb.toml", "models/table1_si.toml"), HasSubstr("numbers for one in in, lbf, psi"));
  std::ifstream given(kConfig / "demo_si.toml");
  std::string text((std::istreambuf_iterator<char>(given)), {});
  text.replace(text.find("models/table1_si.toml"), 21, "gone.toml");
  const std::string config = written("stack.toml", text);
  const std::string model = (kConfig / "models/table1_si.toml").string();
  EXPECT_EQ(InputErrorOf([&] { LoadStackConfig(config, {"model.file=" + model}); }), "");
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig(config, {}); }), HasSubstr("found \"gone.toml\""));
  std::filesystem::remove_all(folder);
}

// Tests that the variants differ from Table 1 only where they say so.
TEST(ShippedFilesTest, VariantsOfTable1) {
  const auto load = [](const char* name) { return LoadModelFile((kConfig / "models" / name).string()); };
  const model::Parameters table1 = load("table1.toml").parameters;
  EXPECT_DOUBLE_EQ(table1.c, 3.68379);
  EXPECT_EQ(table1.mgl, 0);
  model::Parameters gravity = load("table1_gravity.toml").parameters;
  EXPECT_EQ(gravity.mgl, 562);
  gravity.mgl = 0;
  model::Parameters wide = load("wide_actuator.toml").parameters;
  EXPECT_GT(wide.V_ms / wide.c, M_PI / 2) << "reaches +/- 90 degrees";
  wide.V_ms = table1.V_ms;
  const model::ModelDescription stribeck = load("table1_stribeck.toml");
  ASSERT_EQ(stribeck.effects.size(), 1u);
  EXPECT_EQ(stribeck.effects[0].id, "pump.stribeck");
  EXPECT_TRUE(load("table1.toml").effects.empty());
  for (const model::Parameters& other : {gravity, wide, stribeck.parameters}) {
    model::ModelDescription a, b;
    a.parameters = table1;
    b.parameters = other;
    EXPECT_EQ(FormatModel(a), FormatModel(b));
  }
}

}  // namespace
}  // namespace hydro::settings
