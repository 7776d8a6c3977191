#include "experiments/studies/position_loop.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runs/step_response.h"
#include "settings/stack_config.h"

namespace hydro::experiments {

std::vector<std::pair<double, double>> AsPairs(const std::vector<design::Complex>& poles) {
  std::vector<std::pair<double, double>> pairs;
  pairs.reserve(poles.size());
  for (const design::Complex& pole : poles) pairs.push_back({pole.real(), pole.imag()});
  return pairs;
}

design::Complex SlowestPole(const std::vector<design::Complex>& poles) {
  const design::Complex pole = *std::max_element(
      poles.begin(), poles.end(),
      [](const design::Complex& a, const design::Complex& b) { return a.real() < b.real(); });
  return {pole.real(), std::fabs(pole.imag())};
}

std::string PoleText(const design::Complex& pole) {
  if (pole.imag() == 0) return fmt::format("{:.2f}", pole.real());
  return fmt::format("{:.1f} ± {:.1f}j", pole.real(), std::fabs(pole.imag()));
}

std::string SettlingText(const runs::StepResponse& response) {
  return response.settling_time_s ? fmt::format("{:.3f} s", *response.settling_time_s) : "never";
}

tune::StepTrial TrialOf(const std::string& config_text, const std::string& model_text, double step) {
  tune::StepTrial trial =
      tune::TrialOf(settings::ParseStackConfig(config_text, "configuration", model_text, "model"));
  trial.step = step;
  return trial;
}

std::vector<Candidate> SearchGains(tune::StepTrial trial, const design::RigidDrive& drive) {
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
        const design::Response response = tune::RunStepTrial(trial).response;
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
