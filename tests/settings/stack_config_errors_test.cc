#include "settings/stack_config.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Malformed {
  std::string text;
  std::string place;  // file and line, as the message begins
  std::string says;   // key, what was found, what is allowed
};

std::string Extended(const std::string& more) { return std::string(kConfigText) + more; }
std::string ChangedConfig(const std::string& from, const std::string& to) {
  return Replaced(kConfigText, from, to);
}
std::string InSection(const std::string& section, const std::string& line) {
  return ChangedConfig("[" + section + "]\n", "[" + section + "]\n" + line + "\n");
}
// A reference of its own in place of the one in kConfigText; its section begins in line 11.
std::string Reference(const std::string& keys) {
  return ChangedConfig("kind = \"steps\"\nsteps = [[0.1, 0.1]]\n", keys);
}
std::string Driven(const std::string& motion, const std::string& more = "") {
  return ChangedConfig("file = \"model.toml\"\n",
                       "shaft = \"driven\"\n" + more + "[model.motion]\n" + motion + "\n");
}

const std::vector<Malformed>& Table() {
  static const std::vector<Malformed> table = {
      // Syntax.
      {"[model\n", "stack.toml:1: ", "syntax: "},
      {ChangedConfig("c1 = 10500", "c1 = "), "stack.toml:9: ", "syntax: "},
      {ChangedConfig("c1 = 10500", "c1 = 1\nc1 = 2"), "stack.toml:10: ", "syntax: "},
      {Extended("[position]\n"), "stack.toml:15: ", "syntax: "},
      {Extended("x = \"\xff\"\n"), "stack.toml:15: ", "syntax: "},
      // Unknown sections and keys.
      {Extended("[pressur]\n"),
       "stack.toml:15: ", "\"pressur\": found an unknown key, allowed \"model\", \"bus\""},
      {Extended("[pressur]\n"), "stack.toml:15: ", "did you mean \"pressure\"?"},
      {"rate_hz = 5\n" + Extended(""), "stack.toml:1: ", "\"rate_hz\": found an unknown key"},
      {InSection("pressure", "kp = 1"),
       "stack.toml:6: ", "pressure: \"kp\": found an unknown key, allowed \"rate_hz\", \"k_p\""},
      {InSection("pressure", "kp = 1"), "stack.toml:6: ", "did you mean \"k_p\"?"},
      {InSection("plant", "rate = 1"), "stack.toml:4: ", "plant: \"rate\": found an unknown key"},
      {InSection("position", "\"a\\nb\" = 1"), "stack.toml:9: ", "position: \"a\\nb\": found an unknown key"},
      {Extended("[bus]\nurl = 5\n"), "stack.toml:16: ", "bus.url: found 5, allowed a string"},
      {"bus = 5\n" + Extended(""), "stack.toml:1: ", "bus: found 5, allowed a section [bus]"},
      {Extended("[[limits]]\n"), "stack.toml:15: ", "limits: found an array, allowed a section [limits]"},
      // [model]
      {InSection("model", "shaft = \"fixed\""),
       "stack.toml:2: ", "model.shaft: found \"fixed\", allowed \"free\", \"clamped\" or \"driven\""},
      {InSection("model", "shaft = 1"), "stack.toml:2: ", "model.shaft: found 1, allowed"},
      {InSection("model", "bypass = 1"), "stack.toml:2: ", "model.bypass: found 1, allowed true or false"},
      {InSection("model", "arm_angle = \"0\""), "stack.toml:2: ",
       "model.arm_angle: found \"0\", allowed a number (in rad), or a text of a number and a unit: rad, deg, "
       "rev"},
      {InSection("model", "arm_angle = nan"), "stack.toml:2: ", "model.arm_angle: found nan"},
      {InSection("model", "arm_angle = 1.5707963267948966"),
       "stack.toml:2: ", "model.arm_angle: found arm angle 1.5707963267948966 rad (90 deg), allowed |alpha|"},
      {InSection("model", "arm_angle = 1.6"), "stack.toml:2: ", "0.84"},
      {InSection("model", "arm_angle = -1.6"), "stack.toml:2: ", "found arm angle -1.6 rad (-91.67 deg)"},
      {InSection("model", "initial_pressure = 50"),
       "stack.toml:2: ", "model.initial_pressure: found 50 psi, allowed at least p_3 = 100 psi"},
      {InSection("model", "initial_pressure = 2500"),
       "stack.toml: ", "limits.pressure: found 2000 psi, allowed above 2500 psi"},
      {ChangedConfig("file = \"model.toml\"", "file = 3"),
       "stack.toml:2: ", "model.file: found 3, allowed a string"},
      {ChangedConfig("file = \"model.toml\"", "file = \"a\\u0000b\""),
       "stack.toml:2: ", "allowed a string without NUL"},
      {InSection("model", "shaft = \"driven\""),
       "stack.toml:2: ", "model.shaft: found \"driven\" without [model.motion]"},
      {Driven("kind = \"square\"\namplitude = 0.1"),
       "stack.toml:3: ", "model.motion: found a motion that jumps, allowed a continuous motion"},
      {Driven("kind = \"steps\"\nsteps = [[0, 0.1]]"),
       "stack.toml:3: ", "model.motion: found a motion that jumps"},
      {Driven("kind = \"sine\"\namplitude = 0.1\nphase_rad = 1"), "stack.toml:3: ", "a motion that jumps"},
      {Driven("kind = \"csv\"\npoints = [[0, 0], [1, 0.1]]\ninterpolation = \"hold\""),
       "stack.toml:3: ", "a motion that jumps"},
      {Driven("kind = \"sine\"\namplitude = 0.9"),
       "stack.toml:5: ", "model.motion.amplitude: found arm angle 0.9 rad (51.57 deg)"},
      {Driven("kind = \"csv\"\npoints = [[0, 0], [1, -0.9]]"),
       "stack.toml:5: ", "model.motion.points: found arm angle -0.9 rad (-51.57 deg)"},
      {Driven("kind = \"sine\"\namplitude = 0.1\nsignal = \"arm_angle\""),
       "stack.toml:6: ", "model.motion: \"signal\": found an unknown key"},
      {Driven("kind = \"sin\""),
       "stack.toml:4: ", "model.motion.kind: found \"sin\", allowed \"steps\", \"sine\""},
      {Driven("kind = \"sine\"", "arm_angle = 0\n"),
       "stack.toml:3: ", "model.arm_angle: found it with a driven shaft"},
      {Extended("[model.motion]\nkind = \"sine\"\n"),
       "stack.toml:15: ", "model.motion: found it with a shaft that is not driven"},
      // [bus]
      {Extended("[bus]\nurl = \"udpm://1.2.3.4:7667\"\n"),
       "stack.toml:16: ", "bus.url: found \"udpm://1.2.3.4:7667\", allowed udpm://GROUP:PORT"},
      {Extended("[bus]\nchannel_suffix = \"a b\"\n"),
       "stack.toml:16: ", "bus.channel_suffix: found \"a b\", allowed up to 32 letters"},
      {Extended("[bus]\nchannel_suffix = \"" + std::string(33, 'x') + "\"\n"),
       "stack.toml:16: ", "allowed up to 32 letters"},
      // [time]
      {Extended("[time]\nmode = \"fast\"\n"),
       "stack.toml:16: ", "time.mode: found \"fast\", allowed \"realtime\" or \"lockstep\""},
      {Extended("[time]\nspeed = 0\n"),
       "stack.toml:16: ", "time.speed: found 0, allowed a finite number of at least 0.001 and at most 1000"},
      {Extended("[time]\nspeed = 0.001\n"), "stack.toml: ",
       "limits.stale_input_s: found 0.1 s, allowed above 1 s, in which one state follows another"},
      {Extended("[time]\nspeed = inf\n"), "stack.toml:16: ", "time.speed: found inf"},
      {Extended("[time]\nduration_s = -1\n"),
       "stack.toml:16: ", "time.duration_s: found -1, allowed a finite number of at least 0"},
      {Extended("[time]\nduration_s = 1.00005\n"),
       "stack.toml:16: ", "time.duration_s: found 1.00005 s, allowed a whole number of ticks of 0.001 s"},
      {Extended("[time]\nduration_s = 1e-5\n"), "stack.toml:16: ", "time.duration_s: found 1e-05 s"},
      {Extended("[time]\nduration_s = 1e300\n"), "stack.toml:16: ", "time.duration_s: found 1e+300 s"},
      {Extended("[time]\nstart_timeout_s = 0\n"), "stack.toml:16: ", "time.start_timeout_s: found 0"},
      {Extended("[time]\nstall_timeout_s = 2\n"),
       "stack.toml:16: ", "time.stall_timeout_s: found 2, allowed a finite number above 0 and below 2"},
      {Extended("[time]\nstall_timeout_s = 0\n"), "stack.toml:16: ", "time.stall_timeout_s: found 0"},
      // [plant]
      {ChangedConfig("rate_hz = 1000", "rate_hz = 0"),
       "stack.toml:4: ", "plant.rate_hz: found 0, allowed a finite number above 0 and at most 1000000"},
      {ChangedConfig("rate_hz = 1000", "rate_hz = -1000"), "stack.toml:4: ", "plant.rate_hz: found -1000"},
      {ChangedConfig("rate_hz = 1000", "rate_hz = 1e7"), "stack.toml:4: ", "plant.rate_hz: found 10000000"},
      {InSection("plant", "command_delay_ticks = 2"), "stack.toml:4: ",
       "plant.command_delay_ticks: found 2, allowed a whole number of at least 0 and at most 1"},
      {InSection("plant", "command_delay_ticks = 0.5"),
       "stack.toml:4: ", "plant.command_delay_ticks: found 0.5, allowed a whole number"},
      {InSection("plant", "integrator = \"euler\""), "stack.toml:4: ",
       "plant.integrator: found \"euler\", allowed \"auto\", \"fast\", \"erk\" or \"cvode\""},
      {InSection("plant", "relative_tolerance = 0"), "stack.toml:4: ", "plant.relative_tolerance: found 0"},
      {InSection("plant", "relative_tolerance = 1"), "stack.toml:4: ", "plant.relative_tolerance: found 1"},
      // [pressure]
      {InSection("pressure", "rate_hz = 300"), "stack.toml:6: ",
       "pressure.rate_hz: found 300, allowed plant.rate_hz = 1000 divided by a whole number"},
      {InSection("pressure", "rate_hz = 2000"), "stack.toml:6: ", "pressure.rate_hz: found 2000"},
      {InSection("pressure", "rate_hz = 0"),
       "stack.toml:6: ", "pressure.rate_hz: found 0, allowed a finite number above 0 or \"every_tick\""},
      {InSection("pressure", "rate_hz = \"each\""),
       "stack.toml:6: ", "pressure.rate_hz: found \"each\", allowed"},
      {InSection("pressure", "k_p = 0.1\nk_v = 8"),
       "stack.toml:6: ", "pressure.k_p: found it beside natural_frequency_rad_s or damping_ratio, allowed"},
      {InSection("pressure", "k_v = 8"), "stack.toml:6: ", "pressure.k_v: found it beside"},
      {ChangedConfig("natural_frequency_rad_s = 150\ndamping_ratio = 0.5\n", ""),
       "stack.toml:5: ", "pressure: found no gains, allowed k_p with k_v, or"},
      {ChangedConfig("[pressure]\nnatural_frequency_rad_s = 150\ndamping_ratio = 0.5\n", ""),
       "stack.toml: ", "pressure: found no gains"},
      {ChangedConfig("damping_ratio = 0.5\n", ""), "stack.toml:6: ",
       "pressure.natural_frequency_rad_s: found natural_frequency_rad_s without damping_ratio, allowed"},
      {ChangedConfig("natural_frequency_rad_s = 150\n", ""),
       "stack.toml:6: ", "pressure.damping_ratio: found damping_ratio without natural_frequency_rad_s"},
      {ChangedConfig("natural_frequency_rad_s = 150\ndamping_ratio = 0.5\n", "k_p = 1\n"),
       "stack.toml:6: ", "pressure.k_p: found k_p without k_v"},
      {ChangedConfig("natural_frequency_rad_s = 150\ndamping_ratio = 0.5\n", "k_v = 1\n"),
       "stack.toml:6: ", "pressure.k_v: found k_v without k_p"},
      {ChangedConfig("natural_frequency_rad_s = 150\ndamping_ratio = 0.5\n", "k_v = 1\nk_p = -1\n"),
       "stack.toml:7: ", "pressure.k_p: found -1, allowed a finite number of at least 0"},
      {ChangedConfig("damping_ratio = 0.5", "damping_ratio = -0.5"),
       "stack.toml:7: ", "pressure.damping_ratio: found -0.5"},
      {ChangedConfig("natural_frequency_rad_s = 150", "natural_frequency_rad_s = nan"),
       "stack.toml:6: ", "pressure.natural_frequency_rad_s: found nan"},
      {InSection("pressure", "compressed_sides = 3"), "stack.toml:6: ",
       "pressure.compressed_sides: found 3, allowed a whole number of at least 1 and at most 2"},
      {InSection("pressure", "reference_feedforward = \"yes\""), "stack.toml:6: ",
       "pressure.reference_feedforward: found \"yes\", allowed true, false or a finite number: the gain, "
       "volts per pressure"},
      {InSection("pressure", "reference_feedforward = nan"),
       "stack.toml:6: ", "pressure.reference_feedforward: found nan"},
      {InSection("pressure", "arm_speed_feedforward = 1"),
       "stack.toml:6: ", "pressure.arm_speed_feedforward: found 1, allowed true or false"},
      // [position]
      {InSection("position", "sample_interval_s = 0.0055"), "stack.toml:9: ",
       "position.sample_interval_s: found 0.0055 s, which is 5.5 ticks, allowed a whole number of ticks of "
       "0.001 s"},
      {InSection("position", "sample_interval_s = 0.0001"),
       "stack.toml:9: ", "position.sample_interval_s: found 0.0001 s, which is 0.1 ticks"},
      {InSection("position", "sample_interval_s = 0"),
       "stack.toml:9: ", "position.sample_interval_s: found 0, allowed a finite number above 0"},
      {ChangedConfig("c1 = 10500", "c1 = -1"),
       "stack.toml:9: ", "position.c1: found -1, allowed a finite number of at least 0"},
      {ChangedConfig("c2 = 350", "c2 = \"350\""), "stack.toml:10: ", "position.c2: found \"350\""},
      {InSection("position", "derivative = true"),
       "stack.toml:9: ", "position.derivative: found true, allowed \"error\" or \"measurement\""},
      {InSection("position", "dac_bits = 33"),
       "stack.toml:9: ", "position.dac_bits: found 33, allowed a whole number of at least 0 and at most 32"},
      {InSection("position", "dac_range = 0"), "stack.toml:9: ", "position.dac_range: found 0"},
      // [reference]
      {ChangedConfig("signal = \"arm_angle\"", "signal = \"angle\""), "stack.toml:12: ",
       "reference.signal: found \"angle\", allowed \"arm_angle\", \"pressure\", \"torque\" or \"voltage\""},
      {Reference("kind = \"step\"\n"), "stack.toml:13: ",
       "reference.kind: found \"step\", allowed \"steps\", \"sine\", \"square\", \"chirp\", \"csv\" or "
       "\"planner\""},
      {Reference("kind = \"steps\"\namplitude = 1\n"), "stack.toml:14: ",
       "reference: \"amplitude\": found an unknown key, allowed \"signal\", \"kind\", \"initial\" or "
       "\"steps\""},
      {Reference("kind = \"sine\"\nsteps = [[0, 0]]\n"),
       "stack.toml:14: ", "reference: \"steps\": found an unknown key"},
      {Reference("kind = \"square\"\nphase_rad = 0\n"),
       "stack.toml:14: ", "reference: \"phase_rad\": found an unknown key"},
      {Reference("kind = \"chirp\"\nfrequency_hz = 0\n"),
       "stack.toml:14: ", "reference: \"frequency_hz\": found an unknown key"},
      {Reference("kind = \"steps\"\nsteps = 3\n"),
       "stack.toml:14: ", "reference.steps: found 3, allowed an array of [time_s, value]"},
      {Reference("kind = \"steps\"\nsteps = [0.1, 0.2]\n"),
       "stack.toml:14: ", "reference.steps[0]: found 0.1, allowed a pair [time_s, value]"},
      {Reference("kind = \"steps\"\nsteps = [[0, 0.1],\n [1, 0.2, 3]]\n"),
       "stack.toml:15: ", "reference.steps[1]: found 3 numbers, allowed a pair"},
      {Reference("kind = \"steps\"\nsteps = [[0, \"a\"]]\n"),
       "stack.toml:14: ", "reference.steps[0]: found \"a\", allowed two finite numbers"},
      {Reference("kind = \"steps\"\nsteps = [[0, nan]]\n"),
       "stack.toml:14: ", "reference.steps[0]: found nan"},
      {Reference("kind = \"steps\"\nsteps = [[1, 0],\n[1, 0.1]]\n"),
       "stack.toml:15: ", "reference.steps[1]: found time 1, allowed a time above 1"},
      {Reference("kind = \"steps\"\nsteps = [[0, 0.9]]\n"),
       "stack.toml:14: ", "reference.steps: found arm angle 0.9 rad (51.57 deg)"},
      {Reference("kind = \"steps\"\nsteps = [[0, 0.85]]\n"),
       "stack.toml:14: ", "reference.steps: found arm angle 0.85 rad (48.7 deg), allowed |alpha| <= 0.840"},
      {ChangedConfig("[pressure]", "[limits]\nrearm = \"never\"\n[pressure]"),
       "stack.toml:", "limits.rearm: found \"never\", allowed \"restart\" or \"explicit\""},
      {ChangedConfig("[pressure]", "[limits]\npressure_ramp_s = -1\n[pressure]"),
       "stack.toml:", "limits.pressure_ramp_s: found -1"},
      {Reference("kind = \"steps\"\ninitial = -2\n"),
       "stack.toml:14: ", "reference.initial: found arm angle -2 rad (-114.6 deg)"},
      {Reference("kind = \"sine\"\noffset = 0.5\namplitude = -0.4\n"),
       "stack.toml:15: ", "reference.amplitude: found arm angle 0.9 rad"},
      {Reference("kind = \"sine\"\nfrequency_hz = 0\n"),
       "stack.toml:14: ", "reference.frequency_hz: found 0, allowed a finite number above 0"},
      {Reference("kind = \"square\"\nfrequency_hz = 1e308\n"), "stack.toml:14: ",
       "reference.frequency_hz: found 1e+308 Hz, allowed up to 100 Hz, half of the rate at which the "
       "position loop samples it (position.sample_interval_s)"},
      {Reference("kind = \"sine\"\nfrequency_hz = 100.1\n"),
       "stack.toml:14: ", "reference.frequency_hz: found 100.1 Hz, allowed up to 100 Hz"},
      {Reference("kind = \"chirp\"\nfirst_frequency_hz = 1\nlast_frequency_hz = 1e9\nduration_s = 1\n"),
       "stack.toml:15: ", "reference.last_frequency_hz: found 1000000000 Hz, allowed up to 100 Hz"},
      {Reference("kind = \"sine\"\namplitude = 1e308\noffset = 1e308\n"),
       "stack.toml:11: ", "reference: offset + amplitude: found inf, allowed: a finite number"},
      {Reference("kind = \"chirp\"\nduration_s = 0\n"), "stack.toml:14: ", "reference.duration_s: found 0"},
      {Reference("kind = \"chirp\"\nfirst_frequency_hz = -1\n"),
       "stack.toml:14: ", "reference.first_frequency_hz: found -1, allowed a finite number of at least 0"},
      {Reference("kind = \"csv\"\n"),
       "stack.toml:11: ", "reference.file: found nothing, allowed the path of a CSV file"},
      {Reference("kind = \"csv\"\nfile = \"a.csv\"\n"),
       "stack.toml:11: ", "reference.column: found nothing, allowed the name"},
      {Reference("kind = \"csv\"\nfile = \"none.csv\"\ncolumn = \"y\"\n"), "none.csv: ",
       "cannot be read: No such file or directory; is its path right? (reference.file in stack.toml:11)"},
      {Reference("kind = \"csv\"\nfile = \"a.csv\"\ncolumn = \"y\"\npoints = [[0, 0]]\n"),
       "stack.toml:14: ", "reference.file: found it beside points, allowed"},
      {Reference("kind = \"csv\"\npoints = []\n"),
       "stack.toml:14: ", "reference.points: found an empty array, allowed one point or more"},
      {Reference("kind = \"csv\"\npoints = [[0, 0]]\ninterpolation = \"spline\"\n"), "stack.toml:15: ",
       "reference.interpolation: found \"spline\", allowed \"hold\", \"linear\" or \"cubic\""},
      {Reference("kind = \"csv\"\npoints = [[0, -1e300], [1e-300, 1e300]]\n"),
       "stack.toml:11: ", "reference: point 2: found a rate"},
      // [limits]
      {Extended("[limits]\npressure_psi = 0\n"),
       "stack.toml:16: ", "limits.pressure: found 0, allowed a finite number above 0, or inf"},
      {Extended("[limits]\npressure_psi = 100\n"),
       "stack.toml:16: ", "limits.pressure: found 100 psi, allowed above 100 psi, the pressure at the start"},
      {Extended("[limits]\nmotor_speed_rad_s = -1\n"), "stack.toml:16: ", "limits.motor_speed: found -1"},
      {Extended("[limits]\narm_torque_in_lbf = nan\n"), "stack.toml:16: ", "limits.arm_torque: found nan"},
      {Extended("[limits]\nstale_input_s = 1e300\n"), "stack.toml:16: ",
       "limits.stale_input_s: found 1e+300, allowed a finite number above 0 and at most 1000000"},
      {Extended("[limits]\nstale_input_s = inf\n"),
       "stack.toml:16: ", "limits.stale_input_s: found inf, allowed a finite number above 0"},
      // [noise]
      {Extended("[noise]\np1_psi = -1\n"),
       "stack.toml:16: ", "noise.p1: found -1, allowed a finite number of at least 0"},
      {Extended("[noise]\narm_speed_rad_s = true\n"), "stack.toml:16: ", "noise.arm_speed: found true"},
      {Extended("[noise]\np2_resolution_psi = -1\n"),
       "stack.toml:16: ", "noise.p2_resolution: found -1, allowed a finite number of at least 0"},
      {Extended("[noise]\nseed = -1\n"),
       "stack.toml:16: ", "noise.seed: found -1, allowed a whole number of at least 0"},
      {Extended("[noise]\nseed = 1.5\n"), "stack.toml:16: ", "noise.seed: found 1.5"},
      {Extended("[noise]\nseed = 99999999999999999999\n"), "stack.toml:16: ", "syntax: "},
      // [[process]]
      {Extended("[process]\nprogram = \"hydro-plant\"\n"), "stack.toml:15: ",
       "process: found a section [process], allowed a list of sections: write [[process]]"},
      {"process = [1]\n" + Extended(""), "stack.toml:1: ", "process: found 1, allowed sections [[process]]"},
      {Extended("[[process]]\ncpu = 1\n"),
       "stack.toml:15: ", "process.program: found nothing, allowed the program's name"},
      {Extended("[[process]]\nprogram = \"plant\"\n"),
       "stack.toml:16: ", "process.program: found \"plant\", allowed \"hydro-plant\", "},
      {Extended("[[process]]\nprogram = \"hydro-plant\"\ncpu = -2\n"),
       "stack.toml:17: ", "process.cpu: found -2, allowed a whole number of at least -1"},
      {Extended("[[process]]\nprogram = \"hydro-plant\"\npriority = 100\n"),
       "stack.toml:17: ", "process.priority: found 100, allowed a whole number of at least 0 and at most 99"},
      {Extended("[[process]]\nprogram = \"hydro-plant\"\nlock_memory = 1\n"),
       "stack.toml:17: ", "process.lock_memory: found 1, allowed true or false"},
      {Extended("[logger]\nmemory_mb = 0.5\n"), "stack.toml:16: ", "logger.memory_mb: found 0.5, allowed "},
      {Extended("[[process]]\nprogram = \"hydro-plant\"\nnice = 1\n"),
       "stack.toml:17: ", "process: \"nice\": found an unknown key"},
      {Extended("[[process]]\ncommand = [\"./pid.py\"]\n"), "stack.toml:15: ",
       "process.role: found nothing, allowed \"position_ctrl\", \"pressure_ctrl\" or \"driver\""},
      {Extended("[[process]]\ncommand = [\"./pid.py\"]\nrole = \"pilot\"\n"),
       "stack.toml:17: ", "process.role: found \"pilot\", allowed \"position_ctrl\", \"pressure_ctrl\""},
      {Extended("[[process]]\ncommand = [\"./pid.py\"]\nrole = \"plant\"\n"),
       "stack.toml:17: ", "; the plant is always hydro-plant; a machine of your own is a driver"},
      {Extended("[[process]]\ncommand = [\"./pid.py\"]\nrole = \"logger\"\n"),
       "stack.toml:17: ", "; the logger is always hydro-logger"},
      {Extended("[[process]]\ncommand = \"./pid.py\"\nrole = \"position_ctrl\"\n"), "stack.toml:16: ",
       "process.command: found \"./pid.py\", allowed the program and its arguments as a list"},
      {Extended("[[process]]\ncommand = [1]\nrole = \"position_ctrl\"\n"),
       "stack.toml:16: ", "process.command: found 1 in it, allowed the program"},
      {Extended("[[process]]\nprogram = \"hydro-plant\"\nrole = \"plant\"\n"),
       "stack.toml:17: ", "process.role: found it without command"},
      {Extended("[[process]]\nprogram = \"hydro-position-ctrl\"\n[[process]]\ncommand = [\"./pid.py\", "
                "\"x\"]\nrole = \"position_ctrl\"\n"),
       "stack.toml:17: ",
       "process.command: found ./pid.py x (position_ctrl) beside hydro-position-ctrl, allowed one program "
       "for "
       "the role position_ctrl"},
      {Extended("[[process]]\nprogram = \"hydro-plant\"\n[[process]]\nprogram = \"hydro-plant\"\n"),
       "stack.toml:17: ", "process.program: found a second hydro-plant"},
  };
  return table;
}

// Tests that each malformed configuration is refused on one line with its place, what was found and what is
// allowed.
TEST(StackConfigErrorsTest, NamesPlaceFoundAndAllowed) {
  for (const Malformed& malformed : Table()) {
    const std::string error = InputErrorOf([&] { Parsed(malformed.text); });
    EXPECT_THAT(error, AllOf(HasSubstr(malformed.place), HasSubstr(malformed.says))) << malformed.text;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    if (error.find("syntax: ") == std::string::npos && error.find("cannot be read") == std::string::npos) {
      EXPECT_THAT(error, AllOf(HasSubstr(": found "), HasSubstr("allowed"))) << malformed.text;
    }
  }
}

// Tests that angles that matter only for arm angles are not asked of other signals.
TEST(StackConfigErrorsTest, PressureReferencesMayBeLarge) {
  EXPECT_EQ(
      InputErrorOf([&] {
        Parsed(Replaced(Replaced(kConfigText, "arm_angle", "pressure"), "[[0.1, 0.1]]", "[[0.1, 300]]"));
      }),
      "");
}

// Tests that the time for a file of unknown keys does not depend on what each of them may have meant: with
// 30,000 of them that took seconds (without sanitizers).
TEST(StackConfigErrorsTest, ManyUnknownKeys) {
  std::string text;
  for (int i = 0; i < 30000; ++i) text += "unknown_key_" + std::to_string(i) + " = 1\n";
  timespec before{}, after{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
  EXPECT_THAT(InputErrorOf([&] { Parsed(text + kConfigText); }),
              ::testing::HasSubstr("stack.toml:1: \"unknown_key_0\": found an unknown key"));
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
  EXPECT_LT(after.tv_sec - before.tv_sec, 6)
      << "s of this thread; 300,000 attempts with the sanitizers take a minute";
}

}  // namespace
}  // namespace hydro::settings
