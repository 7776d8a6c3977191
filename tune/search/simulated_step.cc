#include "tune/search/simulated_step.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <hydro/state_t.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bus/channels.h"
#include "runs/step_response.h"
#include "sim/simulation.h"

namespace hydro::tune {
StepResult SimulateStep(settings::StackConfig config, const StepCase& step) {
  const double interval = config.position.sample_interval_s;
  // With a weight, the arm first comes to rest where it hangs.
  const double rest = config.model.description.parameters.mgl != 0 ? 1.5 : 0.1;
  const double start = std::ceil(rest / interval) * interval;
  config.reference.signal = settings::ReferenceSignal::kArmAngle;
  config.reference.trajectory = {};
  // Half a tick early, so that rounding does not delay it by a sample.
  config.reference.trajectory.steps = {{start - 0.5 / config.plant.rate_hz, step.step}};
  config.model.arm_angle_rad = 0;
  config.last_tick = std::llround((start + kNeverSettled * step.shortest) * config.plant.rate_hz);
  std::vector<double> time;
  std::vector<double> angle;
  const std::string states = bus::Channels(config.bus.channel_suffix).Of<state_t>();
  const sim::SimulationResult result = sim::Simulate(config, [&](const bus::RawMessage& message) {
    if (message.channel != states) return;
    // Does not use state_t::decode: LCM's decoders write doubles through pointers to integers. Inlined next
    // to a new message, they appear to the compiler to write nothing.
    const std::shared_ptr<void> decoded = bus::TypeOf<state_t>().decode(message.data, message.size);
    if (decoded == nullptr) throw std::logic_error("a state of our own does not decode");
    const state_t& state = *static_cast<const state_t*>(decoded.get());
    if (static_cast<double>(state.tick) < std::round(start * config.plant.rate_hz)) return;
    time.push_back(state.time - start);
    angle.push_back(state.arm_angle);
  });
  if (result.exit_code != 0) {
    throw std::runtime_error(fmt::format("the simulated step of {} {} failed: {}", step.step,
                                         config.model.description.units.UnitFor("rad", 1), result.failure));
  }
  const runs::StepResponse to_target = runs::MeasureStep(time, angle, 0, time.size(), 0, step.step);
  double from = 0;
  double to = step.step;
  if (config.model.description.parameters.mgl != 0) {
    from = angle.front();
    to += to_target.final_error_rad;
  }
  const runs::StepResponse measured = runs::MeasureStep(time, angle, 0, time.size(), from, to);
  StepResult summary;
  summary.settled = measured.settling_time_s.has_value();
  summary.settling = measured.settling_time_s.value_or(time.back());
  summary.ratio = summary.settled
                      ? summary.settling / step.shortest
                      : kNeverSettled + std::min(1.0, std::fabs(measured.final_error_rad / step.step));
  summary.overshoot_percent = measured.overshoot_percent;
  summary.error = to_target.final_error_rad;
  return summary;
}

}  // namespace hydro::tune
