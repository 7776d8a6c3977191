#include "diagnose/say/error_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "model/terms/state.h"

namespace hydro::diagnose {
namespace {

constexpr std::array<std::pair<size_t, model::Channel>, 4> kMoving = {
    {{model::kMotorAngle, model::Channel::kMotorAngle},
     {model::kMotorSpeed, model::Channel::kMotorSpeed},
     {model::kArmAngle, model::Channel::kArmAngle},
     {model::kArmSpeed, model::Channel::kArmSpeed}}};

double GrowthIn(const model::ModelDescription& model, const RunData& run) {
  std::vector<model::Unknown> starts;
  std::vector<size_t> signals;  // of each start
  for (const auto& [state, channel] : kMoving) {
    const SignalData* signal = run.Find(channel);
    if (signal == nullptr || !run.start_free[state]) continue;
    starts.push_back({model::Unknown::Kind::kStart, state});
    signals.push_back(static_cast<size_t>(signal - run.signals.data()));
  }
  double growth = 1;
  try {
    const Residuals at = ResidualsOf(model, run, run.start, {}, starts);
    const size_t rows = at.values.size();
    for (size_t i = 0; i < starts.size(); ++i) {
      for (size_t row = at.first[signals[i]]; row < at.first[signals[i] + 1]; ++row) {
        const double moved = std::abs(at.jacobian[i * rows + row]) * run.signals[signals[i]].noise;
        if (std::isfinite(moved)) growth = std::max(growth, moved);
      }
    }
  } catch (const model::ModelError&) {
    return 1;
  }
  return growth;
}

}  // namespace

double ErrorGrowth(const model::ModelDescription& model, const std::vector<const RunData*>& runs, int jobs) {
  std::vector<double> growths(runs.size(), 1);
  ParallelFor(runs.size(), jobs, [&](size_t r) { growths[r] = GrowthIn(model, *runs[r]); });
  return growths.empty() ? 1 : *std::ranges::max_element(growths);
}

}  // namespace hydro::diagnose
