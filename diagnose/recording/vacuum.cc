#include "diagnose/recording/vacuum.h"

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::diagnose {
namespace {

// Samples whose median noise does not take below absolute zero.
constexpr size_t kStretch = 15;

bool Lasts(const std::vector<double>& values, double zero) {
  for (size_t first = 0; first + kStretch <= values.size(); first += kStretch / 2) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<double> stretch(begin, begin + kStretch);
    if (maths::Median(stretch) < zero) return true;
  }
  return false;
}

}  // namespace

std::optional<BelowVacuum> FindBelowVacuum(const model::ModelDescription& model,
                                           const runs::MeasuredSignal& pressure) {
  BelowVacuum below;
  below.zero = -model::AtmosphereOf(model);
  std::vector<double> known;
  for (const double value : pressure.values) {
    if (std::isnan(value)) continue;
    known.push_back(value);
    below.lowest = std::min(below.lowest, value);
    if (value < below.zero) ++below.samples;
  }
  if (below.samples == 0) return std::nullopt;
  below.lasting = Lasts(known, below.zero);
  return below;
}

std::string Text(const BelowVacuum& below, double factor, const std::string& unit) {
  return std::to_string(below.samples) + (below.samples == 1 ? " sample is" : " samples are") + " below " +
         ShortNumber(below.zero * factor) + " " + unit + ", a vacuum, down to " +
         ShortNumber(below.lowest * factor) + " " + unit + ": " +
         (below.lasting ? "an offset, a unit or a sign of its column, or a sensor whose zero is low?"
                        : "noise, or a sensor whose zero is low (an offset on its column)?");
}

void AddVacuumRemarks(const model::ModelDescription& model, const std::vector<runs::MeasuredRun>& runs,
                      std::vector<std::string>* lasting, std::vector<std::string>* brief) {
  const std::string unit = model.units.UnitFor("psi");
  for (const SignalOfRun side : {&runs::MeasuredRun::p1, &runs::MeasuredRun::p2}) {
    std::vector<std::string> names;
    BelowVacuum all;
    for (const runs::MeasuredRun& run : runs) {
      const std::optional<BelowVacuum> below = FindBelowVacuum(model, run.*side);
      if (!below) continue;
      names.push_back(run.name);
      all.zero = below->zero;
      all.samples += below->samples;
      all.lowest = std::min(all.lowest, below->lowest);
      all.lasting = all.lasting || below->lasting;
    }
    if (names.empty()) continue;
    (all.lasting ? lasting : brief)
        ->push_back(RunsNamed(names, runs.size()) + ": " + NameOf(side) + ": " + Text(all, 1, unit));
  }
}

}  // namespace hydro::diagnose
