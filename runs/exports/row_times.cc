#include "runs/exports/row_times.h"

#include <algorithm>
#include <limits>

namespace hydro::exports {

void RowTimes::Add(const state_t& state) {
  if (plants_.empty() || plants_.back().session != state.session)
    plants_.push_back({state.session, {}, false});
  plants_.back().ticks.emplace_back(state.tick, state.time);
  plants_.back().sorted = false;
  latest_ = state.time;
}

RowTimes::Mark RowTimes::Here(std::optional<int64_t> tick) const {
  // A message before the first state may have a tick of the first plant.
  if (plants_.empty()) return {0, tick, std::numeric_limits<double>::quiet_NaN()};
  return {plants_.size() - 1, tick, latest_};
}

double RowTimes::At(const Mark& mark) {
  if (!mark.tick || mark.plant >= plants_.size()) return mark.latest;
  Plant& plant = plants_[mark.plant];
  const auto before = [](const auto& a, const auto& b) { return a.first < b.first; };
  if (!plant.sorted && !std::is_sorted(plant.ticks.begin(), plant.ticks.end(), before)) {
    std::stable_sort(plant.ticks.begin(), plant.ticks.end(), before);
  }
  plant.sorted = true;
  const auto found =
      std::lower_bound(plant.ticks.begin(), plant.ticks.end(), std::pair(*mark.tick, 0.0), before);
  return found != plant.ticks.end() && found->first == *mark.tick ? found->second : mark.latest;
}

}  // namespace hydro::exports
