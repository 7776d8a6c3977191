// The configuration of a whole stack: one TOML file that every program of it reads.
// Units: s, Hz, rad, psi, V, in-lbf (the model file's coherent units).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "model/terms/actuator_options.h"
#include "model/terms/description.h"
#include "model/trajectory/trajectory.h"
#include "settings/driver_section.h"
#include "settings/read_quantities.h"

namespace hydro::settings {

// A Trajectory as the configuration describes it ([reference], [model.motion]).
struct TrajectorySpec {
  enum class Kind { kSteps, kSine, kSquare, kChirp, kCsv, kPlanner };
  Kind kind = Kind::kSteps;
  double initial = 0;                   // kSteps, kPlanner: value before the first step or plan
  std::vector<trajectory::Step> steps;  // kSteps: [[time_s, value], ...]
  double offset = 0;                    // kSine, kSquare, kChirp
  double amplitude = 0;                 // kSine, kSquare, kChirp
  double frequency_hz = 1;              // kSine, kSquare
  double phase_rad = 0;                 // kSine
  double start_s = 0;                   // kSine, kSquare, kChirp
  double first_frequency_hz = 0.1;      // kChirp
  double last_frequency_hz = 10;        // kChirp
  double duration_s = 10;               // kChirp
  double timeout_s = 0.2;               // kPlanner: plant time after which a plan is no longer followed
  double delay_s = 0.01;                // kPlanner: from the tick on which a plan is based to its effect
  double max_speed_rad_s = std::numeric_limits<double>::infinity();  // kPlanner: largest reference speed
  std::string file;    // kCsv: relative to the configuration's folder
  std::string column;  // kCsv: the column of values; the times are in the column time_s
  trajectory::Interpolation interpolation = trajectory::Interpolation::kLinear;  // kCsv
  std::vector<trajectory::Step> points;  // kCsv: the points in the file
};

struct ModelSection {
  std::string file;           // as given; relative to the configuration's folder
  std::string resolved_file;  // the path from which it was read
  std::string text;           // the file's text
  model::ModelDescription description;
  model::Shaft shaft = model::Shaft::kFree;  // shaft = "free" | "clamped" | "driven"
  double arm_angle_rad = 0;              // clamped: the angle at which it is held; free: where the arm starts
  bool bypass = false;                   // the valve between the two sides is open: p1 = p2
  std::optional<TrajectorySpec> motion;  // [model.motion], required for driven: the arm's angle over time
  double initial_pressure_psi =
      std::numeric_limits<double>::quiet_NaN();  // pressure of both sides at the start; default p_3
};

struct BusSection {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string channel_suffix;  // appended to every channel name
  // For one joint's stack: the suffix of its limb's own channels, which the logger uses. None: the stack has
  // only channel_suffix.
  std::optional<std::string> limb_suffix;
  std::vector<std::string>
      sibling_suffixes;  // for one joint's stack: of the channels of its limb's other joints
  std::vector<std::string> joint_suffixes;  // for what a limb's joints share: their suffixes; else empty
  std::string key_file;                     // "": messages are not authenticated; docs/security.md
  std::string resolved_key_file;            // the path from which to read it
};

enum class TimeMode { kRealtime, kLockstep };

struct TimeSection {
  TimeMode mode = TimeMode::kRealtime;
  double speed = 1;  // realtime: simulated seconds per wall second; lockstep always runs as fast as possible
  double duration_s = 0;         // plant time after which the run ends; 0: until stopped
  double start_timeout_s = 10;   // wall time for which the plant waits until the others are ready
  double stall_timeout_s = 1.5;  // lockstep: wall time for which the plant waits for one command; less than 2
};

struct PlantSection {
  double rate_hz = 1000;        // ticks per second of plant time
  int command_delay_ticks = 1;  // a command computed from tick k acts from tick k + this; 0 or 1
  model::Integrator integrator = model::Integrator::kAuto;  // "auto" | "fast" | "erk" | "cvode"
  double relative_tolerance = 1e-8;
};

struct PressureSection {
  double rate_hz = 0;         // 0 (or "every_tick"): each plant tick; otherwise it divides plant.rate_hz
  std::optional<double> k_p;  // V/psi, eq. (16); given with k_v, or else the two below are given
  std::optional<double> k_v;  // psi s/rad, eq. (16)
  std::optional<double> natural_frequency_rad_s;  // the gains follow from these two
  std::optional<double> damping_ratio;
  int compressed_sides = 2;            // 2: both volumes compress; 1: a valve holds the other at p_3
  bool reference_feedforward = false;  // adds the voltage that holds dp_ref in the steady state
  std::optional<double> reference_feedforward_V_psi;  // the same with a user-defined gain
  bool arm_speed_feedforward = false;                 // removes (c/D) alpha' from the k_v term
};

struct PositionSection {
  double sample_interval_s = 0.005;  // T of eq. (17); a whole number of plant ticks
  double c1 = 0;                     // psi/rad
  double c2 = 0;                     // psi s/rad
  bool derivative_on_error = false;  // derivative = "error" (eq. (17) as printed) | "measurement"
  // rad/s^2: a braking curve before eq. (17) (position_ctrl/law/position_law.h); none: eq. (17) alone.
  std::optional<double> braking_rad_s2;
  int dac_bits = 0;             // 0: no D/A quantisation of the pressure command
  double dac_range_psi = 2000;  // full scale of the D/A, +/-
};

enum class ReferenceSignal { kArmAngle, kPressure, kTorque, kVoltage };

struct ReferenceSection {
  ReferenceSignal signal = ReferenceSignal::kArmAngle;  // "arm_angle" | "pressure" | "torque" | "voltage"
  TrajectorySpec trajectory;  // kind = "steps" | "sine" | "square" | "chirp" | "csv"
};

// How a fault that zeroed the voltage ends. docs/safety.md lists the codes and what each does.
enum class Rearm {
  kRestart,   // good inputs end it; passing a limit ends the run
  kExplicit,  // the run continues at zero volts until hydro-launch --rearm
};

struct LimitsSection {
  double pressure_psi = 2000;  // of either side; above it: zero volts and a fault
  double motor_speed_rad_s = std::numeric_limits<double>::infinity();
  // |alpha|. The default when read from a file is kArmAngleShare V_ms/c for a free shaft (stack_checks.h).
  double arm_angle_rad = std::numeric_limits<double>::infinity();
  double arm_torque_in_lbf = std::numeric_limits<double>::infinity();  // |k_2 dp_ref| is limited to this
  double stale_input_s = 0.1;     // an input older than this gives zero volts and a fault
  double pressure_ramp_s = 0.2;   // plant time over which a stale pressure reference goes to zero; 0: at once
  double stale_logger_s = 1;      // a logger silent for longer is reported as gone
  double return_s = 0.5;          // plant time over which the reference returns after zero volts; 0: at once
  double transfer_s = 0.1;        // plant time over which gains changed while running take effect; 0: at once
  double stale_supervisor_s = 1;  // a launcher silent for longer gives zero volts and a fault
  // rearm = "restart" | "explicit". The default when read from a file is explicit with a driver.
  Rearm rearm = Rearm::kRestart;
};

struct NoiseSection {
  // Standard deviations of the noise that the sensors add; 0: none.
  double p1_psi = 0;
  double p2_psi = 0;
  double motor_angle_rad = 0;
  double motor_speed_rad_s = 0;
  double arm_angle_rad = 0;
  double arm_speed_rad_s = 0;
  // Readings, including noise, are rounded to multiples of these; 0: not rounded.
  double p1_resolution_psi = 0;
  double p2_resolution_psi = 0;
  double motor_angle_resolution_rad = 0;
  double motor_speed_resolution_rad_s = 0;
  double arm_angle_resolution_rad = 0;
  double arm_speed_resolution_rad_s = 0;
};

struct LoggerSection {
  bool required = true;  // hydro-launch stops the stack when the logger ends
  double memory_mb =
      64;  // for messages waiting to be written; those that arrive when it is full are left out of the log
};

struct ProcessSection {
  // hydro-plant, hydro-driver, hydro-pressure-ctrl, hydro-position-ctrl, hydro-limb or hydro-logger; empty:
  // `command`
  std::string program;
  std::string host;          // empty: any host (started by a launch without --host, or on "localhost")
  int cpu = -1;              // processor to run on; -1: any
  int priority = 0;          // SCHED_FIFO priority 1..99; 0: ordinary scheduling
  bool lock_memory = false;  // keep all memory resident; the default where a priority is set
  // A program of the user's own and its arguments, as configured. It runs in the configuration's folder.
  std::vector<std::string> command = {};
  std::string role = {};   // its role in the stack, e.g. position_ctrl; our programs have their own
  std::string place = {};  // "file:line" of the section; empty where there is none
  // Only in a configuration with [[joint]] sections (settings/limb_config.h):
  std::string joint = {};                // the joint it serves; empty: it is hydro-limb or hydro-logger
  std::vector<std::string> joints = {};  // for hydro-limb; empty: all joints that no other process has
};

// Another joint of the same limb.
struct Sibling {
  std::string name;
  std::string suffix;  // of its channels
  // Real time: how long a stack runs on without the sibling's states once it has heard one; 0: for ever.
  double silence_s = 0;
};

struct StackConfig {
  std::string file;    // as given on the command line
  std::string text;    // effective TOML: the file with every override applied
  std::string agreed;  // what the processes of a stack must have in common (agreed_entries.h); empty: nothing
  ModelSection model;
  BusSection bus;
  TimeSection time;
  PlantSection plant;
  PressureSection pressure;
  PositionSection position;
  ReferenceSection reference;
  LimitsSection limits;
  NoiseSection noise;
  LoggerSection logger;
  std::optional<DriverSection> driver;  // only a stack with hydro-driver needs it
  int64_t seed = 1;                     // --seed, [noise] seed
  std::vector<ProcessSection>
      processes;                 // default: plant, pressure-ctrl, position-ctrl, no host, no cpu, no priority
  bool without_its_arm = false;  // for one joint's stack: its limb has an [arm], which this stack lacks
  std::vector<Sibling> siblings;  // for one joint's stack: the other joints of its limb
  // For one joint's stack, and for what a limb's joints have in common: the fault, the silence or the end of
  // one joint concerns all.
  bool joints_concern_each_other = true;
  std::vector<std::string> joints;  // for what a limb's joints share: their names; else empty

  // Plant ticks per sample of the position loop and of the pressure loop (whole numbers, checked when read).
  int64_t position_interval_ticks = 1;
  int64_t pressure_interval_ticks = 1;
  // The tick at which the run ends; -1: the run does not end by itself.
  int64_t last_tick = -1;
};

// Reads `file`, applies `overrides` ("section.key=value", the value in TOML or a bare word), reads the model
// file that the configuration names, and checks everything. From a file with [[joint]] sections, loads the
// stack of the joint that "joint=NAME" chooses. Throws InputError (exit 2) naming file, line or key, what was
// found, what is allowed.
StackConfig LoadStackConfig(const std::string& file, const std::vector<std::string>& overrides = {});

// Does the same from text instead of a file (a log's own description); `model_text` replaces the model file.
StackConfig ParseStackConfig(const std::string& config_text, const std::string& config_name,
                             const std::string& model_text, const std::string& model_name);

// Returns `config` with some entries changed, each "section.key=value" as with --set, and with the same
// model. Throws InputError.
StackConfig Changed(const StackConfig& config, const std::vector<std::string>& changes,
                    FormerNames former = FormerNames::kMustBeTrue);

// Reads a section [reference] alone, as TOML. Throws InputError.
ReferenceSection ParseReference(const std::string& text);

// The section [reference] of `config`, which ParseReference() reads.
std::string ReferenceText(const StackConfig& config);

// The greatest age in ticks at which a pressure command still counts for a state (limits.stale_input_s beyond
// the usual age).
int64_t OldestPressureCommandTicks(const StackConfig& config);

// The suffixes of the channels that carry states and commands: those of a limb's joints, or the stack's own.
std::vector<std::string> JointSuffixes(const StackConfig& config);

// The suffixes of all stacks on its bus: its own, and those of a limb's joints.
std::vector<std::string> StackSuffixes(const StackConfig& config);

// One line for people that says which parts of its limb a joint's stack lacks; empty: none.
std::string ArmRemark(const StackConfig& config);

// Builds the function that a specification describes.
std::unique_ptr<trajectory::Trajectory> MakeTrajectory(const TrajectorySpec& spec);

}  // namespace hydro::settings
