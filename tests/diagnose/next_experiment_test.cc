#include "diagnose/say/next_experiment.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "settings/model_file.h"
#include "settings/stack_config.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using testing::NoisyRig;

model::ModelDescription With(const std::string& id, const std::map<std::string, double>& parameters) {
  model::ModelDescription model;
  model.name = "rival";
  model.parameters = testing::Table1();
  model.effects.push_back({id, parameters, {}});
  return model;
}

RunData Recorded(const model::ModelDescription& model) {
  NoisyRig rig;
  rig.model = model;
  return rig.Record("square", model::Shaft::kClamped, 0, 1, false,
                    [](double t) { return std::fmod(t, 0.5) < 0.25 ? 6.0 : -6.0; });
}

// Tests that an experiment is found for friction of two possible kinds, that it stays within what the rig has
// seen, and that a stack can run it.
TEST(NextExperiment, TellsRivalsApart) {
  const model::ModelDescription drag = With("pump.quadratic_drag", {{"k", 4e-5}});
  const model::ModelDescription pressure = With("pump.pressure_friction", {{"f", 1e-4}});
  const RunData run = Recorded(drag);
  const NextExperiment next = DesignNextExperiment({drag, pressure}, {&run}, "two kinds of friction");
  EXPECT_EQ(next.why, "two kinds of friction");
  EXPECT_GT(next.expected_separation, 1);
  ASSERT_NE(next.config, "");
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "next_experiment";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "model.toml") << settings::FormatModel(drag);
  std::ofstream(folder / "next.toml") << next.config;
  const settings::StackConfig config = settings::LoadStackConfig((folder / "next.toml").string());
  EXPECT_EQ(config.reference.signal, settings::ReferenceSignal::kVoltage);
  EXPECT_EQ(config.time.duration_s, 3);
  const std::unique_ptr<trajectory::Trajectory> voltage =
      settings::MakeTrajectory(config.reference.trajectory);
  EXPECT_LE(voltage->Max(), 6.0);
  EXPECT_GE(voltage->Min(), -6.0);
  EXPECT_GT(voltage->Max(), voltage->Min());
}

// Tests that none is proposed for models that are the same.
TEST(NextExperiment, NoneForOneModel) {
  const model::ModelDescription drag = With("pump.quadratic_drag", {{"k", 4e-5}});
  const RunData run = Recorded(drag);
  const NextExperiment next = DesignNextExperiment({drag, drag}, {&run}, "");
  EXPECT_EQ(next.config, "");
  EXPECT_EQ(next.expected_separation, 0);
}

}  // namespace
}  // namespace hydro::diagnose
