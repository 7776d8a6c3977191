#include "experiments/studies/leakage_fit.h"

#include <ceres/ceres.h>
#include <spdlog/fmt/fmt.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/maths/spread.h"
#include "experiments/studies/paper_units.h"
#include "model/actuator.h"

namespace hydro::experiments {
namespace {

constexpr double kLeast = 1e-9;  // in^3/(s psi), bounds of the search
constexpr double kMost = 1e-3;
constexpr double kStep = 1e-4;          // in a logarithm, for derivatives
constexpr double kIdentifiable = 0.25;  // half an interval, relative
constexpr double kNormal95 = 1.96;      // there are thousands of degrees of freedom
// A start at the model's p_3 to the last bit, below which its valves would not let it start.
constexpr double kAccumulator = std::numeric_limits<double>::quiet_NaN();

// The parameters taken as known that matter most.
struct KnownParameter {
  const char* name;
  double model::Parameters::*member;
};
constexpr std::array<KnownParameter, 6> kKnown = {{{"k_1", &model::Parameters::k_1},
                                                   {"T_s", &model::Parameters::T_s},
                                                   {"D", &model::Parameters::D},
                                                   {"beta", &model::Parameters::beta},
                                                   {"V_ms", &model::Parameters::V_ms},
                                                   {"p_3", &model::Parameters::p_3}}};

// The model with these leakages, whose logarithms are those of in^3/(s psi).
model::ModelDescription WithLeakage(model::ModelDescription model, double log_c_E, double log_c_I) {
  const double unit = PaperUnitIn(model.units, "in^3/(s psi)");
  model.parameters.c_E = unit * std::exp(log_c_E);
  model.parameters.c_I = unit * std::exp(log_c_I);
  return model;
}

// How the model holds the shaft in the run, from rest.
model::ActuatorOptions Conditions(const model::ModelDescription& model, const runs::MeasuredRun& run,
                                  double pressure) {
  return {.shaft = model::Shaft::kClamped,
          .arm_angle = PaperUnitIn(model.units, "rad", 1) * run.arm_angle_rad,
          .initial_pressure = PaperUnitIn(model.units, "psi") * pressure};
}

// Standard deviation of a signal's noise if it is not given: from the differences of neighbours, half of
// which are below 0.6745 sqrt(2) deviations.
double Noise(const runs::MeasuredSignal& signal) {
  if (signal.noise.has_value()) return *signal.noise;
  std::vector<double> differences;
  for (size_t i = 1; i < signal.values.size(); ++i) {
    const double difference = std::abs(signal.values[i] - signal.values[i - 1]);
    if (!std::isnan(difference)) differences.push_back(difference);
  }
  if (differences.empty()) return 1;
  return std::max(maths::Median(std::move(differences)) / (0.6745 * std::sqrt(2.0)), 1e-6);
}

// Mean of the first values, before anything acts.
double StartOf(const runs::MeasuredSignal& signal, size_t resting) {
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < signal.values.size() && (i < resting || count == 0); ++i) {
    if (std::isnan(signal.values[i])) continue;
    sum += signal.values[i];
    ++count;
  }
  return sum / count;
}

// A run, with the data for a comparison with a simulation.
struct Case {
  const runs::MeasuredRun* run;
  double p1_noise, p2_noise;
  double pressure;  // psi, of both sides at the start; NaN: the model's p_3

  // Residuals of p1 and p2 in standard deviations, sample by sample; 0 where a value is missing.
  Eigen::VectorXd Residuals(const SimulatedRun& simulated) const {
    const auto n = static_cast<Eigen::Index>(run->samples());
    Eigen::VectorXd residuals = Eigen::VectorXd::Zero(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<size_t>(i);
      const double r1 = (simulated.p1[k] - run->p1.values[k]) / p1_noise;
      const double r2 = (simulated.p2[k] - run->p2.values[k]) / p2_noise;
      if (!std::isnan(r1)) residuals[2 * i] = r1;
      if (!std::isnan(r2)) residuals[2 * i + 1] = r2;
    }
    return residuals;
  }
};

// Checks for the shaft and sensors that the fit needs.
void CheckConditions(const runs::MeasuredRun& run, const model::ModelDescription& model) {
  if (run.shaft != model::Shaft::kClamped) {
    throw InputError(run.file + ": found a shaft that is " +
                     (run.shaft == model::Shaft::kFree ? "free" : "driven") +
                     ", allowed a clamped one: the arm's motion would mask the leakage");
  }
  if (run.bypass) {
    throw InputError(
        run.file +
        ": found the bypass open, allowed a run with it closed: at p_1 = p_2 nothing leaks across");
  }
  for (const auto& [signal, name] : {std::pair(&run.p1, "p1"), std::pair(&run.p2, "p2")}) {
    if (!signal->measured()) {
      throw InputError(run.file + ": found no " + name +
                       ", allowed a run with p1 and p2: only both sides tell c_E from c_I");
    }
  }
  try {
    const model::Actuator possible(model, Conditions(model, run, kAccumulator));
  } catch (const model::ModelError& error) {
    throw InputError(run.file + ": " + error.what());
  }
}

// Checks for a torque that overcomes friction, and for the pressure that it builds up.
void CheckSwing(const runs::MeasuredRun& run, const model::Parameters& p, double largest, double noise) {
  double least_dp = std::numeric_limits<double>::infinity(), most_dp = -least_dp;
  for (size_t i = 0; i < run.samples(); ++i) {
    const double dp = run.p2.values[i] - run.p1.values[i];
    if (std::isnan(dp)) continue;
    least_dp = std::min(least_dp, dp);
    most_dp = std::max(most_dp, dp);
  }
  const std::string allowed = ", allowed steps of torque well above it, so that pressure builds up and leaks";
  if (largest <= p.T_s) {
    throw InputError(
        fmt::format("{}: found a motor torque of at most {:.4g} in-lbf, which friction holds (T_s = "
                    "{:.4g} in-lbf){}",
                    run.file, largest, p.T_s, allowed));
  }
  if (!(most_dp - least_dp > 10 * noise)) {
    throw InputError(
        fmt::format("{}: found p_2 - p_1 from {:.4g} to {:.4g} psi with a noise of {:.3g} psi, allowed "
                    "a swing of ten times the noise: torques well above T_s = {:.4g} in-lbf",
                    run.file, least_dp, most_dp, noise, p.T_s));
  }
}

// Checks that a voltage that overcomes friction raises the pressure of the side to which it drives the pump.
// (A smaller voltage may oppose what is left from before.)
void CheckDirection(const runs::MeasuredRun& run, const model::Parameters& p) {
  double along = 0;  // V psi
  for (size_t i = 0; i < run.samples(); ++i) {
    const double dp = run.p2.values[i] - run.p1.values[i];
    if (std::isnan(dp) || std::abs(p.k_1 * run.voltage.values[i]) <= p.T_s) continue;
    along += run.voltage.values[i] * dp;
  }
  if (along < 0) {
    throw InputError(run.file +
                     ": found p_2 - p_1 against the sign of the voltage, allowed p_2 rising under a positive "
                     "voltage: exchange p1 and p2, or give the voltage the scale -1");
  }
}

// psi, both sides at the start; NaN: at p_3. Missing first values say nothing about it; the model comes to
// rest at p_3.
double StartPressure(const runs::MeasuredRun& run, double p_3, size_t resting, double noise) {
  if (std::isnan(run.p1.values.front()) || std::isnan(run.p2.values.front())) return kAccumulator;
  const double p1 = StartOf(run.p1, resting), p2 = StartOf(run.p2, resting);
  if (std::abs(p1 - p2) > 5 * noise) {
    throw InputError(
        fmt::format("{}: found a start at p_1 = {:.4g} psi, p_2 = {:.4g} psi, allowed a start at rest with "
                    "both sides at the same pressure: wait without voltage before the run",
                    run.file, p1, p2));
  }
  return (p1 + p2) / 2 > p_3 + 5 * noise ? (p1 + p2) / 2 : kAccumulator;
}

// Throws where the run cannot support the fit.
Case MakeCase(const runs::MeasuredRun& run, const model::ModelDescription& model) {
  CheckConditions(run, model);
  const model::Parameters p = PaperParameters(model);
  Case result{&run, Noise(run.p1), Noise(run.p2), kAccumulator};
  const double noise = std::hypot(result.p1_noise, result.p2_noise);
  double largest = 0;  // in-lbf
  size_t resting = run.samples();
  for (size_t i = 0; i < run.samples(); ++i) {
    const double torque = std::min(std::abs(p.k_1 * run.voltage.values[i]), p.T_pmax);
    if (torque > p.T_s) resting = std::min(resting, i + 1);
    largest = std::max(largest, torque);
  }
  CheckSwing(run, p, largest, noise);
  CheckDirection(run, p);
  result.pressure = StartPressure(run, p.p_3, std::min<size_t>(resting, 100), noise);
  return result;
}

// The information in a Fisher matrix of the logarithms.
LeakageInformation Information(const Eigen::Matrix2d& fisher, double c_E, double c_I) {
  LeakageInformation information;
  const double infinity = std::numeric_limits<double>::infinity();
  const double determinant = fisher.determinant();
  const bool regular = determinant > 1e-12 * fisher(0, 0) * fisher(1, 1);
  information.c_E_error = regular ? std::sqrt(fisher(1, 1) / determinant) : infinity;
  information.c_I_error = regular ? std::sqrt(fisher(0, 0) / determinant) : infinity;
  information.correlation = -fisher(0, 1) / std::sqrt(fisher(0, 0) * fisher(1, 1));
  const Eigen::Vector2d values(c_E, c_I);
  const Eigen::Matrix2d in_units =
      values.cwiseInverse().asDiagonal() * fisher * values.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(in_units);
  const Eigen::Vector2d best = solver.eigenvectors().col(1);
  information.c_I_weight = best[1] / best[0];
  information.combination_error = 1 / std::sqrt(solver.eigenvalues()[1]) / std::abs(best.dot(values));
  return information;
}

// The residuals of one run as Ceres asks for them.
struct RunResiduals {
  const model::ModelDescription* model;
  const Case* run_case;

  bool operator()(double const* const* logs, double* residuals) const {
    const SimulatedRun simulated =
        SimulateClamped(WithLeakage(*model, logs[0][0], logs[0][1]), *run_case->run, run_case->pressure);
    const Eigen::VectorXd values = run_case->Residuals(simulated);
    std::copy(values.data(), values.data() + values.size(), residuals);
    return true;
  }
};

double Cost(const model::ModelDescription& model, const std::vector<Case>& cases, const double* logs) {
  double cost = 0;
  for (const Case& run_case : cases) {
    cost += run_case
                .Residuals(
                    SimulateClamped(WithLeakage(model, logs[0], logs[1]), *run_case.run, run_case.pressure))
                .squaredNorm();
  }
  return cost;
}

// Starts from the best point of a coarse grid, so that no guess is needed.
bool Solve(const model::ModelDescription& model, const std::vector<Case>& cases, double* logs) {
  double least = std::numeric_limits<double>::infinity();
  for (const double c_E : {1e-7, 1e-6, 1e-5, 1e-4}) {
    for (const double c_I : {1e-7, 1e-6, 1e-5, 1e-4}) {
      const double at[] = {std::log(c_E), std::log(c_I)};
      const double cost = Cost(model, cases, at);
      if (!(cost < least)) continue;
      least = cost;
      logs[0] = at[0];
      logs[1] = at[1];
    }
  }
  ceres::NumericDiffOptions differences;
  differences.relative_step_size = 1e-5;  // relative to logarithms of about -12
  ceres::Problem problem;
  for (const Case& run_case : cases) {
    auto* cost = new ceres::DynamicNumericDiffCostFunction<RunResiduals, ceres::CENTRAL>(
        new RunResiduals{&model, &run_case}, ceres::TAKE_OWNERSHIP, differences);
    cost->AddParameterBlock(2);
    cost->SetNumResiduals(static_cast<int>(2 * run_case.run->samples()));
    problem.AddResidualBlock(cost, nullptr, logs);
  }
  for (int i = 0; i < 2; ++i) {
    problem.SetParameterLowerBound(logs, i, std::log(kLeast));
    problem.SetParameterUpperBound(logs, i, std::log(kMost));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-8;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.termination_type == ceres::CONVERGENCE;
}

maths::Estimate Interval(double value, double relative_error) {
  const double factor = std::exp(kNormal95 * relative_error);
  return {value, value / factor, value * factor};
}

// Sums the information from the runs, part by part.
struct FisherSums {
  Eigen::Matrix2d floating = Eigen::Matrix2d::Zero(), held_side = floating, floating_dp = floating,
                  held_dp = floating;

  void Add(const Case& run_case, const SimulatedRun& simulated, double p_3,
           const Eigen::MatrixX2d& jacobian) {
    const double noise = std::hypot(run_case.p1_noise, run_case.p2_noise);
    for (size_t i = 0; i < run_case.run->samples(); ++i) {
      const auto k = static_cast<Eigen::Index>(2 * i);
      const Eigen::Matrix2d both = jacobian.row(k).transpose() * jacobian.row(k) +
                                   jacobian.row(k + 1).transpose() * jacobian.row(k + 1);
      const Eigen::RowVector2d dp =
          (run_case.p2_noise * jacobian.row(k + 1) - run_case.p1_noise * jacobian.row(k)) / noise;
      // The model holds a side at exactly p_3, to the last bit, while its valve is open.
      const bool held = simulated.p1[i] == p_3 || simulated.p2[i] == p_3;
      (held ? held_side : floating) += both;
      (held ? held_dp : floating_dp) += dp.transpose() * dp;
    }
  }
};

// What all runs say about the fitted values.
struct Evidence {
  FisherSums sums;
  double squares = 0;  // of the residuals
  int64_t count = 0;   // of the residuals
  // The change of the cost's gradient with 1 % of each parameter that is taken as known.
  std::vector<Eigen::Vector2d> pulls = std::vector<Eigen::Vector2d>(kKnown.size(), Eigen::Vector2d::Zero());
};

// Adds a run to the evidence and its simulation to the fit.
void AddRun(const model::ModelDescription& model, const double* logs, const Case& run_case,
            Evidence* evidence, LeakageFit* fit) {
  const model::ModelDescription found = WithLeakage(model, logs[0], logs[1]);
  const auto simulate = [&](const model::ModelDescription& with) {
    return SimulateClamped(with, *run_case.run, run_case.pressure);
  };
  const SimulatedRun simulated = simulate(found);
  const Eigen::VectorXd residuals = run_case.Residuals(simulated);
  Eigen::MatrixX2d jacobian(residuals.size(), 2);
  for (int j = 0; j < 2; ++j) {
    double up[] = {logs[0], logs[1]}, down[] = {logs[0], logs[1]};
    up[j] += kStep;
    down[j] -= kStep;
    jacobian.col(j) = (run_case.Residuals(simulate(WithLeakage(model, up[0], up[1]))) -
                       run_case.Residuals(simulate(WithLeakage(model, down[0], down[1])))) /
                      (2 * kStep);
  }
  evidence->sums.Add(run_case, simulated, PaperParameters(model).p_3, jacobian);
  evidence->squares += residuals.squaredNorm();
  for (const double residual : residuals) evidence->count += residual != 0;
  for (size_t i = 0; i < kKnown.size(); ++i) {
    // A thousandth is small enough to be linear across sticks and slips.
    model::ModelDescription changed = found;
    changed.parameters.*kKnown[i].member *= 1.001;
    evidence->pulls[i] += 10 * jacobian.transpose() * (run_case.Residuals(simulate(changed)) - residuals);
  }
  fit->simulated.push_back(simulated);
  fit->p1_noise.push_back(run_case.p1_noise);
  fit->p2_noise.push_back(run_case.p2_noise);
}

// How well the values are determined, and by which measurements.
void SetIntervals(const Evidence& evidence, double c_E, double c_I, LeakageFit* fit) {
  const FisherSums& sums = evidence.sums;
  const Eigen::Matrix2d all = sums.floating + sums.held_side;
  fit->rms = std::sqrt(evidence.squares / static_cast<double>(std::max<int64_t>(1, evidence.count - 2)));
  fit->information = Information(all, c_E, c_I);
  fit->floating = Information(sums.floating, c_E, c_I);
  fit->held = Information(sums.held_side, c_E, c_I);
  fit->floating_difference = Information(sums.floating_dp, c_E, c_I);
  fit->held_difference = Information(sums.held_dp, c_E, c_I);
  fit->all_difference = Information(sums.floating_dp + sums.held_dp, c_E, c_I);
  // Residuals above the noise mean that the model lacks something: widen the intervals by as much.
  const double scale = std::max(1.0, fit->rms);
  fit->c_E = Interval(c_E, scale * fit->information.c_E_error);
  fit->c_I = Interval(c_I, scale * fit->information.c_I_error);
  fit->combination =
      Interval(c_E + fit->information.c_I_weight * c_I, scale * fit->information.combination_error);
  for (const auto& [estimate, name] : {std::pair(&fit->c_E, "c_E"), std::pair(&fit->c_I, "c_I")}) {
    if (!(estimate->high <= (1 + kIdentifiable) * estimate->value)) fit->not_identifiable.push_back(name);
  }
  for (size_t i = 0; i < kKnown.size(); ++i) {
    const Eigen::Vector2d shift = -all.ldlt().solve(evidence.pulls[i]);  // one Gauss-Newton step
    fit->shifts.push_back({kKnown[i].name, 100 * shift[0], 100 * shift[1]});
  }
}

}  // namespace

SimulatedRun SimulateClamped(const model::ModelDescription& model, const runs::MeasuredRun& run,
                             double pressure) {
  model::Actuator actuator(model, Conditions(model, run, pressure));
  const double psi = PaperUnitIn(model.units, "psi");
  SimulatedRun simulated;
  for (size_t i = 0; i < run.samples(); ++i) {
    if (i > 0) actuator.Advance(run.voltage.values[i - 1], run.time[i] - run.time[0]);
    const model::Measurement now = actuator.Measure();
    simulated.p1.push_back(now.p1 / psi);
    simulated.p2.push_back(now.p2 / psi);
    simulated.motor_speed.push_back(now.motor_speed);
  }
  return simulated;
}

LeakageFit FitLeakage(const model::ModelDescription& model, const std::vector<runs::MeasuredRun>& runs) {
  std::vector<Case> cases;
  cases.reserve(runs.size());
  for (const runs::MeasuredRun& run : runs) cases.push_back(MakeCase(run, model));
  double logs[2];
  LeakageFit fit;
  fit.converged = Solve(model, cases, logs);
  Evidence evidence;
  for (const Case& run_case : cases) AddRun(model, logs, run_case, &evidence, &fit);
  SetIntervals(evidence, std::exp(logs[0]), std::exp(logs[1]), &fit);
  return fit;
}

}  // namespace hydro::experiments
