#include "batch/report/study_numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "batch/study/value.h"

namespace hydro::batch {
namespace {

constexpr size_t kMostFailures = 20;
constexpr size_t kMostCells = 40;
constexpr int kBins = 12;

// The values of a key in a few cases spread over the study; empty when one of them is not a number.
std::vector<double> SampledValues(const Study& study, size_t place) {
  constexpr int64_t kSamples = 500;
  std::vector<double> values;
  const int64_t cases = study.cases();
  for (int64_t i = 0; i < std::min(cases, kSamples); ++i) {
    const int64_t index = cases <= kSamples ? i : i * (cases / kSamples) + i % (cases / kSamples);
    const auto number = AsNumber(study.Values(index)[place]);
    if (!number) return {};
    values.push_back(*number);
  }
  return values;
}

std::optional<SurfaceAxis> AxisOf(const Study& study, const std::string& key) {
  const std::vector<std::string> keys = study.Keys();
  SurfaceAxis axis;
  axis.key = key;
  axis.place = static_cast<size_t>(std::ranges::find(keys, key) - keys.begin());
  std::vector<double> values = SampledValues(study, axis.place);
  if (axis.place < study.grid.size()) {
    values.clear();
    for (const Value& value : study.grid[axis.place].values) {
      if (!AsNumber(value)) return std::nullopt;
      values.push_back(*AsNumber(value));
    }
  }
  const std::set<double> distinct(values.begin(), values.end());
  if (distinct.size() < 2) return std::nullopt;
  if (distinct.size() <= (axis.place < study.grid.size() ? kMostCells : static_cast<size_t>(kBins))) {
    axis.centres.assign(distinct.begin(), distinct.end());
  } else {
    // Bins over most of the values. The first and the last bin take the values beyond.
    std::ranges::sort(values);
    const double low = Quantile(values, 0.01), high = Quantile(values, 0.99);
    if (!(high > low)) return std::nullopt;
    for (int i = 0; i < kBins; ++i) axis.centres.push_back(Between(low, high, (i + 0.5) / kBins, false));
  }
  for (size_t i = 0; i + 1 < axis.centres.size(); ++i)
    axis.edges.push_back(0.5 * axis.centres[i] + 0.5 * axis.centres[i + 1]);
  return axis;
}

Surface MakeSurface(const Study& study, const std::string& x, const std::string& y,
                    const std::string& number) {
  Surface surface;
  const auto x_axis = AxisOf(study, x), y_axis = AxisOf(study, y);
  if (!x_axis || !y_axis) return surface;
  surface.x = *x_axis;
  surface.y = *y_axis;
  for (size_t i = 0; i < study.collect.size(); ++i) {
    if (study.collect[i].name != number) continue;
    surface.of = &study.collect[i];
    surface.number = i;
  }
  surface.sums.assign(surface.x.centres.size() * surface.y.centres.size(), 0);
  surface.counts = surface.sums;
  return surface;
}

// The surface that the study asks for, or one over the first two keys that are numbers.
Surface WantedSurface(const Study& study) {
  const std::vector<std::string>& wanted = study.report.surface;
  if (!wanted.empty()) return MakeSurface(study, wanted[0], wanted[1], wanted[2]);
  if (study.collect.empty()) return {};
  std::vector<std::string> numeric;
  for (const std::string& key : study.Keys()) {
    if (numeric.size() < 2 && AxisOf(study, key)) numeric.push_back(key);
  }
  if (numeric.size() < 2) return {};
  const std::string number = study.report.worst.empty() ? study.collect.front().name : study.report.worst;
  return MakeSurface(study, numeric[0], numeric[1], number);
}

// Interpolates between the two values around a place. Places count from 0, and `place` is at most that of the
// last value.
double ValueAt(const std::vector<double>& values, double place) {
  const auto below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, values.size() - 1);
  return Between(values[below], values[above], place - static_cast<double>(below), false);
}

}  // namespace

size_t SurfaceAxis::CellOf(double value) const {
  return static_cast<size_t>(std::ranges::upper_bound(edges, value) - edges.begin());
}

StudyNumbers::StudyNumbers(const Study& study) : study_(study), surface_(WantedSurface(study)) {
  for (const Collected& each : study.collect) columns_.push_back({.of = &each, .values = {}, .cases = {}});
}

void StudyNumbers::Add(const TableRow& row) {
  if (row.status == CaseStatus::kFailed && failures_.size() < kMostFailures)
    failures_.push_back({row.index, row.result.reason});
  if (row.status != CaseStatus::kDone) return;
  for (size_t i = 0; i < columns_.size(); ++i) {
    const auto& value = row.result.numbers[i];
    const auto number = value ? AsNumber(*value) : std::nullopt;
    if (!number || !std::isfinite(*number)) {
      ++columns_[i].without_count;
      if (columns_[i].without.size() < kMostFailures) columns_[i].without.push_back(row.index);
      continue;
    }
    columns_[i].values.push_back(*number);
    columns_[i].cases.push_back(row.index);
    if (!surface_.there() || surface_.number != i) continue;
    const auto x = AsNumber(row.values[surface_.x.place]), y = AsNumber(row.values[surface_.y.place]);
    if (!x || !y) continue;
    const size_t cell = surface_.y.CellOf(*y) * surface_.x.centres.size() + surface_.x.CellOf(*x);
    surface_.sums[cell] += *number;
    surface_.counts[cell] += 1;
  }
}

bool StudyNumbers::any_without() const {
  return std::ranges::any_of(columns_, [](const NumberColumn& column) { return column.without_count > 0; });
}

const NumberColumn* StudyNumbers::worst() const {
  const NumberColumn* first = nullptr;
  for (const NumberColumn& column : columns_) {
    if (column.values.empty()) continue;
    if (column.of->name == study_.report.worst) return &column;
    if (first == nullptr) first = &column;
  }
  return first;
}

double Quantile(const std::vector<double>& sorted, double fraction) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  return ValueAt(sorted, fraction * static_cast<double>(sorted.size() - 1));
}

std::optional<double> NoWorse(const NumberColumn& column, const std::vector<double>& sorted,
                              double fraction) {
  const double place = fraction * static_cast<double>(column.all() - 1);
  if (sorted.empty() || place > static_cast<double>(sorted.size() - 1)) return std::nullopt;
  return ValueAt(sorted, place);
}

}  // namespace hydro::batch
