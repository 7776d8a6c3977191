// A run as measured: the data to which a model is fitted. It is read from a log, or from another recorder's
// table with a sidecar that explains its columns (docs/measured_runs.md).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/tables/table.h"
#include "base/unit_system.h"
#include "model/terms/actuator_options.h"

namespace hydro::runs {

using tables::kMissing;

// The source of values: a column of a table, ours(t) = scale * theirs(t + delay) + offset.
struct ColumnSource {
  std::string column;                       // its name in the table; "" for logs
  double scale = 1, offset = 0, delay = 0;  // scale and offset include any unit that the sidecar states
};

struct MeasuredSignal {
  std::vector<double> values;   // one per sample, in our units; NaN: missing there. Empty: not measured
  std::optional<double> noise;  // standard deviation, if known; above 0
  ColumnSource source = {};     // what the sidecar says about it

  bool measured() const { return !values.empty(); }
};

struct MeasuredRun {
  std::string name;           // its own name; for a log, the file's stem
  std::string file;           // as given
  std::string sidecar;        // for a table, the file that describes it; "" for logs
  std::vector<size_t> lines;  // for a CSV, the line of each row; empty: messages count rows from 1

  model::Shaft shaft = model::Shaft::kFree;
  double arm_angle_rad = 0;  // kClamped: the angle at which the arm is held
  bool bypass = false;       // the valve between the two sides is open: p1 = p2

  // The joint belongs to a limb with an [arm], whose load replaces J_a and mgl of the joint's model.
  bool in_an_arm = false;

  // How its table was read, if not in the plain way: "semicolons between cells, decimal commas".
  std::string layout;

  // One line that says which conclusions the run does not support because its log is incomplete, repaired or
  // holds another stack too (runs/recorded/run_log.h); empty when there is nothing to say.
  std::string caution;

  UnitSystem units;  // of all values except time (s) and voltage (V)

  std::string model_text;  // the model with which the log says the run was made (TOML); "" for tables

  size_t first_row = 0;  // rows of the file cut off before the first sample

  std::vector<double> time;     // s, finite and increasing, not always evenly; at least two samples
  std::optional<double> begun;  // s, time of the run's first sample, where that was cut off
  ColumnSource time_source;     // what the sidecar says about it
  MeasuredSignal voltage;       // command of eq. (1), held from each sample to the next; no value is missing
  // The same as written, NaN in the rows of a table that had none and hold the one before. Empty: all had
  // one.
  std::vector<double> written_commands;
  MeasuredSignal pressure_ref;  // of p2 - p1
  MeasuredSignal motor_speed;
  MeasuredSignal motor_angle;
  MeasuredSignal arm_angle;  // always measured when the shaft is driven
  MeasuredSignal arm_speed;
  MeasuredSignal p1;
  MeasuredSignal p2;
  // Other quantities that were measured.
  MeasuredSignal dp;              // p2 - p1 of a differential transducer, beside p1 and p2
  MeasuredSignal arm_force;       // on the arm, in the direction of its angle, besides its weight (load cell)
  MeasuredSignal temperature;     // degC, of the oil
  MeasuredSignal motor_voltage;   // V, at the motor's terminals, where the command is a current
  MeasuredSignal bypass_valve;    // open above 0.5
  bool current_commands = false;  // `voltage` is a current in A, and the motor's torque is k_1 times it

  size_t samples() const { return time.size(); }
  // The time of the run's first sample, whether or not it was cut off.
  double Begin() const { return begun.value_or(time.front()); }
  // Cuts off the samples before `first` and those from `last` on.
  void Keep(size_t first, size_t last);
  // The place of a sample, for messages: "run.csv: line 17".
  std::string Place(size_t sample) const;
};

// The name of a run on a command line: a file, or "LOG#NAME".
struct RunName {
  std::string file;
  std::optional<std::string> joint = {};  // of the limb in the log
};

// Parses the name. If a file has that whole name, including the #, it is the file.
RunName ParseRunName(const std::string& text);

// Reads a run: FILE.csv or FILE.mat with its sidecar (sidecar.h), any other name as a log. "LOG#NAME"
// is the joint of that name in the log of a limb. A sidecar may make several runs of a table (run_parts.h).
// The values are in `units`, those of a model. Without `units`, a table is in the paper's units, and a log in
// those of its own model. Throws InputError naming file, line or key, what was found and what is allowed, for
// - a sidecar that is missing, or has unknown keys, a unit that is unknown or another signal's, no shaft, no
//   column for time or voltage, an angle of a shaft that is not clamped, a driven shaft without arm_angle, or
//   noise of a signal without a column;
// - a table with columns that are absent or hold no value, numbers that are not finite, times that are
//   missing or do not increase, or no command in the first row;
// - a log with damage (an incomplete one is read to its end and has a `caution`), messages that cannot be
//   decoded, more than one run, a limb's telemetry of only some states, no description of how the shaft was
//   held, or an arm whose coordinate is not that of `units`.
std::vector<MeasuredRun> ReadMeasuredRuns(const std::string& file,
                                          const std::optional<UnitSystem>& units = std::nullopt);
// The same for a file that is one run. Throws InputError when it is several.
MeasuredRun ReadMeasuredRun(const std::string& file, const std::optional<UnitSystem>& units = std::nullopt);

// The run in a table of hydro-log export (runs/recorded/run_table.h). `config_text` is the configuration of
// the run, which gives the shaft, the bypass and the stated noise of the sensors. `model_text`, if any, gives
// the units.
MeasuredRun RunOfExport(const tables::Table& table, const std::string& config_text,
                        const std::string& model_text);

// The run's name in quotation marks, with its caution in brackets, for texts beside results.
std::string NameWithCaution(const MeasuredRun& run);

// The signals of a measured run by their names, here and in tables of hydro-log export.
struct SignalName {
  MeasuredSignal MeasuredRun::*signal;
  const char* ours;      // in a sidecar
  const char* exported;  // in a table of ExportRun(), with the paper's unit; null: no log has it
  // In [noise] of a configuration; null: the signal has no sensor.
  const char* standard_deviation;
  const char* resolution;
  const char* unit;  // in the paper
  int arm = 0;       // power of the arm's coordinate in it
};

inline constexpr std::array<SignalName, 13> kSignals = {{
    {&MeasuredRun::voltage, "voltage", "voltage_V", nullptr, nullptr, "V"},
    {&MeasuredRun::pressure_ref, "pressure_ref", "pressure_ref_psi", nullptr, nullptr, "psi"},
    {&MeasuredRun::motor_speed, "motor_speed", "motor_speed_rad_s", "motor_speed", "motor_speed_resolution",
     "rad/s"},
    {&MeasuredRun::motor_angle, "motor_angle", "motor_angle_rad", "motor_angle", "motor_angle_resolution",
     "rad"},
    {&MeasuredRun::arm_angle, "arm_angle", "arm_angle_rad", "arm_angle", "arm_angle_resolution", "rad", 1},
    {&MeasuredRun::arm_speed, "arm_speed", "arm_speed_rad_s", "arm_speed", "arm_speed_resolution", "rad/s",
     1},
    {&MeasuredRun::p1, "p1", "p1_psi", "p1", "p1_resolution", "psi"},
    {&MeasuredRun::p2, "p2", "p2_psi", "p2", "p2_resolution", "psi"},
    {&MeasuredRun::dp, "dp", nullptr, nullptr, nullptr, "psi"},
    {&MeasuredRun::arm_force, "arm_force", nullptr, nullptr, nullptr, "in-lbf", -1},
    {&MeasuredRun::temperature, "temperature", nullptr, nullptr, nullptr, "degC"},
    {&MeasuredRun::motor_voltage, "motor_voltage", nullptr, nullptr, nullptr, "V"},
    {&MeasuredRun::bypass_valve, "bypass", nullptr, nullptr, nullptr, "1"},
}};

// A signal's row. Every signal of a MeasuredRun has one.
constexpr const SignalName& RowOf(MeasuredSignal MeasuredRun::*signal) {
  size_t row = 0;
  while (kSignals[row].signal != signal) ++row;
  return kSignals[row];
}

// A signal's key in the sidecar of the run, which texts use as its name. Where a current is commanded,
// `current` is the command and `voltage` was measured at the motor. Null: the sidecar has no key for it.
inline const char* KeyIn(const MeasuredRun& run, const SignalName& name) {
  if (name.signal == &MeasuredRun::voltage && run.current_commands) return "current";
  if (name.signal == &MeasuredRun::motor_voltage) return run.current_commands ? "voltage" : nullptr;
  return name.ours;
}
// All keys that [columns] of a sidecar may have.
inline std::vector<std::string> ColumnKeys() {
  std::vector<std::string> keys = {"time"};
  MeasuredRun run;
  for (const bool current : {false, true}) {
    run.current_commands = current;
    for (const SignalName& name : kSignals) {
      const char* key = KeyIn(run, name);
      if (key != nullptr && std::find(keys.begin(), keys.end(), key) == keys.end()) keys.emplace_back(key);
    }
  }
  return keys;
}

// Its unit in the run.
inline std::string UnitIn(const MeasuredRun& run, const SignalName& name) {
  if (name.signal == &MeasuredRun::voltage && run.current_commands) return "A";
  return run.units.UnitFor(name.unit, name.arm);
}

inline const std::vector<std::pair<std::string, model::Shaft>> kShafts = {
    {"clamped", model::Shaft::kClamped}, {"free", model::Shaft::kFree}, {"driven", model::Shaft::kDriven}};

}  // namespace hydro::runs
