#include "diagnose/fit/identifiable.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace hydro::diagnose {

namespace {

constexpr double kVague = 0.3;  // relative standard deviation

// The scale of changes of a parameter that may be 0.
double SizeOf(const FreeParameter& parameter, const Sizes& sizes) {
  if (parameter.value != 0) return std::abs(parameter.value);
  const std::string& name = parameter.name;
  if (name == "f") return 0.1 * sizes.torque / sizes.pressure;
  if (name == "c_E" || name == "c_I") return 0.01 * sizes.flow;
  if (name == "b") return 0.1 * sizes.torque / sizes.speed;
  return 0.1 * sizes.torque;
}

}  // namespace

std::vector<size_t> Identifiable(const Hypothesis& given, const std::vector<const RunData*>& runs,
                                 const std::vector<model::StartState>& starts,
                                 const std::vector<size_t>& allowed, const Sizes& sizes, int jobs) {
  Hypothesis all = given;
  all.base = allowed;
  FitOptions options;
  options.most_iterations = 0;
  options.jobs = jobs;
  const Fitted fitted = Fit(all, runs, starts, options);
  if (!fitted.ok()) return {};
  const std::vector<FreeParameter> free = all.Free();
  const auto p = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(p, p);
  for (const RunFit& run : fitted.runs) {
    information += Eigen::Map<const Eigen::MatrixXd>(run.information.data(), p, p);
  }
  // In relative changes; residuals are already in noise units.
  for (Eigen::Index i = 0; i < p; ++i) {
    const FreeParameter& parameter = free[static_cast<size_t>(i)];
    const double size = parameter.logarithmic ? 1 : SizeOf(parameter, sizes);
    information.row(i) *= size;
    information.col(i) *= size;
  }
  // Pivoted Cholesky: each turn chooses the parameter that the runs determine best, given those already
  // chosen.
  std::vector<size_t> chosen;
  std::vector<bool> used(free.size(), false);
  for (;;) {
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < p; ++i) {
      if (!used[static_cast<size_t>(i)] && (best < 0 || information(i, i) > information(best, best)))
        best = i;
    }
    if (best < 0 || information(best, best) * kVague * kVague < 1) break;
    used[static_cast<size_t>(best)] = true;
    chosen.push_back(free[static_cast<size_t>(best)].unknown.index);
    const Eigen::VectorXd column = information.col(best) / std::sqrt(information(best, best));
    information -= column * column.transpose();
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace hydro::diagnose
