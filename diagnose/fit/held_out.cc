#include "diagnose/fit/held_out.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "diagnose/fit/start_fit.h"
#include "maths/solve.h"

namespace hydro::diagnose {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A Gauss-Newton step is not trusted if it predicts a run with more than this multiple of the sum of squares
// that the common fit leaves: long steps end where the derivatives no longer hold.
constexpr double kDoubtful = 1.5;

// Predicts one run with a model whose parameters are held.
HeldOut PredictRun(const Hypothesis& hypothesis, const RunData& run, const model::StartState& from,
                   double doubtful) {
  const Fitted fitted = FitStart(hypothesis, run, from, doubtful);
  HeldOut part;
  part.models.push_back(hypothesis.model);
  if (fitted.ok()) {
    part.starts.push_back(fitted.runs[0].start);
    part.sum = fitted.sum;
    part.count = fitted.count;
    return part;
  }
  part.starts.push_back(from);
  part.sum = std::numeric_limits<double>::infinity();
  part.count = CountValid(run);
  return part;
}

HeldOut Sum(const std::vector<HeldOut>& parts) {
  HeldOut all;
  for (const HeldOut& part : parts) {
    all.sum += part.sum;
    all.count += part.count;
    all.starts.push_back(part.starts.front());
    all.models.push_back(part.models.front());
    all.gaps.push_back(part.count == 0 ? 0 : part.sum / static_cast<double>(part.count));
  }
  return all;
}

// The parameter's value without the change.
double Neutral(const FreeParameter& parameter, const model::ModelDescription& given) {
  if (parameter.unknown.kind == model::Unknown::Kind::kBase) {
    return given.parameters.*model::BaseParameters()[parameter.unknown.index].member;
  }
  for (const model::EffectDescription& effect : given.effects) {
    for (const auto& [name, value] : effect.parameters) {
      if (effect.id + "." + name == parameter.name) return value;
    }
  }
  return parameter.logarithmic ? parameter.value : 0;
}

// The weak prior: a base parameter is within a third of its given value, the size of an effect within its own
// size of zero.
Prior PriorOf(const std::vector<FreeParameter>& free, const model::ModelDescription& given) {
  constexpr double kBaseSpread = 0.3;
  Prior prior;
  for (const FreeParameter& parameter : free) {
    const double neutral = Neutral(parameter, given);
    const double moved = std::abs(parameter.ToFitted(parameter.value) - parameter.ToFitted(neutral));
    double spread = std::max({moved, kBaseSpread * std::abs(neutral), 1e-300});
    if (parameter.logarithmic) {
      spread = parameter.unknown.kind == model::Unknown::Kind::kBase ? kBaseSpread + moved : 1;
    }
    prior.centre.push_back(parameter.ToFitted(neutral));
    prior.weight.push_back(1 / (spread * spread));
  }
  return prior;
}

// All elements but one.
template <class T>
std::vector<T> Without(const std::vector<T>& all, size_t place) {
  std::vector<T> rest = all;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(place));
  return rest;
}

}  // namespace

double LogarithmOf(double squared_gap) { return std::log(std::clamp(squared_gap, 1e-3, 1e12)); }

double HeldOut::typical_squared_gap() const {
  double logarithms = 0;
  for (const double gap : gaps) logarithms += LogarithmOf(gap);
  return gaps.empty() ? 0 : std::exp(logarithms / static_cast<double>(gaps.size()));
}

HeldOut Predict(const Fitted& fitted, const std::vector<const RunData*>& held_out, int jobs) {
  std::vector<HeldOut> parts(held_out.size());
  ParallelFor(held_out.size(), jobs, [&](size_t r) {
    parts[r] = PredictRun(fitted.hypothesis, *held_out[r], held_out[r]->start, kStartInDoubt);
  });
  return Sum(parts);
}

HeldOut PredictInTurn(const Fitted& fitted, const model::ModelDescription& given,
                      const std::vector<const RunData*>& runs, int jobs) {
  const std::vector<FreeParameter> free = fitted.hypothesis.Free();
  const auto p = static_cast<Index>(free.size());
  MatrixXd information = MatrixXd::Zero(p, p);
  VectorXd gradient = VectorXd::Zero(p);
  for (const RunFit& run : fitted.runs) {
    information += Map<const MatrixXd>(run.information.data(), p, p);
    gradient += Map<const VectorXd>(run.gradient.data(), p);
  }
  Prior prior = PriorOf(free, given);
  const Prior known = KnownBefore(fitted.hypothesis);
  for (size_t i = 0; i < free.size(); ++i) {
    if (known.weight[i] > prior.weight[i]) {
      prior.centre[i] = known.centre[i];
      prior.weight[i] = known.weight[i];
    }
  }
  std::vector<HeldOut> parts(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    Hypothesis others = fitted.hypothesis;
    if (p > 0) {
      MatrixXd left = information - Map<const MatrixXd>(fitted.runs[r].information.data(), p, p);
      VectorXd right = gradient - Map<const VectorXd>(fitted.runs[r].gradient.data(), p);
      for (Index i = 0; i < p; ++i) {
        const auto place = static_cast<size_t>(i);
        left(i, i) += prior.weight[place];
        right(i) += prior.weight[place] * (free[place].ToFitted(free[place].value) - prior.centre[place]);
      }
      const VectorXd scale = left.diagonal().cwiseSqrt().cwiseInverse();
      const MatrixXd scaled = scale.asDiagonal() * left * scale.asDiagonal();
      const VectorXd move = -(scale.asDiagonal() * maths::SolveSymmetric(scaled, scale.asDiagonal() * right));
      std::vector<double> values;
      for (Index i = 0; i < p; ++i) {
        const FreeParameter& parameter = free[static_cast<size_t>(i)];
        values.push_back(std::clamp(parameter.Moved(move(i)), parameter.low, parameter.high));
      }
      others.Set(values);
    }
    const double doubtful = kStartInDoubt * fitted.runs[r].sum / static_cast<double>(fitted.runs[r].count);
    const auto predict = [&](const Hypothesis& hypothesis) {
      return PredictRun(hypothesis, *runs[r], fitted.runs[r].start, doubtful);
    };
    parts[r] = predict(others);
    if (p == 0 || runs.size() < 2 || !(parts[r].sum > kDoubtful * fitted.runs[r].sum)) return;
    FitOptions options;
    options.most_iterations = 6;
    options.tolerance = 1e-3;
    options.prior = &prior;
    const Fitted by_others = Fit(fitted.hypothesis, Without(runs, r), Without(StartsOf(fitted), r), options);
    if (by_others.ok()) parts[r] = predict(by_others.hypothesis);
  });
  return Sum(parts);
}

}  // namespace hydro::diagnose
