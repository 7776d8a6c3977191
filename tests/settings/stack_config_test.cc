#include "settings/stack_config.h"

#include <cmath>

#include "base/read_files.h"
#include "settings/process_sections.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::HasSubstr;

constexpr double kInf = std::numeric_limits<double>::infinity();

// Tests the defaults and what follows from the rates.
TEST(StackConfigTest, DefaultsAndTicks) {
  const StackConfig config = Parsed(kConfigText);
  EXPECT_EQ(config.file, "stack.toml");
  EXPECT_EQ(config.model.resolved_file, "model.toml");
  EXPECT_EQ(config.model.text, kModelText);
  EXPECT_EQ(config.model.description.name, "Table 1");
  EXPECT_EQ(config.model.shaft, model::Shaft::kFree);
  EXPECT_TRUE(std::isnan(config.model.initial_pressure_psi));
  EXPECT_EQ(config.time.mode, TimeMode::kRealtime);
  EXPECT_EQ(config.pressure.rate_hz, 0.0);
  EXPECT_FALSE(config.position.derivative_on_error);
  EXPECT_EQ(config.limits.motor_speed_rad_s, kInf);
  EXPECT_EQ(config.limits.stale_input_s, 0.1);
  EXPECT_EQ(config.limits.pressure_ramp_s, 0.2);
  EXPECT_EQ(config.limits.rearm, Rearm::kRestart);
  EXPECT_DOUBLE_EQ(config.limits.arm_angle_rad, 0.98 * 3.16 / (1.83 * 1.83 * 2.20 / 2));
  EXPECT_EQ(config.seed, 1);
  EXPECT_EQ(config.position_interval_ticks, 5);
  EXPECT_EQ(config.pressure_interval_ticks, 1);
  EXPECT_EQ(config.last_tick, -1);
  ASSERT_EQ(config.processes.size(), 3u);
  EXPECT_EQ(config.processes[0].program, "hydro-plant");
  EXPECT_EQ(config.processes[2].program, "hydro-position-ctrl");
  EXPECT_EQ(config.processes[2].cpu, -1);
  EXPECT_FALSE(config.processes[2].lock_memory);
  EXPECT_EQ(config.logger.memory_mb, 64);
}

const char kEveryStackKey[] = R"(
[model]
file = "models/m.toml"
shaft = "driven"
bypass = true
initial_pressure = 120
[model.motion]
kind = "chirp"
offset = 0.1
amplitude = 0.2
first_frequency_hz = 0.3
last_frequency_hz = 4
duration_s = 5
start_s = 0.6
[bus]
url = "udpm://239.255.76.68:7668?ttl=1"
channel_suffix = "_LEFT"
key_file = "keys/stack.key"
[time]
mode = "lockstep"
speed = 2
duration_s = 12.5
start_timeout_s = 3
stall_timeout_s = 1
[plant]
rate_hz = 5000
command_delay_ticks = 0
integrator = "cvode"
relative_tolerance = 1e-6
[pressure]
rate_hz = 1000
k_p = 0.1336
k_v = 8.39
compressed_sides = 1
reference_feedforward = 0.002
arm_speed_feedforward = true
[position]
sample_interval_s = 0.002
c1 = 1
c2 = 2
derivative = "error"
dac_bits = 12
dac_range = 1500
[reference]
signal = "torque"
kind = "square"
offset = 1
amplitude = 2
frequency_hz = 3
start_s = 4
[limits]
pressure = 1800
motor_speed = 600
arm_torque = 7000
stale_input_s = 0.05
pressure_ramp_s = 0.3
stale_logger_s = 2
stale_supervisor_s = 3
return_s = 0.7
arm_angle = 0.7
rearm = "explicit"
[noise]
p1 = 1
p2 = 2
motor_angle = 3
motor_speed = 4
arm_angle = 5
arm_speed = 6
p1_resolution = 0.1
p2_resolution = 0.2
motor_angle_resolution = 0.3
motor_speed_resolution = 0.4
arm_angle_resolution = 0.5
arm_speed_resolution = 0.6
seed = 7
[logger]
memory_mb = 12.5
required = false
[[process]]
program = "hydro-driver"
host = "rig"
cpu = 2
priority = 80
[[process]]
program = "hydro-logger"
lock_memory = true
[[process]]
program = "hydro-pressure-ctrl"
priority = 1
lock_memory = false
)";

// Tests that every key reaches its field.
TEST(StackConfigTest, ReadsEveryKey) {
  const StackConfig config = Parsed(kEveryStackKey);
  EXPECT_EQ(config.model.file, "models/m.toml");
  EXPECT_EQ(config.model.shaft, model::Shaft::kDriven);
  EXPECT_TRUE(config.model.bypass);
  EXPECT_EQ(config.model.initial_pressure_psi, 120);
  ASSERT_TRUE(config.model.motion);
  EXPECT_EQ(config.model.motion->kind, TrajectorySpec::Kind::kChirp);
  EXPECT_EQ(config.model.motion->offset, 0.1);
  EXPECT_EQ(config.model.motion->amplitude, 0.2);
  EXPECT_EQ(config.model.motion->first_frequency_hz, 0.3);
  EXPECT_EQ(config.model.motion->last_frequency_hz, 4);
  EXPECT_EQ(config.model.motion->duration_s, 5);
  EXPECT_EQ(config.model.motion->start_s, 0.6);
  EXPECT_EQ(config.bus.url, "udpm://239.255.76.68:7668?ttl=1");
  EXPECT_EQ(config.bus.channel_suffix, "_LEFT");
  EXPECT_EQ(config.bus.key_file, "keys/stack.key");
  EXPECT_EQ(config.time.mode, TimeMode::kLockstep);
  EXPECT_EQ(config.time.speed, 2);
  EXPECT_EQ(config.time.duration_s, 12.5);
  EXPECT_EQ(config.time.start_timeout_s, 3);
  EXPECT_EQ(config.time.stall_timeout_s, 1);
  EXPECT_EQ(config.plant.rate_hz, 5000);
  EXPECT_EQ(config.plant.command_delay_ticks, 0);
  EXPECT_EQ(config.plant.integrator, model::Integrator::kCvode);
  EXPECT_EQ(config.plant.relative_tolerance, 1e-6);
  EXPECT_EQ(config.pressure.rate_hz, 1000);
  EXPECT_EQ(config.pressure.k_p, 0.1336);
  EXPECT_EQ(config.pressure.k_v, 8.39);
  EXPECT_EQ(config.pressure.compressed_sides, 1);
  EXPECT_TRUE(config.pressure.reference_feedforward);
  EXPECT_EQ(config.pressure.reference_feedforward_V_psi, 0.002);
  EXPECT_TRUE(config.pressure.arm_speed_feedforward);
  EXPECT_EQ(config.position.sample_interval_s, 0.002);
  EXPECT_EQ(config.position.c1, 1);
  EXPECT_EQ(config.position.c2, 2);
  EXPECT_TRUE(config.position.derivative_on_error);
  EXPECT_EQ(config.position.dac_bits, 12);
  EXPECT_EQ(config.position.dac_range_psi, 1500);
  EXPECT_EQ(config.reference.signal, ReferenceSignal::kTorque);
  EXPECT_EQ(config.reference.trajectory.kind, TrajectorySpec::Kind::kSquare);
  EXPECT_EQ(config.reference.trajectory.amplitude, 2);
  EXPECT_EQ(config.reference.trajectory.frequency_hz, 3);
  EXPECT_EQ(config.limits.pressure_psi, 1800);
  EXPECT_EQ(config.limits.motor_speed_rad_s, 600);
  EXPECT_EQ(config.limits.arm_torque_in_lbf, 7000);
  EXPECT_EQ(config.limits.stale_input_s, 0.05);
  EXPECT_EQ(config.limits.pressure_ramp_s, 0.3);
  EXPECT_EQ(config.limits.stale_logger_s, 2);
  EXPECT_EQ(config.limits.stale_supervisor_s, 3);
  EXPECT_EQ(config.limits.return_s, 0.7);
  EXPECT_EQ(config.limits.arm_angle_rad, 0.7);
  EXPECT_EQ(config.limits.rearm, Rearm::kExplicit);
  EXPECT_EQ(config.noise.p1_psi, 1);
  EXPECT_EQ(config.noise.p2_psi, 2);
  EXPECT_EQ(config.noise.motor_angle_rad, 3);
  EXPECT_EQ(config.noise.motor_speed_rad_s, 4);
  EXPECT_EQ(config.noise.arm_angle_rad, 5);
  EXPECT_EQ(config.noise.arm_speed_rad_s, 6);
  EXPECT_EQ(config.noise.p1_resolution_psi, 0.1);
  EXPECT_EQ(config.noise.p2_resolution_psi, 0.2);
  EXPECT_EQ(config.noise.motor_angle_resolution_rad, 0.3);
  EXPECT_EQ(config.noise.motor_speed_resolution_rad_s, 0.4);
  EXPECT_EQ(config.noise.arm_angle_resolution_rad, 0.5);
  EXPECT_EQ(config.noise.arm_speed_resolution_rad_s, 0.6);
  EXPECT_EQ(config.seed, 7);
  EXPECT_EQ(config.logger.memory_mb, 12.5);
  EXPECT_FALSE(config.logger.required);
  ASSERT_EQ(config.processes.size(), 3u);
  EXPECT_EQ(config.processes[0].program, "hydro-driver");
  EXPECT_EQ(config.processes[0].host, "rig");
  EXPECT_EQ(config.processes[0].cpu, 2);
  EXPECT_EQ(config.processes[0].priority, 80);
  EXPECT_TRUE(config.processes[0].lock_memory);  // by its priority
  EXPECT_EQ(config.processes[1].program, "hydro-logger");
  EXPECT_TRUE(config.processes[1].lock_memory);
  EXPECT_FALSE(config.processes[2].lock_memory);
  EXPECT_EQ(config.position_interval_ticks, 10);
  EXPECT_EQ(config.pressure_interval_ticks, 5);
  EXPECT_EQ(config.last_tick, 62500);
}

// Tests a controller of the user's own: what is read, that the text keeps it, and what takes its place
// without processes.
TEST(StackConfigTest, ProgramOfTheUsersOwn) {
  const StackConfig config = Parsed(std::string(kConfigText) +
                                    "\n[[process]]\nprogram = \"hydro-plant\"\n[[process]]\ncommand = "
                                    "[\"./pid.py\", \"a b\"]\nrole = \"position_ctrl\"\nhost = \"desk\"\n");
  ASSERT_EQ(config.processes.size(), 2u);
  EXPECT_EQ(config.processes[0].role, "plant");
  EXPECT_EQ(config.processes[1].command, (std::vector<std::string>{"./pid.py", "a b"}));
  EXPECT_EQ(config.processes[1].program, "");
  EXPECT_EQ(NameOf(config.processes[1]), "./pid.py a b (position_ctrl)");
  EXPECT_EQ(OwnProgramFor(config, "position_ctrl"), &config.processes[1]);
  EXPECT_EQ(OwnProgramFor(config, "pressure_ctrl"), nullptr);
  EXPECT_EQ(Parsed(config.text).processes[1].command, config.processes[1].command);

  const StackConfig ours = WithoutOwnPrograms(config);
  ASSERT_EQ(ours.processes.size(), 2u);
  EXPECT_EQ(ours.processes[1].program, "hydro-position-ctrl");
  EXPECT_EQ(ours.processes[1].host, "desk");
  EXPECT_EQ(ours.text.find("pid.py"), std::string::npos);
  EXPECT_EQ(ours.agreed, config.agreed);
  EXPECT_EQ(WithoutOwnPrograms(ours).text, ours.text);
}

// Tests that the effective text gives the same configuration, and itself, again.
TEST(StackConfigTest, EffectiveTextIsAFixedPoint) {
  for (const char* text : {kConfigText, kEveryStackKey}) {
    const StackConfig config = Parsed(text);
    const StackConfig again = Parsed(config.text);
    EXPECT_EQ(again.text, config.text);
    EXPECT_EQ(again.last_tick, config.last_tick);
    EXPECT_EQ(again.pressure.k_p, config.pressure.k_p);
    EXPECT_EQ(again.reference.trajectory.steps.size(), config.reference.trajectory.steps.size());
    EXPECT_EQ(again.model.motion.has_value(), config.model.motion.has_value());
    EXPECT_EQ(again.processes.size(), config.processes.size());
    EXPECT_EQ(again.seed, config.seed);
  }
}

// Tests the other values that some keys take.
TEST(StackConfigTest, OtherValues) {
  EXPECT_TRUE(Parsed(Replaced(kConfigText, "[pressure]", "[pressure]\nreference_feedforward = true"))
                  .pressure.reference_feedforward);
  EXPECT_FALSE(Parsed(Replaced(kConfigText, "[pressure]", "[pressure]\nreference_feedforward = true"))
                   .pressure.reference_feedforward_V_psi);
  EXPECT_EQ(
      Parsed(Replaced(kConfigText, "[pressure]", "[pressure]\nrate_hz = \"every_tick\"")).pressure.rate_hz,
      0);
  EXPECT_EQ(Parsed(std::string(kConfigText) + "[limits]\npressure_psi = inf\n").limits.pressure_psi, kInf);
  EXPECT_EQ(Parsed(std::string(kConfigText) + "[limits]\narm_angle_rad = inf\n").limits.arm_angle_rad, kInf);
  EXPECT_EQ(Parsed(Replaced(kConfigText, "[model]", "[model]\nshaft = \"clamped\"")).limits.arm_angle_rad,
            kInf);
  EXPECT_TRUE(Parsed(std::string("process = []\n") + kConfigText).processes.empty());
}

// Tests that a rate that is no whole number of hertz still has whole intervals.
TEST(StackConfigTest, TicksThatAreNotDecimal) {
  const std::string text = Replaced(kConfigText, "rate_hz = 1000", "rate_hz = 3000");
  EXPECT_EQ(Parsed(Replaced(text, "[position]", "[position]\nsample_interval_s = 0.333333333333"))
                .position_interval_ticks,
            1000);
}

using StackConfigFolderTest = FolderTest;

// Tests that the model and the trajectory are found beside the configuration, wherever the program was
// started.
TEST_F(StackConfigFolderTest, PathsAreRelativeToTheConfiguration) {
  Write("models/table1.toml", kModelText);
  Write("runs/square.csv", "time_s,value\n0,0\n1,0.2\n2,-0.1\n");
  const std::string file =
      Write("stack/a.toml", Replaced(Replaced(kConfigText, "\"model.toml\"", "\"../models/table1.toml\""),
                                     "kind = \"steps\"\nsteps = [[0.1, 0.1]]",
                                     "kind = \"csv\"\nfile = \"../runs/square.csv\"\n"
                                     "column = \"value\"\ninterpolation = \"cubic\""));
  const StackConfig config = LoadStackConfig(file, {"bus.key_file=../keys/stack.key"});
  EXPECT_EQ(config.model.resolved_file, (folder_ / "models/table1.toml").string());
  EXPECT_EQ(config.bus.resolved_key_file, (folder_ / "keys/stack.key").string());
  EXPECT_EQ(config.model.text, kModelText);
  ASSERT_EQ(config.reference.trajectory.points.size(), 3u);
  EXPECT_EQ(config.reference.trajectory.points[1].value, 0.2);
  EXPECT_EQ(config.reference.trajectory.interpolation, trajectory::Interpolation::kCubic);
  EXPECT_EQ(MakeTrajectory(config.reference.trajectory)->Value(1), 0.2);

  // A log has only the texts.
  std::filesystem::remove_all(folder_ / "runs");
  const StackConfig again = ParseStackConfig(config.text, "log.lcmlog", config.model.text, "log.lcmlog");
  ASSERT_EQ(again.reference.trajectory.points.size(), 3u);
  EXPECT_EQ(again.reference.trajectory.points[2].time, 2.0);
  EXPECT_EQ(again.reference.trajectory.points[2].value, -0.1);
  EXPECT_EQ(again.reference.trajectory.interpolation, trajectory::Interpolation::kCubic);
  EXPECT_EQ(again.text, config.text);
}

// Tests that nothing overwrites a configuration, its model, its key or the trajectories that it names.
TEST_F(StackConfigFolderTest, KeepsItsFiles) {
  const std::string file = Write("a.toml", kConfigText);
  const std::string model = Write("model.toml", kModelText);
  const std::string key = Write("a.key", "");
  const std::string reference = Write("reference.csv", "time_s,y\n0,0\n1,0.1\n");
  const std::string motion = Write("motion.csv", "time_s,y\n0,0\n1,0.1\n");
  const StackConfig config = LoadStackConfig(
      file, {"bus.key_file=a.key", "reference={ kind = \"csv\", file = \"reference.csv\", column = \"y\" }",
             "model.shaft=driven", "model.motion={ kind = \"csv\", file = \"motion.csv\", column = \"y\" }"});
  for (const std::string& input : {file, model, key, reference, motion}) {
    EXPECT_THAT(InputErrorOf([&] { CheckKeeps(input); }), HasSubstr(input)) << input;
  }
  EXPECT_EQ(InputErrorOf([&] { CheckKeeps(Write("log", "")); }), "");
}

// Tests that errors in files named by a configuration say which file.
TEST_F(StackConfigFolderTest, NamesTheFileThatIsWrong) {
  const std::string file = Write("a.toml", kConfigText);
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig(file); }),
              HasSubstr("a.toml:2: model.file: found \"model.toml\", and there is no \""));
  Write("model.toml", Replaced(kModelText, "k_1 = 4.0", "k_1 = -4.0"));
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig(file); }),
              HasSubstr("model.toml:3: parameters.k_1: found -4"));
  Write("model.toml", kModelText);
  EXPECT_EQ(InputErrorOf([&] { LoadStackConfig(file); }), "");
  Write("p.csv", "time_s,y\n0,zero\n");
  const std::vector<std::string> csv = {"reference.kind=csv", "reference.file=p.csv", "reference.column=y"};
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig(file, csv); }),
              HasSubstr("p.csv: line 2, column y: found \"zero\", allowed"));
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig((folder_ / "no.toml").string()); }),
              HasSubstr("no.toml: cannot be read: No such file or directory"));
  const std::string no_model = Write("b.toml", Replaced(kConfigText, "file = \"model.toml\"\n", ""));
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig(no_model); }),
              HasSubstr("b.toml:1: model.file: found nothing, allowed the path of a model file"));
}

// Tests that mistakes of a first day are answered with what is meant: a model as CONFIG, a model that is not
// there, a key without its section.
TEST_F(StackConfigFolderTest, MistakesOfAFirstDay) {
  const std::string model = Write("model.toml", kModelText), config = Write("stack.toml", kConfigText);
  EXPECT_THAT(
      InputErrorOf([&] { LoadStackConfig(model); }),
      ::testing::AllOf(HasSubstr("found a model ([parameters]), allowed the configuration of a stack"),
                       HasSubstr("[model] file = ")));
  EXPECT_THAT(
      InputErrorOf([&] { LoadStackConfig(config, {"model.file=mdoel.toml"}); }),
      ::testing::AllOf(HasSubstr("model.file: found \"mdoel.toml\", and there is no \"" + folder_.string()),
                       HasSubstr("allowed a path that counts from the configuration's folder")));
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig(config, {"rate_hz=2000"}); }),
              HasSubstr("did you mean \"plant.rate_hz\" or \"pressure.rate_hz\"?"));
  EXPECT_THAT(InputErrorOf([&] { LoadStackConfig(config, {"c2=5"}); }),
              HasSubstr("did you mean \"position.c2\"?"));
}

}  // namespace
}  // namespace hydro::settings
