#include "batch/study/case_inputs.h"

#include "settings/model_file.h"
#include "settings/stack_config.h"
#include "tests/batch/study_folder.h"

namespace hydro::batch {
namespace {

// Tests that keys of the configuration, of the model's parameters and of effects reach a case's files, and
// that the rest stays.
TEST(CaseInputsTest, SetsKeysOfConfigurationModelAndEffects) {
  const StudyFolder folder;
  const Study study = folder.Read("config = \"" + std::string(HYDRO_CONFIG) + R"(/demo.toml"
[list]
keys = ["position.c1", "time.mode", "model:b", "effect:pump.stribeck.static_excess", "effect:pump.stribeck.speed"]
rows = [[5000, "lockstep", 0.02, 0.5, 3.0]]
)");
  const CaseInputs inputs(study);
  const std::vector<Value> values = study.Values(0);
  const settings::StackConfig config =
      settings::ParseStackConfig(inputs.Config(values), "config.toml", inputs.Model(values), "model.toml");
  EXPECT_EQ(config.position.c1, 5000);
  EXPECT_EQ(config.position.c2, 1200);
  EXPECT_EQ(config.time.mode, settings::TimeMode::kLockstep);
  EXPECT_EQ(config.model.description.parameters.b, 0.02);
  EXPECT_EQ(config.model.description.parameters.T_s, 4.0);
  ASSERT_EQ(config.model.description.effects.size(), 1u);
  EXPECT_EQ(config.model.description.effects[0].id, "pump.stribeck");
  EXPECT_EQ(config.model.description.effects[0].parameters.at("speed"), 3);
}

// Tests that keys of the machine change it alone, over the case's model, and that hydro-sim gets it then.
TEST(CaseInputsTest, TheControllersDoNotKnowTheMachine) {
  const StudyFolder folder;
  const std::string config = "config = \"" + std::string(HYDRO_CONFIG) + "/demo.toml\"\n";
  const Study study = folder.Read(config + R"(
[list]
keys = ["model:b", "machine:D", "machine:pump.stribeck.static_excess", "machine:pump.stribeck.speed"]
rows = [[0.02, 0.009, 0.5, 3.0]]
)");
  const CaseInputs inputs(study);
  const auto model = settings::ParseModel(inputs.Model(study.Values(0)), "model.toml");
  const auto machine = settings::ParseModel(inputs.Machine(study.Values(0)), "machine.toml");
  EXPECT_EQ(model.parameters.b, 0.02);
  EXPECT_EQ(machine.parameters.b, 0.02);
  EXPECT_NE(model.parameters.D, 0.009);
  EXPECT_EQ(machine.parameters.D, 0.009);
  EXPECT_TRUE(model.effects.empty());
  ASSERT_EQ(machine.effects.size(), 1u);
  EXPECT_EQ(machine.effects[0].id, "pump.stribeck");
  EXPECT_THAT(study.steps[0].argv, ::testing::ElementsAre("hydro-sim", "config.toml", "--machine",
                                                          "machine.toml", "-o", "run.lcmlog"));
  const Study known = folder.Read(config + "[[grid]]\nkey = \"model:b\"\nvalues = [0.02]\n");
  EXPECT_EQ(CaseInputs(known).Machine(known.Values(0)), "");
  EXPECT_EQ(known.steps[0].argv.size(), 4u);
}

// Tests that a reference from a CSV file comes along into the study's folder.
TEST(CaseInputsTest, TakesTheReferencesTableAlong) {
  const StudyFolder folder;
  folder.Write("arm.csv", "time_s,arm_rad\n0,0\n1,0.1\n");
  folder.Write("model.toml", ReadTextFile(std::string(HYDRO_CONFIG) + "/models/table1.toml"));
  folder.Write(
      "stack.toml",
      "[model]\nfile = \"model.toml\"\n[time]\nduration_s = 1.0\n[pressure]\nnatural_frequency_rad_s = "
      "150.0\n"
      "damping_ratio = 0.5\n[position]\nsample_interval_s = 0.005\nc1 = 6000.0\nc2 = 1200.0\n[reference]\n"
      "signal = \"arm_angle\"\nkind = \"csv\"\nfile = \"arm.csv\"\ncolumn = \"arm_rad\"\n");
  const std::string text =
      "config = \"stack.toml\"\n[[grid]]\nkey = \"position.c1\"\nvalues = [1000, 2000]\n";
  const Study study = folder.Read(text);
  std::filesystem::create_directories(folder / "out/inputs");
  for (const auto& [name, content] : study.files) folder.Write("out/" + name, content);
  const Study again = ReadStudy(folder / "out/study.toml");
  EXPECT_EQ(again.files, study.files);
  folder.Write("out/config.toml", CaseInputs(again).Config(again.Values(1)));
  EXPECT_EQ(settings::LoadStackConfig(folder / "out/config.toml").reference.trajectory.points.size(), 2u);
}

// Tests that the same case has the same files, byte by byte, when the study is read from its folder again.
TEST(CaseInputsTest, SurvivesTheFolder) {
  const StudyFolder folder;
  const Study study = folder.Read(
      "config = \"" + std::string(HYDRO_CONFIG) +
      "/demo.toml\"\n[[grid]]\nkey = \"model:b\"\nvalues = [0.01, 0.02]\n"
      "[collect]\na = { from = \"x.json:/a\" }\nb = \"x.json:/b\"\nc = { from = \"x.json:/c\" }\n");
  for (const auto& [name, text] : study.files) folder.Write(name, text);
  const Study again = ReadStudy(folder / "study.toml");
  EXPECT_EQ(again.files, study.files);
  for (const Study& each : {study, again}) {
    ASSERT_EQ(each.collect.size(), 3u);
    EXPECT_EQ(each.collect[0].name + each.collect[1].name + each.collect[2].name, "abc");
  }
  EXPECT_EQ(CaseInputs(again).Config(again.Values(1)), CaseInputs(study).Config(study.Values(1)));
  EXPECT_EQ(CaseInputs(again).Model(again.Values(1)), CaseInputs(study).Model(study.Values(1)));
}

}  // namespace
}  // namespace hydro::batch
