#include "experiments/runs/open_loop_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "model/actuator.h"
#include "model/equations/equations.h"
#include "model/integrate/simulation.h"

namespace hydro::experiments {
namespace {

// The model in motion under one voltage.
class Rig {
 public:
  Rig(const model::ModelDescription& model, double voltage)
      : equations_(model, {.shaft = model::Shaft::kClamped}),
        simulation_(model::MakeSimulation(&equations_, model::Integrator::kAuto,
                                          std::numeric_limits<double>::quiet_NaN(),
                                          model::ActuatorOptions{}.relative_tolerance)),
        voltage_(voltage) {
    simulation_->Advance(voltage, 0);  // breaks away, if at all
  }
  void Advance(double until) { simulation_->Advance(voltage_, until); }

  double p1() const { return simulation_->now().state[model::kP1]; }
  double p2() const { return simulation_->now().state[model::kP2]; }
  double motor_speed() const { return simulation_->now().state[model::kMotorSpeed]; }
  double dp() const { return p2() - p1(); }
  bool rises() const { return simulation_->now().rate[model::kP2] > simulation_->now().rate[model::kP1]; }
  bool sticks() const { return simulation_->mode().pump == 0; }
  int64_t mode_changes() const { return simulation_->mode_changes(); }

 private:
  model::Equations equations_;
  std::unique_ptr<model::Simulation> simulation_;
  double voltage_;
};

double SampleTime(size_t i, double interval) { return static_cast<double>(i) * interval; }

// Sample intervals in which the pump or a valve switches, or dp turns.
std::vector<bool> EventfulIntervals(const model::ModelDescription& model, double voltage, size_t samples,
                                    double interval) {
  Rig rig(model, voltage);
  std::vector<bool> eventful(samples);
  for (size_t i = 0; i < samples; ++i) {
    const int64_t changes = rig.mode_changes();
    const bool rose = rig.rises();
    rig.Advance(SampleTime(i + 1, interval));
    eventful[i] = rig.mode_changes() != changes || rig.rises() != rose;
  }
  return eventful;
}

}  // namespace

size_t OpenLoopRun::sticks(double from) const {
  return static_cast<size_t>(std::count_if(changes.begin(), changes.end(), [&](const PumpChange& change) {
    return change.sticks && change.time > from;
  }));
}

// A first run finds where something happens, and a second one resolves it finely.
OpenLoopRun RunOpenLoop(const model::ModelDescription& model, double torque, double duration,
                        double sample_interval) {
  const double voltage = torque / model.parameters.k_1;
  const auto samples = static_cast<size_t>(std::lround(duration / sample_interval));
  const std::vector<bool> eventful = EventfulIntervals(model, voltage, samples, sample_interval);
  const auto fine_steps = static_cast<size_t>(std::ceil(sample_interval / kLocatedWithin - 1e-6));

  Rig rig(model, voltage);
  OpenLoopRun run;
  const auto record = [&](double time) {
    run.time.push_back(time);
    run.dp.push_back(rig.dp());
    run.p1.push_back(rig.p1());
    run.p2.push_back(rig.p2());
    run.motor_speed.push_back(rig.motor_speed());
  };
  record(0);
  for (size_t i = 0; i < samples; ++i) {
    const size_t steps = eventful[i] ? fine_steps : 1;
    for (size_t k = 1; k <= steps; ++k) {
      const bool stuck = rig.sticks();
      const bool rose = rig.rises();
      const double fraction = static_cast<double>(k) / static_cast<double>(steps);
      const double time = SampleTime(i, sample_interval) + fraction * sample_interval;
      rig.Advance(k == steps ? SampleTime(i + 1, sample_interval) : time);
      if (rig.sticks() != stuck) run.changes.push_back({time, rig.sticks(), rig.dp()});
      // dp is constant until the pump breaks away: the first extreme is a peak.
      if (rig.rises() != rose && (rose || !run.extremes.empty())) {
        run.extremes.push_back({time, rose, rig.dp(), rig.p2()});
      }
    }
    record(SampleTime(i + 1, sample_interval));
  }
  return run;
}

StickSlipCycles FindCycles(const OpenLoopRun& run) {
  const double half = run.time.back() / 2;
  StickSlipCycles cycles;
  const PumpChange* first = nullptr;
  const PumpChange* last = nullptr;
  for (const PumpChange& change : run.changes) {
    if (change.time <= half) continue;
    if (change.sticks) {
      if (first == nullptr) first = &change;
      last = &change;
      cycles.stick_dp = change.dp;
    } else if (last != nullptr) {
      cycles.slip_dp = change.dp;
      cycles.stick_time = change.time - last->time;
    }
  }
  const size_t sticks = run.sticks(half);
  if (sticks < 3) return {};
  cycles.sustained = true;
  cycles.period = (last->time - first->time) / static_cast<double>(sticks - 1);
  cycles.high = -std::numeric_limits<double>::infinity();
  cycles.low = -cycles.high;
  for (const PressureExtreme& extreme : run.extremes) {
    if (extreme.time <= half) continue;
    cycles.high = std::max(cycles.high, extreme.dp);
    cycles.low = std::min(cycles.low, extreme.dp);
  }
  return cycles;
}

}  // namespace hydro::experiments
