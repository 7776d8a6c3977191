// A run as it was measured: what there is to fit a model to. Read from a log, or from a table of another
// recorder with a sidecar that says what its columns are (docs/measured_runs.md).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "model/terms/actuator_options.h"
#include "tables/table.h"

namespace hydro::runs {

struct MeasuredSignal {
  std::vector<double> values;   // one a sample, in our units; NaN: missing there. Empty: not measured
  std::optional<double> noise;  // standard deviation, where it is known; above 0

  bool measured() const { return !values.empty(); }
};

// Units: s, V, psi, rad, or whatever else the model's coherent units are.
struct MeasuredRun {
  std::string name;           // what it calls itself; a log: the file's stem
  std::string file;           // as given
  std::vector<size_t> lines;  // of a CSV: the line of each row; empty: messages count rows, from 1

  model::Shaft shaft = model::Shaft::kFree;
  double arm_angle_rad = 0;  // kClamped: where the arm is held
  bool bypass = false;       // the valve between the two sides is open: p1 = p2

  std::string model_text;  // the model that a log says it was run with (TOML); "" for tables

  size_t first_row = 0;  // rows of the file before the first sample, cut off

  std::vector<double> time;     // s, finite and increasing, not always evenly; two samples or more
  MeasuredSignal voltage;       // command of eq. (1), held from each sample to the next; nothing is missing
  MeasuredSignal pressure_ref;  // of p2 - p1
  MeasuredSignal motor_speed;
  MeasuredSignal motor_angle;
  MeasuredSignal arm_angle;  // always measured when the shaft is driven
  MeasuredSignal arm_speed;
  MeasuredSignal p1;
  MeasuredSignal p2;

  size_t samples() const { return time.size(); }
  // Cuts off the samples before `first` and those from `last` on.
  void Keep(size_t first, size_t last);
  // Where a sample stands, for messages: "run.csv: line 17".
  std::string Place(size_t sample) const;
};

// Reads a run: FILE.csv or FILE.mat with its sidecar FILE.toml, any other name as a log. Throws InputError
// naming file, line or key, what was found and what is allowed:
// - of a sidecar: that is missing, unknown keys, no shaft, no column for time or voltage, an angle of a shaft
//   that is not clamped, a driven shaft without arm_angle, noise of a signal that has no column;
// - of the table: columns that are not there or hold no value, numbers that are not finite, times that are
//   missing or do not increase, a command that is missing in the first row;
// - of a log: damage, messages that cannot be decoded, more than one run, no description of how the shaft
// was held.
MeasuredRun ReadMeasuredRun(const std::string& file);

// The run that a table of hydro-log export (runs/run_table.h) holds; `config_text` is the configuration it
// was run with: shaft and bypass are taken from it, and what noise the sensors are said to have.
MeasuredRun RunOfExport(const tables::Table& table, const std::string& config_text,
                        const std::string& model_text);

}  // namespace hydro::runs
