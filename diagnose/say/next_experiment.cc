#include "diagnose/say/next_experiment.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "diagnose/say/trials.h"
#include "model/response.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kStride = 5;       // one sample in this many is compared
constexpr double kHeadroom = 1.05;  // above what the rig has seen
// For each way to hold the shaft: the number of trials to which base parameters are fitted.
constexpr size_t kFinalExperiments = 3;
constexpr double kWorthwhile = 1;  // noise units; with less, the models look the same

model::Response Predict(const model::ModelDescription& model, const Trial& trial,
                        const std::vector<model::Unknown>& unknowns) {
  model::ResponseOptions options;
  options.stride = kStride;
  const double p_3 = model.parameters.p_3;
  return model::Respond(model, StimulusOf(trial), {0, 0, p_3, p_3, trial.arm_angle, 0}, unknowns, options);
}

bool Inside(const model::Response& response, const Rig& rig, bool free) {
  const auto largest = [&](model::Channel channel) {
    double size = 0;
    for (const double value : response.values[static_cast<size_t>(channel)]) {
      size = std::max(size, std::abs(value));
    }
    return size;
  };
  if (rig.speed > 0 && largest(model::Channel::kMotorSpeed) > kHeadroom * rig.speed) return false;
  if (rig.pressure > 0 &&
      std::max(largest(model::Channel::kP1), largest(model::Channel::kP2)) > kHeadroom * rig.pressure) {
    return false;
  }
  if (!free) return true;
  const double slack = (kHeadroom - 1) * (rig.high_angle - rig.low_angle);
  for (const double angle : response.values[static_cast<size_t>(model::Channel::kArmAngle)]) {
    if (angle < rig.low_angle - slack || angle > rig.high_angle + slack) return false;
  }
  return true;
}

// A response's signals in noise units, stacked into one vector.
Eigen::VectorXd InNoise(const std::array<std::vector<double>, model::kChannels>& values, const Rig& rig) {
  std::vector<double> all;
  for (size_t channel = 0; channel < model::kChannels; ++channel) {
    if (rig.noise[channel] == 0) continue;
    for (const double value : values[channel]) all.push_back(value / rig.noise[channel]);
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

double Rms(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0 : values.norm() / std::sqrt(static_cast<double>(values.size()));
}

// The smallest root-mean-square difference between two rivals. With `absorb`, it is computed after the base
// parameters of either have absorbed what they can of it. Nothing when the trial leaves the rig's limits or
// cannot be simulated.
std::optional<double> Separation(const std::vector<model::ModelDescription>& rivals, const Trial& trial,
                                 const Rig& rig, bool absorb) {
  std::vector<model::Unknown> unknowns;
  if (absorb) {
    for (size_t i = 0; i < model::BaseParameters().size(); ++i)
      unknowns.push_back({model::Unknown::Kind::kBase, i});
  }
  std::vector<Eigen::VectorXd> predicted;
  std::vector<Eigen::MatrixXd> sensitivities;
  try {
    for (const model::ModelDescription& rival : rivals) {
      const model::Response response = Predict(rival, trial, unknowns);
      if (!Inside(response, rig, trial.shaft == model::Shaft::kFree)) return std::nullopt;
      predicted.push_back(InNoise(response.values, rig));
      if (!absorb) continue;
      Eigen::MatrixXd matrix(predicted.back().size(), static_cast<Eigen::Index>(unknowns.size()));
      for (size_t i = 0; i < unknowns.size(); ++i) {
        Eigen::VectorXd column = InNoise(response.derivatives[i], rig);
        const double size = column.norm();
        if (size > 0) column /= size;
        matrix.col(static_cast<Eigen::Index>(i)) = column;
      }
      sensitivities.push_back(std::move(matrix));
    }
  } catch (const model::ModelError&) {
    return std::nullopt;
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < rivals.size(); ++i) {
    for (size_t j = 0; j < rivals.size(); ++j) {
      if (i == j || (!absorb && j < i)) continue;
      Eigen::VectorXd difference = predicted[j] - predicted[i];
      if (absorb) {
        const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(sensitivities[i]);
        difference -= sensitivities[i] * qr.solve(difference);
      }
      const double rms = Rms(difference);
      if (!std::isfinite(rms)) return std::nullopt;
      smallest = std::min(smallest, rms);
    }
  }
  return smallest;
}

}  // namespace

NextExperiment DesignNextExperiment(const std::vector<model::ModelDescription>& rivals,
                                    const std::vector<const RunData*>& runs, const std::string& why) {
  NextExperiment next;
  next.why = why;
  if (rivals.size() < 2 || runs.empty()) return next;
  const Rig rig = Inspect(runs);
  if (!(rig.voltage > 0)) return next;
  std::vector<Trial> trials = Trials(rig, rivals.front().parameters);
  const auto judge = [&](bool absorb) {
    for (Trial& trial : trials) {
      trial.separation = Separation(rivals, trial, rig, absorb).value_or(-1);
    }
    std::erase_if(trials, [](const Trial& trial) { return trial.separation < kWorthwhile; });
    std::ranges::stable_sort(trials,
                             [](const Trial& a, const Trial& b) { return a.separation > b.separation; });
  };
  judge(false);
  std::vector<Trial> finalists;
  for (const Trial& trial : trials) {
    const auto alike = std::ranges::count_if(finalists, [&](const Trial& other) {
      return other.shaft == trial.shaft && other.arm_angle == trial.arm_angle && other.bypass == trial.bypass;
    });
    if (static_cast<size_t>(alike) < kFinalExperiments) finalists.push_back(trial);
  }
  trials = std::move(finalists);
  judge(true);
  if (trials.empty()) return next;
  next.config = Configuration(trials.front(), rig);
  next.expected_separation = trials.front().separation;
  return next;
}

}  // namespace hydro::diagnose
