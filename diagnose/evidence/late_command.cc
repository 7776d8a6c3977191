#include "diagnose/evidence/late_command.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/input_error.h"
#include "base/maths/spread.h"
#include "base/parallel.h"
#include "base/word_list.h"
#include "diagnose/balances/make_rows.h"
#include "diagnose/balances/rows_to_read.h"
#include "diagnose/evidence/clocks.h"
#include "diagnose/evidence/late_signals.h"
#include "diagnose/evidence/set_evidence.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/recording/sidecar_lines.h"
#include "model/terms/parameter_info.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Eigen::VectorXd;
using Run = runs::MeasuredRun;

// Rows: prior standard deviation of the command's lateness. Without it, half a row would hold the estimate.
constexpr double kPriorRows = 3;
// Rows: motor and pressures that differ by more are not one device, and the command is late against neither.
constexpr double kOneDevice = 0.5;
// Rows: nearer to a whole row than to none, and right once it is moved by that many.
constexpr double kHalfARow = 0.5, kRight = 0.3;
// Rows by which a recorder is late at most. The estimate is of the first order in the lateness: a few steps
// lead to a command that is several rows away.
constexpr int kMostRows = 5, kMostTries = 4;
// Beyond kLeastDelay, lateness is no small change of what the balances see, and another clock's. Rows of 5 ms
// are not always quite 5 ms apart.
constexpr double kRounding = 1.005;
// Standard errors.
constexpr double kSurelyLate = 2;
// Rows: an error as large cannot tell one row from none.
constexpr double kLargestError = 0.25;
// Rows: what lags and delays below a sample do to each run, however quiet its sensors are.
constexpr double kAnywayLate = 0.05;
// Samples: of all runs together, and of each at least. Where the command changes most it is seen best.
constexpr size_t kMostSamplesRead = 40000, kFewestOfEach = 2000;
// Relative: tables of one recorder have the same interval.
constexpr double kSameInterval = 0.01;

bool CanTellRows(const Run& run) {
  return !run.sidecar.empty() && (run.motor_speed.measured() || run.motor_angle.measured()) &&
         run.samples() >= 2 * kFewestSamples && runs::MedianInterval(run.time) <= runs::kSlowestSamples;
}

// The weights of a contrast: how late the one signal is against the mean of the others.
VectorXd Against(const SetFit& fit, const Rows& rows, const std::string& one,
                 const std::vector<std::string>& others) {
  VectorXd weights = VectorXd::Zero(fit.amounts.size());
  for (size_t i = 0; i < fit.columns.size(); ++i) {
    const std::string& name = rows.columns[static_cast<size_t>(fit.columns[i])].name;
    if (name == one) weights[static_cast<Eigen::Index>(i)] = 1;
    if (std::ranges::find(others, name) != others.end())
      weights[static_cast<Eigen::Index>(i)] = -1.0 / static_cast<double>(others.size());
  }
  return weights;
}

// The stretch of so many samples in which the command changes most.
Run BusiestStretch(Run run, size_t count) {
  if (run.samples() <= count) return run;
  std::vector<double> changed(run.samples(), 0.0);
  for (size_t i = 1; i < changed.size(); ++i)
    changed[i] = changed[i - 1] + std::abs(run.voltage.values[i] - run.voltage.values[i - 1]);
  const size_t first = StartOfBusiest(changed, count);
  run.Keep(first, first + count);
  return run;
}

// What one run shows; nothing where it shows nothing.
std::optional<LateCommand> LateIn(const model::ModelDescription& given, const Run& recorded, int moved) {
  const double step = runs::MedianInterval(recorded.time);
  Run run = recorded;
  if (!runs::RemoveDelays({{&Run::voltage, moved * step}}, &run)) return std::nullopt;
  const RunData data = PrepareRun(std::move(run), given);
  ScanOptions options;
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) options.allowed.push_back(i);
  options.only_always = true;
  ScanRuns scanned(given, {&data}, options);
  Rows rows = scanned.MakeRows({});
  const bool torque = std::ranges::any_of(
      rows.blocks, [](const RowBlock& block) { return block.balance == BalanceKind::kTorque; });
  if (!torque) return std::nullopt;
  FreeBaseValues(&rows);
  for (size_t i = 0; i < rows.columns.size(); ++i) {
    if (rows.columns[i].name != "late.voltage") continue;
    const auto place = static_cast<Eigen::Index>(i);
    rows.columns[i].sd = kPriorRows * step;
    rows.prior(place, place) = rows.columns[i].sd * rows.columns[i].sd;
  }
  const SetFit fit = SetEvidence(rows).Fit({});
  const auto estimate = [&](const VectorXd& weights) {
    return LateCommand{weights.dot(fit.amounts) / step,
                       std::sqrt(weights.dot(fit.covariance * weights)) / step};
  };
  const bool pressures = scanned.motions().front().pressures;
  if (pressures) {
    const LateCommand apart = estimate(Against(fit, rows, "late.motor_speed", {"late.p"}));
    if (std::abs(apart.rows) > kOneDevice + kSurelyLate * apart.error) return std::nullopt;
  }
  const std::vector<std::string> others = pressures ? std::vector<std::string>{"late.motor_speed", "late.p"}
                                                    : std::vector<std::string>{"late.motor_speed"};
  return estimate(Against(fit, rows, "late.voltage", others));
}

// The mean of what all runs say. Their scatter counts as an error: what the model lacks differs by run.
LateCommand MeanLateness(const std::vector<std::optional<LateCommand>>& all) {
  double weights = 0, sum = 0;
  for (const std::optional<LateCommand>& one : all) {
    if (!one) continue;
    const double weight = 1 / (one->error * one->error + kAnywayLate * kAnywayLate);
    weights += weight;
    sum += weight * one->rows;
  }
  if (!(weights > 0)) return {0, std::numeric_limits<double>::infinity()};
  const double mean = sum / weights;
  double squares = 0, count = 0;
  for (const std::optional<LateCommand>& one : all) {
    if (!one) continue;
    squares +=
        (one->rows - mean) * (one->rows - mean) / (one->error * one->error + kAnywayLate * kAnywayLate);
    ++count;
  }
  const double scatter = count > 1 ? std::max(1.0, squares / (count - 1)) : 1;
  return {mean, std::sqrt(scatter / weights)};
}

std::string LineFor(const std::vector<Run>& runs, int moved) {
  std::vector<std::string> names, sidecars;
  for (const Run& run : runs) {
    names.push_back(run.name);
    const std::string name = run.sidecar.substr(run.sidecar.find_last_of('/') + 1);
    if (std::ranges::find(sidecars, name) == sidecars.end()) sidecars.push_back(name);
  }
  runs::ColumnSource moved_source = runs.front().voltage.source;
  moved_source.delay += moved * runs::MedianInterval(runs.front().time);
  return "in " + Enumerated(sidecars) +
         ", under [columns], mends it: " + LineOf(runs.front(), &Run::voltage, moved_source);
}

// The line for the runs of one recorder; empty: the command is where it belongs, or nobody can tell.
std::string RemarkOn(const model::ModelDescription& given, const std::vector<Run>& runs, int* moved,
                     int jobs) {
  LateCommand rest = FindLateCommand(given, runs, 0, jobs);
  if (!(std::abs(rest.rows) > kHalfARow + kSurelyLate * rest.error)) return "";
  // A command that is early may be an amplifier that is late, and then by any time.
  const double step = runs::MedianInterval(runs.front().time);
  const int earliest = -1,
            latest = std::clamp(static_cast<int>(kRounding * kLeastDelay / step), 1, kMostRows);
  for (int tried = 0; tried < kMostTries && std::abs(rest.rows) > kHalfARow; ++tried) {
    const int next = std::clamp(*moved + static_cast<int>(std::lround(rest.rows)), earliest, latest);
    if (next == *moved) return "";
    *moved = next;
    rest = FindLateCommand(given, runs, *moved, jobs);
  }
  if (*moved == 0 || !(std::abs(rest.rows) < kRight && rest.error < kLargestError)) return "";
  std::vector<std::string> names;
  names.reserve(runs.size());
  for (const Run& run : runs) names.push_back(run.name);
  const double rows = *moved + rest.rows;
  const std::string size =
      maths::PlusMinus({std::abs(rows), std::abs(rows) - 2 * rest.error, std::abs(rows) + 2 * rest.error});
  const std::string key = runs::KeyIn(runs.front(), runs::kSignals.front());
  const std::string who = RunsNamed(names) + ": the " + key + " is " + (*moved > 0 ? "late" : "early") +
                          " by " + size + " rows against all other signals: ";
  if (*moved == 1) return who + "a row holds what acted before it. This " + LineFor(runs, *moved);
  if (*moved > 1) {
    return who + "a row holds what acted " + std::to_string(*moved) + " rows before. This " +
           LineFor(runs, *moved);
  }
  return who +
         "a row holds what acts from the next row on, or the amplifier is as late (amp.delay). If it "
         "is the recording, this " +
         LineFor(runs, *moved);
}

}  // namespace

LateCommand FindLateCommand(const model::ModelDescription& given, const std::vector<Run>& runs, int moved,
                            int jobs) {
  std::vector<std::optional<LateCommand>> all(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    try {
      all[r] = LateIn(given, runs[r], moved);
    } catch (const InputError&) {  // reported for the run itself, where it is prepared
    } catch (const model::ModelError&) {
    }
  });
  return MeanLateness(all);
}

CommandRemarks RemarksOnCommands(const model::ModelDescription& given, const std::vector<Run>& runs,
                                 int jobs) {
  std::vector<std::vector<Run>> recorders;
  const size_t each = std::max(kFewestOfEach, kMostSamplesRead / std::max<size_t>(1, runs.size()));
  for (const Run& whole : runs) {
    if (!CanTellRows(whole)) continue;
    const Run run = BusiestStretch(whole, each);
    const auto same = std::ranges::find_if(recorders, [&](const std::vector<Run>& one) {
      const double interval = runs::MedianInterval(one.front().time);
      const bool as_fast = std::abs(runs::MedianInterval(run.time) - interval) < kSameInterval * interval;
      return as_fast && one.front().voltage.source.column == run.voltage.source.column &&
             one.front().voltage.source.delay == run.voltage.source.delay;
    });
    if (same == recorders.end()) {
      recorders.push_back({run});
    } else {
      same->push_back(run);
    }
  }
  CommandRemarks remarks;
  for (const std::vector<Run>& one : recorders) {
    int moved = 0;
    const std::string line = RemarkOn(given, one, &moved, jobs);
    if (!line.empty()) (moved > 0 ? remarks.late : remarks.early).push_back(line);
  }
  return remarks;
}

}  // namespace hydro::diagnose
