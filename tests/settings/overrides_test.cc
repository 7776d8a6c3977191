#include "settings/overrides.h"

#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class OverridesTest : public FolderTest {
 protected:
  OverridesTest() : config_(Write("a.toml", kConfigText)) { Write("model.toml", kModelText); }

  StackConfig Load(const std::vector<std::string>& overrides) const {
    return LoadStackConfig(config_, overrides);
  }
  std::string ErrorOf(const std::vector<std::string>& overrides) const {
    return InputErrorOf([&] { Load(overrides); });
  }

  std::string config_;
};

// Tests that values are TOML, or else bare words.
TEST_F(OverridesTest, ValuesAreTomlOrBareWords) {
  const StackConfig config =
      Load({"time.mode=lockstep", "time.duration_s=2", "plant.integrator=\"erk\"",
            "bus.url=udpm://239.255.76.67:7700?ttl=0", "pressure.arm_speed_feedforward=true",
            "reference.steps=[[0.5, 0.2], [1, 0]]", "noise.p1 = 1.5", "position.c1=1_000"});
  EXPECT_EQ(config.time.mode, TimeMode::kLockstep);
  EXPECT_EQ(config.last_tick, 2000);
  EXPECT_EQ(config.plant.integrator, model::Integrator::kErk);
  EXPECT_EQ(config.bus.url, "udpm://239.255.76.67:7700?ttl=0");
  EXPECT_TRUE(config.pressure.arm_speed_feedforward);
  ASSERT_EQ(config.reference.trajectory.steps.size(), 2u);
  EXPECT_EQ(config.reference.trajectory.steps[1].time, 1.0);
  EXPECT_EQ(config.noise.p1_psi, 1.5);
  EXPECT_EQ(config.position.c1, 1000);
}

// Tests that the last of several values for one key wins, and that the effective text has it.
TEST_F(OverridesTest, LastOneHolds) {
  const StackConfig config = Load({"position.c1=1", "position.c1=2"});
  EXPECT_EQ(config.position.c1, 2);
  EXPECT_EQ(Parsed(config.text).position.c1, 2);
}

// Tests that nested sections, whole sections and lists of sections can be given.
TEST_F(OverridesTest, NestedAndWholeSections) {
  const StackConfig config =
      Load({"model.shaft=driven", "model.motion.kind=sine", "model.motion.amplitude=0.25",
            "reference={ signal = \"pressure\", kind = \"sine\", amplitude = 300 }",
            "process=[{ program = \"hydro-plant\", cpu = 1 }]"});
  ASSERT_TRUE(config.model.motion);
  EXPECT_EQ(config.model.motion->amplitude, 0.25);
  EXPECT_EQ(config.reference.signal, ReferenceSignal::kPressure);
  EXPECT_EQ(config.reference.trajectory.amplitude, 300);
  ASSERT_EQ(config.processes.size(), 1u);
  EXPECT_EQ(config.processes[0].cpu, 1);
}

// Tests that choosing an alternative by option drops the file's setting for the other.
TEST_F(OverridesTest, ChosenAlternativeDropsTheOther) {
  EXPECT_EQ(Load({"reference.kind=sine", "reference.amplitude=0.1"}).reference.trajectory.amplitude, 0.1);
  const StackConfig gains = Load({"pressure.k_p=0.2", "pressure.k_v=5"});
  EXPECT_EQ(gains.pressure.k_p, 0.2);
  EXPECT_FALSE(gains.pressure.natural_frequency_rad_s);
  const std::string driven =
      Write("driven.toml",
            Replaced(kConfigText, "[plant]", "shaft = \"driven\"\n[model.motion]\nkind = \"sine\"\n[plant]"));
  EXPECT_FALSE(LoadStackConfig(driven, {"model.shaft=clamped", "model.arm_angle=0.1"}).model.motion);
}

// Tests that contradictions within the file, or among options, remain errors.
TEST_F(OverridesTest, OtherContradictionsStayErrors) {
  EXPECT_THAT(
      ErrorOf({"reference.amplitude=1"}),
      AllOf(HasSubstr("--set reference.amplitude=1: reference: \"amplitude\": found an unknown key")));
  EXPECT_THAT(ErrorOf({"reference.kind=sine", "reference.steps=[[0,1]]"}),
              HasSubstr("--set reference.steps=[[0,1]]: reference: \"steps\": found an unknown key"));
  EXPECT_THAT(ErrorOf({"pressure.k_p=0.2"}),
              HasSubstr("--set pressure.k_p=0.2: pressure.k_p: found k_p without k_v"));
  EXPECT_THAT(ErrorOf({"pressure.k_p=0.2", "pressure.damping_ratio=1"}), HasSubstr("found it beside"));
  EXPECT_THAT(ErrorOf({"model.shaft=free", "model.motion.kind=sine"}),
              HasSubstr("a shaft that is not driven"));
}

// Tests that errors in options name the option, what was found and what is allowed.
TEST_F(OverridesTest, ErrorsNameTheOption) {
  const struct {
    const char* option;
    const char* says;
  } options[] = {
      {"time.mode", "--set time.mode: found \"time.mode\", allowed section.key=value"},
      {"", "--set : found \"\", allowed section.key=value"},
      {"=1", "--set =1: found \"=1\", allowed section.key=value"},
      {"time..mode=1", "--set time..mode=1: found \"time..mode\", allowed section.key=value"},
      {".mode=1", "--set .mode=1: found \".mode\", allowed"},
      {"time.mode.=1", "allowed section.key=value"},
      {"time.mode=fast",
       "--set time.mode=fast: time.mode: found \"fast\", allowed \"realtime\" or \"lockstep\""},
      {"time.mod=lockstep",
       "--set time.mod=lockstep: time: \"mod\": found an unknown key, allowed \"mode\", "},
      {"time.mod=lockstep", "did you mean \"mode\"?"},
      {"tme.mode=lockstep", "--set tme.mode=lockstep: \"tme\": found an unknown key, allowed \"model\""},
      {"plant=5", "--set plant=5: plant: found 5, allowed a section [plant]"},
      {"plant.rate_hz.x=5", "plant.rate_hz: found 1000 at "},
      {"plant.rate_hz=", "--set plant.rate_hz=: plant.rate_hz: found \"\", allowed a finite number"},
      {"plant.rate_hz=fast", "plant.rate_hz: found \"fast\", allowed a finite number"},
      {"plant.rate_hz=1\ntime.speed=2",
       "--set plant.rate_hz=1\\ntime.speed=2: plant.rate_hz: found \"1\\ntime.speed=2\""},
      {"reference.steps=[[0, 0.1]", "reference.steps: found \"[[0, 0.1]\", allowed an array"},
      {"reference.steps=[[0, 2]]", "found arm angle 2 rad"},
      {"model.file=none.toml", "model.file: found \"none.toml\", and there is no"},
      {"process.cpu=1", "process"},
  };
  for (const auto& option : options) {
    const std::string error = ErrorOf({option.option});
    EXPECT_THAT(error, HasSubstr(option.says));
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace hydro::settings
