#include "experiments/studies/retuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runs/step_response.h"
#include "settings/stack_config.h"

namespace hydro::experiments {

StepTrial TrialOf(const std::string& config_text, const std::string& model_text, double step) {
  const settings::StackConfig config =
      settings::ParseStackConfig(config_text, "configuration", model_text, "model");
  const model::Parameters& p = config.model.description.parameters;
  StepTrial trial;
  trial.model = config.model.description;
  if (config.pressure.k_p) {
    trial.pressure.gains = {*config.pressure.k_p, *config.pressure.k_v};
  } else {
    trial.pressure.gains = pressure_ctrl::DerivePressureGains(
        p, config.model.arm_angle_rad, *config.pressure.natural_frequency_rad_s,
        *config.pressure.damping_ratio, config.pressure.compressed_sides);
  }
  trial.pressure.voltage_limit = p.T_pmax / p.k_1;
  if (config.pressure.reference_feedforward) {
    trial.pressure.reference_feedforward = pressure_ctrl::SteadyStateFeedforward(p, trial.pressure.gains);
  }
  if (config.pressure.arm_speed_feedforward) trial.pressure.arm_speed_ratio = p.c / p.D;
  trial.position.c1 = config.position.c1;
  trial.position.c2 = config.position.c2;
  trial.position.sample_interval = config.position.sample_interval_s;
  trial.position.derivative_on_error = config.position.derivative_on_error;
  trial.position.pressure_limit = config.limits.arm_torque_in_lbf / p.k_2;
  trial.tick = 1 / config.plant.rate_hz;
  trial.interval = static_cast<int>(config.position_interval_ticks);
  trial.command_delay = config.plant.command_delay_ticks;
  trial.step = step;
  return trial;
}

std::vector<Candidate> SearchGains(StepTrial trial, const design::RigidDrive& drive) {
  const double design_step = trial.step;
  std::vector<Candidate> candidates;
  for (int c1 = 8000; c1 <= 20000; c1 += 2000) {
    for (int c2 = 500; c2 * 6 <= c1; c2 += 50) {
      if (c2 * 16 < c1) continue;
      Candidate candidate{static_cast<double>(c1), static_cast<double>(c2), 0};
      trial.position.c1 = candidate.c1;
      trial.position.c2 = candidate.c2;
      for (const double factor : {0.9, 1.0, 1.1}) {
        trial.step = factor * design_step;
        const double shortest = design::FastestSettling(drive, trial.step, runs::kSettlingBand);
        trial.duration = 2 * shortest;
        const design::Response response = RunStepTrial(trial);
        const auto settling =
            runs::MeasureStep(response.time, response.angle, 0, response.time.size(), 0, trial.step)
                .settling_time_s;
        candidate.worst_ratio = std::max(
            candidate.worst_ratio, settling ? *settling / shortest : std::numeric_limits<double>::infinity());
      }
      candidates.push_back(candidate);
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.worst_ratio < b.worst_ratio; });
  return candidates;
}

}  // namespace hydro::experiments
