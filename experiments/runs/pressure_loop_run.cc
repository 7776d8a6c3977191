#include "experiments/runs/pressure_loop_run.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/runs/shipped_models.h"

namespace hydro::experiments {
namespace {

std::string Configuration(const PressureLoopSetup& setup) {
  const std::string shaft = setup.motion.empty() ? std::string("shaft = \"clamped\"\narm_angle = 0.0\n")
                                                 : "shaft = \"driven\"\n[model.motion]\n" + setup.motion;
  return fmt::format(R"([model]
file = "table1.toml"
{}
[time]
mode = "lockstep"
duration_s = {}
[plant]
rate_hz = {}
command_delay_ticks = 0
[pressure]
natural_frequency_rad_s = {}
damping_ratio = {}
reference_feedforward = {:#}
arm_speed_feedforward = {}
[position]
sample_interval_s = {}
[reference]
{}
[noise]
p1 = {}
p2 = {}
seed = {}
)",
                     shaft, setup.duration, setup.rate, kLoopNaturalFrequency, kLoopDampingRatio,
                     setup.feedforward, setup.arm_speed_feedforward, 1 / setup.rate, setup.reference,
                     setup.pressure_noise, setup.pressure_noise, setup.seed);
}

const std::vector<double>& Values(const tables::Table& table, const char* name) {
  const tables::Column* column = table.Find(name);
  if (column == nullptr) throw std::logic_error(std::string("a run without ") + name);
  return column->values;
}

// Motor torque per psi of dp in a steady creep: what dp itself takes, plus the viscous friction and the k_v
// term at the speed that compensates the leakage.
double CreepTorque(const model::Parameters& p, const pressure_ctrl::PressureGains& gains) {
  return p.D + (p.b + p.k_1 * gains.k_p * gains.k_v) * (p.c_E + p.c_I) / p.D;
}

}  // namespace

PressureLoopRun RunPressureLoop(const StackRunner& run_stack, const PressureLoopSetup& setup) {
  const tables::Table table = run_stack({setup.name, Configuration(setup), ShippedModelText("table1")});
  PressureLoopRun run;
  run.time = Values(table, "time_s");
  run.reference = Values(table, "pressure_ref_psi");
  run.p1 = Values(table, "p1_psi");
  run.p2 = Values(table, "p2_psi");
  run.motor_speed = Values(table, "motor_speed_rad_s");
  run.arm_angle = Values(table, "arm_angle_rad");
  run.arm_speed = Values(table, "arm_speed_rad_s");
  run.torque = Values(table, "voltage_V");
  const double k_1 = PressureLoopParameters().k_1;
  for (double& torque : run.torque) torque *= k_1;
  run.dp.resize(run.time.size());
  for (size_t i = 0; i < run.dp.size(); ++i) run.dp[i] = run.p2[i] - run.p1[i];
  return run;
}

model::Parameters PressureLoopParameters() { return ShippedModel("table1").parameters; }

pressure_ctrl::PressureGains PressureLoopGains() {
  return pressure_ctrl::DerivePressureGains(PressureLoopParameters(), 0, kLoopNaturalFrequency,
                                            kLoopDampingRatio, 2);
}

// k_1 (k_p (ref - dp) + feedforward ref) = CreepTorque dp + T_s.
double SettledPressure(double reference, double feedforward) {
  const model::Parameters p = PressureLoopParameters();
  const pressure_ctrl::PressureGains gains = PressureLoopGains();
  return (p.k_1 * (gains.k_p + feedforward) * reference - p.T_s) /
         (p.k_1 * gains.k_p + CreepTorque(p, gains));
}

FrictionBand StickingPressures(double reference, double feedforward) {
  const model::Parameters p = PressureLoopParameters();
  const pressure_ctrl::PressureGains gains = PressureLoopGains();
  const double torque = p.k_1 * (gains.k_p + feedforward) * reference;
  const double stiffness = p.k_1 * gains.k_p + p.D;
  return {(torque - p.T_s) / stiffness, (torque + p.T_s) / stiffness};
}

TrackingError MeasureTracking(const PressureLoopRun& run, double from) {
  const double limit = PressureLoopParameters().T_pmax;
  TrackingError error;
  double squares = 0;
  size_t saturated = 0, count = 0;
  for (size_t i = 0; i < run.time.size(); ++i) {
    // With separate processes, the first ticks have no reference yet.
    if (run.time[i] < from || std::isnan(run.reference[i])) continue;
    const double e = run.reference[i] - run.dp[i];
    squares += e * e;
    if (std::abs(run.torque[i]) >= limit) ++saturated;
    error.highest = count == 0 ? run.dp[i] : std::max(error.highest, run.dp[i]);
    error.lowest = count == 0 ? run.dp[i] : std::min(error.lowest, run.dp[i]);
    ++count;
  }
  error.rms = std::sqrt(squares / static_cast<double>(count));
  error.saturated_fraction = static_cast<double>(saturated) / static_cast<double>(count);
  return error;
}

double MeanError(const PressureLoopRun& run, double until, double length) {
  double sum = 0;
  size_t count = 0;
  const double half_tick = 0.5 / kLoopRate;
  for (size_t i = 0; i < run.time.size(); ++i) {
    if (run.time[i] <= until - length + half_tick || run.time[i] > until + half_tick) continue;
    sum += run.reference[i] - run.dp[i];
    ++count;
  }
  return sum / static_cast<double>(count);
}

page::Curve SignalCurve(const std::string& label, const PressureLoopRun& run,
                        const std::vector<double>& values, int colour, double until, page::Stroke stroke) {
  page::Curve curve{.label = label, .stroke = stroke, .colour = colour};
  for (size_t i = 0; i < run.time.size() && run.time[i] <= until + 0.5 / kLoopRate; ++i) {
    curve.x.push_back(run.time[i]);
    curve.y.push_back(values[i]);
  }
  return curve;
}

}  // namespace hydro::experiments
