#include "diagnose/locate/pressure_offsets.h"

#include <algorithm>
#include <cmath>

#include "diagnose/data/observed_mode.h"
#include "model/equations/equations.h"

namespace hydro::diagnose {

namespace {

// The lowest pressure at which a side rests: where the one-way valve holds it. NaN if it does not show.
double Floor(const std::vector<const RunData*>& runs, model::Channel channel) {
  double floor = NAN;
  for (const RunData* run : runs) {
    const SignalData* const signal = run->Find(channel);
    if (signal == nullptr) continue;
    const ObservedMode observed = ObserveMode(*run);
    std::vector<double> values = channel == model::Channel::kP1 ? observed.p1 : observed.p2;
    std::erase_if(values, [](double value) { return std::isnan(value); });
    if (values.size() < 100) continue;
    std::sort(values.begin(), values.end());
    // A plateau: a twentieth of the samples agree within the noise.
    const double margin = 2 * (channel == model::Channel::kP1 ? observed.p1_margin : observed.p2_margin);
    const size_t low = values.size() / 100;
    const size_t high = values.size() / 20;
    if (values[high] - values[low] > margin) continue;
    const auto end = std::upper_bound(values.begin(), values.end(), values[low] + margin);
    const double middle = values[static_cast<size_t>(end - values.begin()) / 2];
    floor = std::isnan(floor) ? middle : std::min(floor, middle);
  }
  return floor;
}

}  // namespace

PressureOffsets RestOffsets(const model::ModelDescription& model, const std::vector<const RunData*>& runs) {
  const double floor_1 = Floor(runs, model::Channel::kP1), floor_2 = Floor(runs, model::Channel::kP2);
  double noise = 0;
  for (const RunData* run : runs) {
    for (const model::Channel channel : {model::Channel::kP1, model::Channel::kP2}) {
      if (const SignalData* signal = run->Find(channel)) noise = std::max(noise, signal->noise);
    }
  }
  if (std::isnan(floor_1) || std::isnan(floor_2)) return {};
  // What the model's own transducers read at that pressure.
  const model::Equations equations(model, model::ActuatorOptions{});
  double state[model::kMaxStates];
  model::Mode mode;
  equations.Start(model.parameters.p_3, state, &mode);
  const model::Measurement read = equations.Measure(0, state);
  const PressureOffsets offsets = {floor_1 - read.p1, floor_2 - read.p2};
  if (std::abs(offsets.p1 - offsets.p2) < 3 * noise) return {};
  return offsets;
}

}  // namespace hydro::diagnose
