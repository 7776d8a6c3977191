#include "runs/measured/table_times.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/maths/spread.h"
#include "base/number_text.h"

namespace hydro::runs {
namespace {

constexpr double kDay = 86400, kHour = 3600;  // s

// The usual time between two rows; 0 where no row is later than the one before.
double UsualStep(const std::vector<double>& times) {
  std::vector<double> steps;
  for (size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) steps.push_back(times[i] - times[i - 1]);
  }
  return steps.empty() ? 0 : maths::Median(std::move(steps));
}

std::string RowName(const tables::Table& table, size_t row) {
  return table.lines.empty() ? "row " + std::to_string(row + 1) : "line " + std::to_string(table.lines[row]);
}

bool Repeats(const tables::Table& table, size_t row) {
  return std::all_of(table.columns.begin(), table.columns.end(), [row](const tables::Column& column) {
    const double now = column.values[row], before = column.values[row - 1];
    return now == before || (std::isnan(now) && std::isnan(before));
  });
}

void LeaveOutRepeated(const tables::Column& time, tables::Table* table) {
  std::vector<bool> keep(table->rows(), true);
  size_t repeated = 0, first = 0;
  for (size_t row = 1; row < table->rows(); ++row) {
    if (std::isnan(time.values[row]) || !Repeats(*table, row)) continue;
    keep[row] = false;
    if (repeated++ == 0) first = row;
  }
  if (repeated == 0) return;
  const std::string place = RowName(*table, first);
  table->Note(repeated == 1
                  ? "a row left out that repeats the one before, time and all (" + place + ")"
                  : std::to_string(repeated) +
                        " rows left out that repeat the one before, time and all (the first: " + place + ")");
  const auto thin = [&keep](auto* values) {
    size_t next = 0;
    for (size_t row = 0; row < keep.size(); ++row) {
      if (keep[row]) (*values)[next++] = (*values)[row];
    }
    values->resize(next);
  };
  for (tables::Column& column : table->columns) thin(&column.values);
  if (!table->lines.empty()) thin(&table->lines);
}

struct RollOver {
  double period = 0;  // in the column's own numbers
  std::string of;     // "a counter of 32 bits"
};

// Whether a counter of that many steps of 10^-k, which starts at 0 or at minus half its period, may stand at
// `from` and then at `to`.
bool MayRoll(double from, double to, double period, double slack) {
  const bool unsigned_one = from > period - slack && from < period + slack && to > -slack && to < slack;
  const bool signed_one = from > period / 2 - slack && from < period / 2 + slack &&
                          to > -period / 2 - slack && to < -period / 2 + slack;
  return unsigned_one || signed_one;
}

// Finds what rolled over between two rows when the second is below the first.
std::optional<RollOver> FindRollOver(double from, double to, double step, double to_seconds,
                                     tables::TimeKind kind) {
  const double period = from - to + step;  // with the usual step between the two rows
  const double slack = 3 * step;           // a few rows may be missing
  const auto is = [&](double one) { return std::abs(period - one) < slack; };
  for (const int bits : {16, 24, 32}) {
    for (int decimals = 0; decimals <= 9; ++decimals) {
      const double one = std::ldexp(1, bits) / std::pow(10, decimals);
      if (is(one) && step < one / 100 && MayRoll(from, to, one, slack))
        return RollOver{one, "a counter of " + std::to_string(bits) + " bits"};
    }
  }
  const double day = kDay / to_seconds;
  if (kind != tables::TimeKind::kWholeNumbers && is(day) && MayRoll(from, to, day, slack))
    return RollOver{day, "midnight"};
  return std::nullopt;
}

std::string Counted(const char* what, size_t times, const tables::Table& table, size_t first,
                    const std::string& of) {
  return std::string("times counted on where ") + what +
         (times == 1 ? " (" : " (" + std::to_string(times) + " times; the first: ") + RowName(table, first) +
         ": " + of + ")";
}

void CountOn(const SignalColumn& source, std::vector<double>& times, tables::Table* table) {
  const double step = UsualStep(times), to_seconds = std::abs(source.unit * source.scale);
  if (step <= 0 || source.unit * source.scale <= 0) return;
  double added = 0, before = times.empty() ? 0 : times.front();
  size_t rolled = 0, first_rolled = 0, set = 0, first_set = 0;
  std::string of;
  for (size_t row = 1; row < times.size(); ++row) {
    const double now = times[row];
    if (std::isnan(now) || std::isnan(before)) return;  // SampleTimes reports this
    const double change = now - before;
    if (change < 0) {
      if (const auto roll = FindRollOver(before, now, step, to_seconds, table->time_kind)) {
        added += roll->period;
        if (rolled++ == 0) {
          first_rolled = row;
          of = ShortestNumber(before) + " to " + ShortestNumber(now) + ", " + roll->of;
        }
      }
    }
    if (table->time_kind == tables::TimeKind::kLocalClock && std::abs(std::abs(change) - kHour) < 3 * step) {
      added -= change > 0 ? kHour : -kHour;
      if (set++ == 0) first_set = row;
    }
    before = now;
    times[row] = now + added;
  }
  if (rolled > 0) table->Note(Counted("they roll over", rolled, *table, first_rolled, of));
  if (set > 0) table->Note(Counted("the clock was set by an hour", set, *table, first_set, "summer time"));
}

// Throws where times do not increase. The error has the first such row, the number of such rows and a remedy.
// SampleTimes handles the first row and missing times.
void RequireIncreasing(const SignalColumn& source, const tables::Table& table) {
  const std::vector<double>& times = source.column->values;
  const double to_seconds = source.unit * source.scale;
  size_t wrong = 0, equal = 0, first = 0;
  for (size_t row = 1; row < times.size(); ++row) {
    if (std::isnan(times[row]) || std::isnan(times[row - 1])) return;
    if (to_seconds * times[row] > to_seconds * times[row - 1]) continue;
    if (wrong++ == 0) first = row;
    equal += times[row] == times[row - 1];
  }
  if (wrong == 0) return;
  const auto seconds = [&](size_t row) {
    return ShortestNumber(source.unit * (source.scale * times[row] + source.offset)) + " s";
  };
  std::string error = table.Place(first, source.column->name) + ": found " + seconds(first) +
                      ", allowed a time above " + seconds(first - 1) + ", that of the row before";
  if (wrong > 1)
    error += "; " + std::to_string(wrong) + " of " + std::to_string(times.size()) + " rows are like that";
  if (equal == wrong && wrong > 1) {
    const double even = to_seconds * (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    error +=
        ": the times are rounded; export them with more digits, or, where the rows are evenly spaced, set "
        "time = { "
        "every = " +
        (even > 0 ? ShortNumber(even, 3) : "T") + " } in the sidecar, s from row to row" +
        (even > 0 ? "" : ", T by the recorder's settings");
  } else if (equal == wrong) {
    error += ": take one of the two out";
  } else if (equal == 0 && wrong + 1 == times.size() && wrong > 1) {
    error += ": the last row is the first in time; sort the rows by time";
  } else {
    error += ": where the recorder began again, cut the table in two, a run each";
  }
  throw InputError(error);
}

// Rows that come in bursts: how many rows each has, and how far apart the bursts begin.
struct Bursts {
  size_t count = 0;
  double rows = 0;      // median
  double duration = 0;  // median time from the first to the last of those rows
  double period = 0;    // median
};

// Finds bursts that are far shorter than the time between them, in a table that consists almost entirely of
// such bursts.
std::optional<Bursts> FindBursts(const std::vector<double>& times) {
  constexpr double kShort = 0.02;  // of the period
  constexpr size_t kFewest = 8;
  constexpr double kFewestRows = 4;
  if (times.size() < kFewest * static_cast<size_t>(kFewestRows)) return std::nullopt;
  const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  std::vector<double> rows, durations, periods;
  size_t begin = 0;
  for (size_t row = 1; row < times.size(); ++row) {
    if (times[row] - times[row - 1] < mean) continue;
    rows.push_back(static_cast<double>(row - begin));
    durations.push_back(times[row - 1] - times[begin]);
    periods.push_back(times[row] - times[begin]);
    begin = row;
  }
  if (rows.size() < kFewest) return std::nullopt;
  const Bursts bursts{rows.size(), maths::Median(rows), maths::Median(durations), maths::Median(periods)};
  const auto alike = std::count_if(periods.begin(), periods.end(), [&](double period) {
    return std::abs(period - bursts.period) < 0.25 * bursts.period;
  });
  const bool regular = 10 * alike >= 8 * static_cast<std::ptrdiff_t>(periods.size());
  if (bursts.rows < kFewestRows || bursts.duration > kShort * bursts.period || !regular) return std::nullopt;
  return bursts;
}

std::string Shown(double seconds) {
  const bool micro = seconds < 1e-3, milli = seconds < 1;
  return micro   ? ShortNumber(1e6 * seconds, 2) + " us"
         : milli ? ShortNumber(1e3 * seconds, 3) + " ms"
                 : ShortNumber(seconds, 3) + " s";
}

void RequireNoBursts(const SignalColumn& source, const tables::Table& table) {
  std::vector<double> times = source.column->values;
  for (double& time : times) time *= source.unit * source.scale;
  const std::optional<Bursts> bursts = FindBursts(times);
  if (!bursts.has_value()) return;
  const double even = bursts->period / bursts->rows;
  throw InputError(table.Place(0, source.column->name) + ": found samples in bursts, " +
                   ShortNumber(bursts->rows, 4) + " within " + Shown(bursts->duration) + " each " +
                   Shown(bursts->period) +
                   ", allowed the times at which they were taken: these are probably their times of arrival; "
                   "evenly spaced samples "
                   "would be " +
                   Shown(even) + " apart: where they are, set time = { every = " + ShortNumber(even, 3) +
                   " } in the sidecar");
}

// Whether several rows have the same time as the row before but other values, which means that their times
// are rounded.
bool SharesTimes(const tables::Column& time, const tables::Table& table) {
  size_t equal = 0, changed = 0;
  for (size_t row = 1; row < time.values.size(); ++row) {
    if (time.values[row] != time.values[row - 1]) continue;
    ++equal;
    changed += !Repeats(table, row);
  }
  return changed > 0 && equal > 1;
}

}  // namespace

void MendTimes(const SignalColumn& source, tables::Table* table) {
  const auto column = std::find_if(table->columns.begin(), table->columns.end(),
                                   [&](const tables::Column& one) { return &one == source.column; });
  if (column == table->columns.end()) return;
  std::vector<double> times = column->values;
  CountOn(source, times, table);
  column->values = std::move(times);
  // Where other rows share a time but differ, rows that happen to be equal are samples too.
  if (!SharesTimes(*column, *table)) LeaveOutRepeated(*column, table);
  RequireIncreasing(source, *table);
  RequireNoBursts(source, *table);
}

}  // namespace hydro::runs
