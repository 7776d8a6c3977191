#include "diagnose/recording/sidecar_lines.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/number_text.h"
#include "base/word_list.h"
#include "runs/measured/measured_run.h"
#include "runs/measured/signal_columns.h"
#include "runs/recorded/run_table.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

// The units to name, by signal; that of the times under "time".
using Units = std::map<std::string, std::string>;

Units NamedUnits(const std::vector<RecordingMistake>& mistakes) {
  Units units;
  for (const RecordingMistake& mistake : mistakes) {
    if (mistake.time_factor != 1) units["time"] = mistake.unit;
    for (const auto& [signal, factor] : mistake.factors) {
      if (!mistake.unit.empty()) units[NameOf(signal)] = mistake.unit;
    }
    if (mistake.pressures_exchanged) std::swap(units["p1"], units["p2"]);
  }
  return units;
}

bool Same(const runs::ColumnSource& a, const runs::ColumnSource& b) {
  return a.column == b.column && a.scale == b.scale && a.offset == b.offset;
}

// A unit, and what remains of the scale beside it, say it best, because a person knows the unit.
std::string Line(const std::string& name, const runs::ColumnSource& source, const std::string& unit,
                 const std::string& ours) {
  const double of_unit = runs::UnitFactor(unit, ours).value_or(1);
  const double scale = source.scale / of_unit, offset = source.offset / of_unit;
  std::string line = name + " = { column = \"" + source.column + "\"";
  if (std::abs(scale - 1) > 1e-4) line += ", scale = " + ShortNumber(scale, 8);
  if (offset != 0) line += ", offset = " + ShortNumber(offset, 8);
  if (!unit.empty()) line += ", unit = \"" + unit + "\"";
  if (source.delay != 0) line += ", delay = " + ShortNumber(source.delay, 8);
  return line + " }";
}

std::string ShaftLine(const Run& run, model::Shaft shaft) {
  for (const auto& [name, one] : runs::kShafts) {
    if (one != shaft) continue;
    std::string line = "shaft = \"" + name + "\"";
    if (run.shaft == model::Shaft::kClamped) line += " and no arm_angle";
    if (shaft == model::Shaft::kClamped) line += " and arm_angle = the angle at which it is held";
    return line;
  }
  return "";
}

// Keeps only what the sidecar says about the columns.
Run SourcesOf(const Run& run) {
  Run sources;
  sources.time_source = run.time_source;
  for (const runs::SignalName& one : runs::kSignals) {
    (sources.*one.signal).source = (run.*one.signal).source;
    std::string& column = (sources.*one.signal).source.column;
    if (column.empty() && one.exported != nullptr) column = runs::RunColumnIn(run.units, one.exported);
  }
  if (sources.time_source.column.empty()) sources.time_source.column = "time_s";
  return sources;
}

}  // namespace

std::string SidecarLines(const std::vector<RecordingMistake>& mistakes, const Run& run) {
  const bool known = std::ranges::all_of(mistakes, [](const RecordingMistake& mistake) {
    return mistake.IsSign() || mistake.factors.empty() || !mistake.unit.empty();
  });
  if (!known) return "";
  const Run before = SourcesOf(run);
  Run after = before;
  std::vector<std::string> lines;
  for (const RecordingMistake& mistake : mistakes) {
    Correct(mistake, &after);
    if (mistake.shaft.has_value()) lines.push_back(ShaftLine(run, *mistake.shaft));
  }
  Units units = NamedUnits(mistakes);
  if (!Same(before.time_source, after.time_source)) {
    lines.push_back(Line("time", after.time_source, units["time"], "s"));
  }
  for (const runs::SignalName& one : runs::kSignals) {
    const runs::ColumnSource& now = (after.*one.signal).source;
    if (Same((before.*one.signal).source, now)) continue;
    lines.push_back(Line(runs::KeyIn(run, one), now, units[one.ours], runs::UnitIn(run, one)));
  }
  return Joined(lines, "; ");
}

std::string LineOf(const Run& run, SignalOfRun signal, const runs::ColumnSource& source) {
  const runs::SignalName& row = runs::RowOf(signal);
  return Line(runs::KeyIn(run, row), source, "", runs::UnitIn(run, row));
}

}  // namespace hydro::diagnose
