#include "tune/live/saved_config.h"

#include "settings/stack_config.h"
#include "tests/settings/texts.h"

namespace hydro::tuning {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SavedConfigTest : public settings::FolderTest {
 protected:
  // The file `text` with what is in force after `changes` to a run of it.
  std::string Saved(const std::string& text, const std::string& changes) {
    Write("model.toml", settings::kModelText);
    const std::string file = Write("stack.toml", text);
    const settings::StackConfig config = settings::LoadStackConfig(file);
    run_description_t run{};
    run.config_file = file;
    run.config_text = config.text;
    run.model_file = config.model.resolved_file;
    run.model_text = config.model.text;
    tuned_settings_t in_force{};
    in_force.changes = changes;
    return SavedText(file, "", (folder_ / "saved.toml").string(), run, in_force);
  }
};

// Tests that a value under its former name is replaced by the present one, and that texts with a unit stay
// where their value is still in force.
TEST_F(SavedConfigTest, NamesAndTextsOfTheFile) {
  const std::string text = std::string(settings::kConfigText) +
                           "[limits]\npressure_psi = 2000  # the seals\narm_angle_rad = 0.5\n"
                           "arm_torque = \"50 N m\"  # of the gear\n";
  const std::string saved = Saved(text, "limits.pressure = 1500\n");
  EXPECT_THAT(saved, HasSubstr("\npressure = 1500"));
  EXPECT_THAT(saved, Not(HasSubstr("pressure_psi")));
  EXPECT_THAT(saved, HasSubstr("arm_angle_rad = 0.5"));
  EXPECT_THAT(saved, HasSubstr("arm_torque = \"50 N m\"  # of the gear"));
  Write("saved.toml", saved);
  const settings::StackConfig again = settings::LoadStackConfig((folder_ / "saved.toml").string());
  EXPECT_EQ(again.limits.pressure_psi, 1500);
  EXPECT_EQ(again.limits.arm_angle_rad, 0.5);
}

// Tests that a text whose value has changed gives way to the number in force.
TEST_F(SavedConfigTest, AChangedTextBecomesANumber) {
  const std::string text = std::string(settings::kConfigText) + "[limits]\npressure = \"138 bar\"\n";
  EXPECT_THAT(Saved(text, "limits.pressure = 1500\n"), HasSubstr("pressure = 1500\n"));
  EXPECT_THAT(Saved(text, "position.c2 = 300\n"), HasSubstr("pressure = \"138 bar\"\n"));
}

}  // namespace
}  // namespace hydro::tuning
