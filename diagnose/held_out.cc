#include "diagnose/held_out.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/parallel.h"
#include "diagnose/solve.h"

namespace hydro {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// One run against a model whose parameters are fixed.
void PredictRun(const Hypothesis& hypothesis, const RunData& run, const StartState& start, size_t place,
                std::vector<HeldOut>* parts) {
  Hypothesis fixed = hypothesis;
  fixed.base.clear();
  fixed.effects.clear();
  FitOptions options;
  options.most_iterations = 6;
  const Fitted fitted = Fit(fixed, {&run}, {start}, options);
  HeldOut& part = (*parts)[place];
  part.models.push_back(fixed.model);
  if (fitted.ok()) {
    part.starts.push_back(fitted.runs[0].start);
    part.sum = fitted.sum;
    part.count = fitted.count;
    return;
  }
  part.starts.push_back(start);
  part.sum = std::numeric_limits<double>::infinity();
  for (const SignalData& signal : run.signals) part.count += signal.valid;
}

HeldOut Sum(const std::vector<HeldOut>& parts) {
  HeldOut all;
  for (const HeldOut& part : parts) {
    all.sum += part.sum;
    all.count += part.count;
    all.starts.push_back(part.starts.front());
    all.models.push_back(part.models.front());
  }
  return all;
}

// The value without the change.
double Neutral(const FreeParameter& parameter, const ModelDescription& given) {
  if (parameter.unknown.kind == Unknown::Kind::kBase) {
    return given.parameters.*BaseParameters()[parameter.unknown.index].member;
  }
  for (const EffectDescription& effect : given.effects) {
    for (const auto& [name, value] : effect.parameters) {
      if (effect.id + "." + name == parameter.name) return value;
    }
  }
  return parameter.logarithmic ? parameter.value : 0;
}

}  // namespace

HeldOut Predict(const Fitted& fitted, const std::vector<const RunData*>& held_out, int jobs) {
  std::vector<HeldOut> parts(held_out.size());
  ParallelFor(held_out.size(), jobs,
              [&](size_t r) { PredictRun(fitted.hypothesis, *held_out[r], held_out[r]->start, r, &parts); });
  return Sum(parts);
}

HeldOut PredictInTurn(const Fitted& fitted, const ModelDescription& given,
                      const std::vector<const RunData*>& runs, int jobs) {
  const std::vector<FreeParameter> free = fitted.hypothesis.Free();
  const auto p = static_cast<Index>(free.size());
  MatrixXd information = MatrixXd::Zero(p, p);
  VectorXd gradient = VectorXd::Zero(p);
  for (const RunFit& run : fitted.runs) {
    information += Map<const MatrixXd>(run.information.data(), p, p);
    gradient += Map<const VectorXd>(run.gradient.data(), p);
  }
  // What little is known beforehand: a base parameter is within a third of what was given, the size of an
  // effect within its own size of none.
  constexpr double kBaseSpread = 0.3;
  VectorXd prior(p), pull(p);
  for (Index i = 0; i < p; ++i) {
    const FreeParameter& parameter = free[static_cast<size_t>(i)];
    const double neutral = Neutral(parameter, given);
    const bool base = parameter.unknown.kind == Unknown::Kind::kBase;
    if (parameter.logarithmic) {
      const double spread = base ? kBaseSpread + std::abs(std::log(parameter.value / neutral)) : 1;
      prior(i) = 1 / (spread * spread);
      pull(i) = prior(i) * std::log(parameter.value / neutral);
    } else {
      const double size =
          std::max({std::abs(parameter.value - neutral), kBaseSpread * std::abs(neutral), 1e-300});
      prior(i) = 1 / (size * size);
      pull(i) = prior(i) * (parameter.value - neutral);
    }
  }
  std::vector<HeldOut> parts(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    Hypothesis others = fitted.hypothesis;
    if (p > 0) {
      MatrixXd left = information - Map<const MatrixXd>(fitted.runs[r].information.data(), p, p);
      VectorXd right = gradient - Map<const VectorXd>(fitted.runs[r].gradient.data(), p);
      left.diagonal() += prior;
      right += pull;
      const VectorXd scale = left.diagonal().cwiseSqrt().cwiseInverse();
      const MatrixXd scaled = scale.asDiagonal() * left * scale.asDiagonal();
      const VectorXd move = -(scale.asDiagonal() * SolveSymmetric(scaled, scale.asDiagonal() * right));
      std::vector<double> values;
      for (Index i = 0; i < p; ++i) {
        const FreeParameter& parameter = free[static_cast<size_t>(i)];
        values.push_back(std::clamp(parameter.Moved(move(i)), parameter.low, parameter.high));
      }
      others.Set(values);
    }
    PredictRun(others, *runs[r], fitted.runs[r].start, r, &parts);
  });
  return Sum(parts);
}

}  // namespace hydro
