#include "runs/signal_columns.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/number_text.h"

namespace hydro::runs {

bool AllMissing(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

std::vector<double> SignalValues(const tables::Table& table, const SignalColumn& source) {
  std::vector<double> values;
  values.reserve(table.rows());
  for (const double theirs : source.column->values) {
    values.push_back(source.unit * (source.scale * theirs + source.offset));
    if (std::isinf(values.back())) {
      throw InputError(table.Place(values.size() - 1, source.column->name) +
                       ": found an infinite value, allowed finite numbers, nan or an empty cell");
    }
  }
  return values;
}

std::vector<double> SampleTimes(const tables::Table& table, const SignalColumn& source) {
  std::vector<double> times = SignalValues(table, source);
  for (size_t i = 0; i < times.size(); ++i) {
    if (!std::isnan(times[i]) && (i == 0 || times[i] > times[i - 1])) continue;
    const std::string found = std::isnan(times[i]) ? "no value" : ShortestNumber(times[i]) + " s";
    const std::string allowed =
        i == 0 ? "a time" : "a time above " + ShortestNumber(times[i - 1]) + " s, that of the row before";
    throw InputError(table.Place(i, source.column->name) + ": found " + found + ", allowed " + allowed);
  }
  if (times.size() < 2) {
    throw InputError(table.Place(0, source.column->name) + ": found one row, allowed two or more");
  }
  return times;
}

std::vector<double> CommandValues(const tables::Table& table, const SignalColumn& source,
                                  const std::string& what) {
  std::vector<double> command = SignalValues(table, source);
  if (std::isnan(command.front())) {
    throw InputError(table.Place(0, source.column->name) + ": found no " + what +
                     " in the first row, allowed a number there: the command is held from "
                     "row to row, so cut off the rows before its first one");
  }
  for (size_t i = 1; i < command.size(); ++i) {
    if (std::isnan(command[i])) command[i] = command[i - 1];
  }
  return command;
}

}  // namespace hydro::runs
