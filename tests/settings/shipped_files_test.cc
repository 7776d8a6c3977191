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
