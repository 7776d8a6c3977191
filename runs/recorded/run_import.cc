#include <algorithm>
#include <bit>
#include <cmath>

#include "base/host_name.h"
#include "base/input_error.h"
#include "base/number_text.h"
#include "base/units.h"
#include "bus/channels.h"
#include "runs/log/log_writer.h"
#include "runs/recorded/run_table.h"
#include "settings/model_file.h"

namespace hydro::runs {
namespace {

constexpr double kLatestTime = 1e12;              // s; in us it still fits into the log's 64 bits
constexpr double kLastTick = 9007199254740992.0;  // 2^53: above it, a double cannot hold every whole number

// Whether the export of a run in these units would have columns of these names.
bool NamesAllOf(const UnitSystem& units, const tables::Table& table) {
  std::vector<std::string> names;
  names.reserve(kRunColumns.size());
  for (const char* column : kRunColumns) names.push_back(RunColumnIn(units, column));
  return std::all_of(table.columns.begin(), table.columns.end(), [&](const tables::Column& column) {
    return std::find(names.begin(), names.end(), column.name) != names.end();
  });
}

// The usual systems first, and then all others.
std::vector<UnitSystem> Systems() {
  std::vector<UnitSystem> systems = {UnitSystem{}, kSiUnits, {"mm", "N"}, {"cm", "daN"}};
  for (const std::string_view length : UnitNames()) {
    for (const std::string_view force : UnitNames()) {
      const bool fits = ParseUnit(length)->powers == ParseUnit("m")->powers && force != "lb" &&
                        ParseUnit(force)->powers == ParseUnit("N")->powers;
      if (fits) systems.push_back({length, force});
    }
  }
  for (size_t i = 0, turning = systems.size(); i < turning; ++i) {
    systems.push_back({systems[i].length, systems[i].force, true});
  }
  return systems;
}

// The units in which the table's columns are named.
UnitSystem UnitsOfColumns(const tables::Table& table) {
  for (const UnitSystem& units : Systems()) {
    if (NamesAllOf(units, table)) return units;
  }
  for (const tables::Column& column : table.columns) {
    if (std::find(kRunColumns.begin(), kRunColumns.end(), column.name) != kRunColumns.end()) continue;
    std::string allowed;
    for (const char* name : kRunColumns) allowed += (allowed.empty() ? "" : ", ") + std::string(name);
    throw InputError(table.file + ": found the column '" + column.name + "'; allowed are " + allowed +
                     ", or all of them in other units of one system, such as p1_Pa");
  }
  return {};
}

// The table with the paper's names. Throws InputError for columns that no exported table has.
tables::Table WithPaperNames(const tables::Table& table, const UnitSystem& units) {
  tables::Table named = table;
  for (tables::Column& column : named.columns) {
    column.name = *std::find_if(kRunColumns.begin(), kRunColumns.end(),
                                [&](const char* paper) { return RunColumnIn(units, paper) == column.name; });
  }
  if (named.Find("time_s") == nullptr)
    throw InputError(table.file + ": found no column time_s; it is needed");
  return named;
}

void CheckTimes(const tables::Table& table, const std::vector<double>& times) {
  for (size_t row = 0; row < times.size(); ++row) {
    const double time = times[row];
    if (!(std::abs(time) <= kLatestTime)) {
      throw InputError(table.Place(row, "time_s") + ": found " +
                       (std::isnan(time) ? "nothing" : NumberText(time)) +
                       "; a time in s between -1e12 and 1e12 is needed");
    }
    if (row > 0 && !(time > times[row - 1])) {
      throw InputError(table.Place(row, "time_s") + ": found " + NumberText(time) + "; a time after " +
                       NumberText(times[row - 1]) + " of the row before is needed");
    }
  }
}

std::vector<int64_t> Ticks(const tables::Table& table) {
  std::vector<int64_t> ticks;
  ticks.reserve(table.rows());
  const tables::Column* column = table.Find("tick");
  for (size_t row = 0; row < table.rows(); ++row) {
    if (column == nullptr) {
      ticks.push_back(static_cast<int64_t>(row));
      continue;
    }
    const double tick = column->values[row];
    if (!(tick >= 0 && tick <= kLastTick && tick == std::floor(tick)) || std::signbit(tick)) {
      throw InputError(table.Place(row, "tick") + ": found " +
                       (std::isnan(tick) ? "nothing" : NumberText(tick)) +
                       "; a whole number from 0 to 2^53 is needed");
    }
    ticks.push_back(static_cast<int64_t>(tick));
    if (row > 0 && ticks[row] <= ticks[row - 1]) {
      throw InputError(table.Place(row, "tick") + ": found " + NumberText(tick) + "; a tick above " +
                       std::to_string(ticks[row - 1]) + " of the row before is needed");
    }
  }
  return ticks;
}

// Ticks per second if the times are even to within the rounding of their text; otherwise 0.
double Rate(const std::vector<double>& times, const std::vector<int64_t>& ticks) {
  if (times.size() < 2) return 0;
  double rate = static_cast<double>(ticks.back() - ticks.front()) / (times.back() - times.front());
  if (std::abs(rate - std::round(rate)) < 1e-6 * rate) rate = std::round(rate);
  if (!(rate > 0) || !std::isfinite(rate)) return 0;
  for (size_t row = 0; row < times.size(); ++row) {
    const double even = times.front() + static_cast<double>(ticks[row] - ticks.front()) / rate;
    if (std::abs(times[row] - even) > 1e-3 / rate) return 0;
  }
  return rate;
}

int64_t Utime(double time) { return std::llround(time * 1e6); }

bool SameBits(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }

run_description_t Describe(const tables::Table& table, const std::string& version, double rate_hz,
                           const UnitSystem& units) {
  run_description_t description{};
  description.utime = 0;
  description.config_file = table.file;
  description.program = "hydro-log";
  description.version = version;
  description.host = HostName();
  description.rate_hz = rate_hz;
  // Nothing is known about the model except its units.
  description.model_text = settings::UnitsText(units);
  return description;
}

// A column's values, or missing ones where the table has no such column.
class Values {
 public:
  Values(const tables::Table& table, const char* name) : column_(table.Find(name)) {}
  bool present() const { return column_ != nullptr; }
  double operator[](size_t row) const { return column_ != nullptr ? column_->values[row] : tables::kMissing; }

 private:
  const tables::Column* column_;
};

// Writes a table, which has been checked, as the messages of a run.
class Import {
 public:
  Import(const tables::Table& table, log::LogWriter& log)
      : log_(log),
        times_(table.Find("time_s")->values),
        ticks_(Ticks(table)),
        voltage_(table, "voltage_V"),
        pressure_ref_(table, "pressure_ref_psi"),
        arm_ref_(table, "arm_ref_rad"),
        motor_angle_(table, "motor_angle_rad"),
        motor_speed_(table, "motor_speed_rad_s"),
        arm_angle_(table, "arm_angle_rad"),
        arm_speed_(table, "arm_speed_rad_s"),
        p1_(table, "p1_psi"),
        p2_(table, "p2_psi") {}

  void AppendDescription(run_description_t description) {
    description.utime = Utime(times_.front());
    log_.AppendMessage(channels_.Of<run_description_t>(), description, description.utime);
  }

  void AppendRow(size_t row) {
    AppendState(row);
    // A reference holds until the next one, so a missing value after a reference is a change of its own.
    if (!SameBits(arm_ref_[row], last_reference_)) AppendReference(row);
    AppendCommands(row);
  }

 private:
  void AppendState(size_t row) {
    state_t state{};
    state.utime = Utime(times_[row]);
    state.tick = ticks_[row];
    state.sequence = static_cast<int64_t>(row);
    state.time = times_[row];
    state.motor_angle = motor_angle_[row];
    state.motor_speed = motor_speed_[row];
    state.arm_angle = arm_angle_[row];
    state.arm_speed = arm_speed_[row];
    state.p1 = p1_[row];
    state.p2 = p2_[row];
    // A table does not tell what acted before its first row, so the actuator is assumed to have been at rest.
    state.voltage = row > 0 ? voltage_[row - 1] : voltage_.present() ? 0 : tables::kMissing;
    state.command_tick = row > 0 && voltage_.present() ? ticks_[row] - 1 : -1;
    log_.AppendMessage(channels_.Of<state_t>(), state, state.utime);
  }

  void AppendReference(size_t row) {
    arm_reference_t message{};
    message.utime = Utime(times_[row]);
    message.tick = ticks_[row];
    message.sequence = reference_sequence_++;
    message.signal = arm_reference_t::ARM_ANGLE;
    message.value = last_reference_ = arm_ref_[row];
    log_.AppendMessage(channels_.Of<arm_reference_t>(), message, message.utime);
  }

  // The command of tick k acts from tick k + 1 on (the delay that an empty configuration means), so the
  // command of the tick before carries the last row's voltage.
  void AppendCommands(size_t row) {
    const size_t rows = times_.size();
    const int64_t utime = Utime(times_[row]);
    const bool next_acts = row + 1 < rows && ticks_[row + 1] == ticks_[row] + 1;
    const bool last_follows = row + 2 == rows;
    if (row + 1 == rows && !std::isnan(voltage_[row]) && (row == 0 || ticks_[row - 1] + 1 != ticks_[row])) {
      AppendCommand(utime, ticks_[row] - 1, voltage_[row], tables::kMissing);
    }
    if (!std::isnan(pressure_ref_[row]) || (next_acts && last_follows && !std::isnan(voltage_[row + 1]))) {
      AppendCommand(utime, ticks_[row], next_acts ? voltage_[row + 1] : tables::kMissing, pressure_ref_[row]);
    }
  }

  void AppendCommand(int64_t utime, int64_t tick, double volts, double reference) {
    motor_command_t command{};
    command.utime = utime;
    command.tick = tick;
    command.sequence = motor_sequence_++;
    command.voltage = volts;
    command.pressure_ref = reference;
    command.pressure_command_tick = std::isnan(reference) ? -1 : tick;
    command.status = motor_command_t::LAW;
    log_.AppendMessage(channels_.Of<motor_command_t>(), command, utime);
  }

  log::LogWriter& log_;
  const std::vector<double>& times_;
  const std::vector<int64_t> ticks_;
  const Values voltage_, pressure_ref_, arm_ref_, motor_angle_, motor_speed_, arm_angle_, arm_speed_, p1_,
      p2_;
  const bus::Channels channels_;
  int64_t motor_sequence_ = 0;
  int64_t reference_sequence_ = 0;
  double last_reference_ = tables::kMissing;
};

}  // namespace

void ImportRun(const tables::Table& given, const std::string& program_version, const std::string& log_file) {
  const UnitSystem units = UnitsOfColumns(given);
  const tables::Table table = WithPaperNames(given, units);
  const std::vector<double>& times = table.Find("time_s")->values;
  CheckTimes(table, times);
  const run_description_t description = Describe(table, program_version, Rate(times, Ticks(table)), units);
  log::LogWriter log(log_file, Opening::kTemporary);
  Import import(table, log);
  import.AppendDescription(description);
  for (size_t row = 0; row < table.rows(); ++row) import.AppendRow(row);
  log.Finish();
}

}  // namespace hydro::runs
