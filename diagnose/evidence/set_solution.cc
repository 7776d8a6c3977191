#include "diagnose/evidence/set_solution.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

namespace hydro::diagnose {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Variances have settled when none changes by more than a hundredth. The remaining change of the log evidence
// is common to all sets, which all start from the same variances.
constexpr double kSettled = 0.01;
// Inertia is positive. Where the linear form would make it less than this share, the Jacobian stops there.
constexpr double kLeastInertia = 0.05;
// Limits of the effect of noise in the columns on a sum of squares. A set that passes on a thirtieth of the
// noise explains by cancelling signals; one that passes on ten times more is out of the running.
constexpr double kLeastNoiseFactor = 0.03, kMostNoiseFactor = 10;

// The linear form may make a value less than this part, or negative: as unlikely as can be.
constexpr double kLeastOfAValue = 0.01;

// ln of the normal distribution.
double LogNormal(double x) {
  if (x > -30) return std::log(std::erfc(-x / std::numbers::sqrt2) / 2);
  // Its asymptotic series, where the distribution itself is too small for a double.
  const double s = 1 / (x * x);
  return -x * x / 2 - std::log(-x * std::sqrt(2 * std::numbers::pi)) + std::log1p(-s + 3 * s * s);
}

// The factor by which the amounts change J w'.
double InertiaFactor(const std::vector<Index>& inertia, const VectorXd& amounts) {
  return std::max(kLeastInertia, 1 + amounts(inertia).sum());
}

}  // namespace

SetEvidence::Solution SetEvidence::Solve(const std::vector<int>& changes, const VectorXd& scales,
                                         VectorXd weights, int most) const {
  const NormalEquations equations(blocks_, static_cast<Index>(always_.size()), changes);
  const PriorOfAmounts prior = priors_->With(changes, scales);
  Solution found;
  found.scales = scales;
  found.columns = always_;
  found.columns.insert(found.columns.end(), changes.begin(), changes.end());
  std::vector<Index> inertia;
  for (size_t i = 0; i < found.columns.size(); ++i)
    if (std::ranges::count(grams_->inertia, found.columns[i])) inertia.push_back(static_cast<Index>(i));
  found.amounts = VectorXd::Zero(equations.size());
  for (int turn = 0; turn < most; ++turn) {
    if (turn > 0) weights = found.next;
    MatrixXd normal = prior.precision;
    VectorXd right = VectorXd::Zero(equations.size());
    equations.Add(weights, &normal, &right);
    AddJacobian(inertia, found.amounts, &normal, &right);
    found.normal.compute(normal);
    found.amounts = found.normal.solve(right);
    found.squares = equations.Squares(found.amounts);
    found.next = (kVarianceShape + numbers_.array() / 2) /
                 (kVarianceShape * floor_.array() + found.squares.array() / 2);
    if (numbers_.size() == 0 || (found.next.array() / weights.array()).log().abs().maxCoeff() < kSettled)
      break;
  }
  found.weights = std::move(weights);
  found.counted_squares = found.squares;
  if (null_noise_.size() > 0)
    found.counted_squares.array() /= NoiseFactors(equations.NoiseSquares(found.amounts)).array();
  found.penalty = (found.amounts.dot(prior.precision * found.amounts) + prior.log_determinant) / 2 +
                  found.normal.matrixLLT().diagonal().array().log().sum();
  found.jacobian = inertia_numbers_ * std::log(InertiaFactor(inertia, found.amounts));
  return found;
}

// Where the residual of the torque balance is a disturbance and not noise of the sensors, w' responds to it,
// and the density of the measured w' has a factor J for each number: n ln(1 + delta_J), used here in its
// second-order form about the amounts so far. Without this term every disturbance shrinks J, by 77 to 100 %
// on three real machines. (In the flows and in the arm's balance the term makes things worse, because their
// residuals come from the sensors.)
void SetEvidence::AddJacobian(const std::vector<Index>& inertia, const VectorXd& amounts, MatrixXd* normal,
                              VectorXd* right) const {
  if (inertia.empty()) return;
  const double factor = InertiaFactor(inertia, amounts);
  for (const Index i : inertia) {
    (*right)[i] += inertia_numbers_ * (1 / factor + (factor - 1) / (factor * factor));
    for (const Index j : inertia)
      if (j <= i) (*normal)(i, j) += inertia_numbers_ / (factor * factor);
  }
}

// Errors in variables: the divisors for the residuals' squares. `passed` has the squares of the noise that
// the set's columns pass on. Amounts that cancel noise also cancel what the sensors measured. Amounts that
// pass on more noise than the model without changes explain that much of the residuals by themselves.
VectorXd SetEvidence::NoiseFactors(const VectorXd& passed) const {
  VectorXd factors(passed.size());
  for (Index g = 0; g < passed.size(); ++g) {
    const double kept = null_noise_[g] > 0 ? std::min(passed[g] / null_noise_[g], 1.0) : 1.0;
    const double added = std::max(passed[g] - null_noise_[g], 0.0) / null_squares_[g];
    factors[g] = std::clamp(kept + added, kLeastNoiseFactor, kMostNoiseFactor);
  }
  return factors;
}

VectorXd SetEvidence::LogLikelihoods(const Solution& solution) const {
  return -(kVarianceShape + numbers_.array() / 2) *
         (kVarianceShape + solution.counted_squares.array() / (2 * floor_.array())).log();
}

// The price of values that the linear form lets fall towards 0. What is known of a value is a factor: a
// twentieth of it is as unlikely as twenty times it, where the linear form asks two deviations of 50 % for
// it. With the arm's inertia and load at 5 % of what was given, sides of other areas balanced any motion.
double SetEvidence::PriceOfFalls(const Solution& solution) const {
  std::map<std::string, std::pair<double, double>> values;  // amount and largest deviation, by name
  for (size_t i = 0; i < solution.columns.size(); ++i) {
    const ScanColumn& column = grams_->columns[static_cast<size_t>(solution.columns[i])];
    if (column.value.empty()) continue;
    const auto at = static_cast<Index>(i);
    auto& [amount, deviation] = values[column.value];
    amount += solution.amounts[at];
    deviation = std::max(deviation, DeviationAt(solution, at));
  }
  double price = 0;
  for (const auto& [name, value] : values) {
    const auto [amount, deviation] = value;
    if (amount >= 0) continue;
    const double logarithm = std::log(std::max(1 + amount, kLeastOfAValue));
    price += (logarithm * logarithm - amount * amount) / (2 * deviation * deviation);
  }
  return price;
}

// The standard deviation of an amount, before the runs are seen, at the scale of its change.
double SetEvidence::DeviationAt(const Solution& solution, Index at) const {
  const auto always = static_cast<Index>(always_.size());
  const double sd = grams_->columns[static_cast<size_t>(solution.columns[static_cast<size_t>(at)])].sd;
  return at < always ? sd : sd * solution.scales[at - always];
}

double SetEvidence::LogOf(const Solution& solution) const {
  double log = LogLikelihoods(solution).sum() - solution.penalty + solution.jacobian + solution.log_size -
               PriceOfFalls(solution);
  for (size_t i = 0; i < solution.columns.size(); ++i) {
    const ScanColumn& column = grams_->columns[static_cast<size_t>(solution.columns[i])];
    if (!column.positive && !std::isfinite(column.most)) continue;
    const auto at = static_cast<Index>(i);
    const VectorXd unit = VectorXd::Unit(solution.amounts.size(), at);
    const double deviation = solution.normal.matrixL().solve(unit).norm();
    // An amount that cannot be negative has only half of the prior: 2 Phi(mean / deviation).
    if (column.positive) log += std::log(2.0) + LogNormal(solution.amounts[at] / deviation);
    // The prior also excludes values beyond the largest possible amount.
    if (!std::isfinite(column.most)) continue;
    log += LogNormal((column.most - solution.amounts[at]) / deviation) -
           LogNormal(column.most / DeviationAt(solution, at));
  }
  return log;
}

}  // namespace hydro::diagnose
