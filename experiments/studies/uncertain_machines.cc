#include "experiments/studies/uncertain_machines.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/maths/spread.h"
#include "base/parallel.h"
#include "base/units.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/position_loop.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"
#include "runs/step_response.h"
#include "tune/design/bang_bang.h"

namespace hydro::experiments {
namespace {

constexpr double kMotorSpeed = 6000 * kRpm;  // rad/s, of the paper's motor
constexpr size_t kParts = 50;                // of the work, between reports of progress

constexpr int kBins = 25;         // of a parameter's range, for its main effect
constexpr size_t kWorst = 5;      // of each kind
constexpr double kNearly = 0.01;  // relative

double Settling(const UncertainStep& step) {
  return step.settles() ? step.settling : std::numeric_limits<double>::infinity();
}

template <class Quantity>
std::vector<double> Values(const UncertainSteps& steps, const Quantity& quantity) {
  std::vector<double> values;
  for (const UncertainStep& step : steps.drawn) values.push_back(quantity(step));
  return values;
}

template <class Quantity>
Spread SpreadIn(const UncertainSteps& steps, const Quantity& quantity) {
  std::vector<double> values = Values(steps, quantity);
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) { return maths::Quantile(values, share); };
  return {quantity(steps.known), values.front(), at(0.05), at(0.5), at(0.95), at(0.99), values.back()};
}

template <class Condition>
maths::Estimate ShareOf(const UncertainSteps& steps, const Condition& condition) {
  const auto hits = std::count_if(steps.drawn.begin(), steps.drawn.end(), condition);
  return maths::Share(static_cast<int>(hits), static_cast<int>(steps.drawn.size()));
}

// The numbers of the `kWorst` machines with the largest `quantity`.
template <class Quantity>
std::vector<size_t> Worst(const UncertainSteps& steps, const Quantity& quantity) {
  std::vector<size_t> order(steps.drawn.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return quantity(steps.drawn[a]) > quantity(steps.drawn[b]); });
  order.resize(std::min(order.size(), kWorst));
  return order;
}

std::vector<Influence> Influences(const UncertainSteps& steps) {
  const std::vector<double> settling =
      Values(steps, [&](const UncertainStep& s) { return std::min(Settling(s), steps.trial.duration); });
  const std::vector<double> overshoot = Values(steps, [](const auto& s) { return s.overshoot_percent; });
  std::vector<Influence> influences;
  for (size_t base = 0; base < model::BaseParameters().size(); ++base) {
    const auto member = model::BaseParameters()[base].member;
    if (steps.trial.model.parameters.*member == 0) continue;
    const std::vector<double> x = Values(steps, [&](const auto& s) { return s.parameters.*member; });
    influences.push_back({base, model::UncertaintyOf(steps.trial.model, base),
                          maths::RankCorrelation(x, settling), maths::MainEffect(x, settling, kBins),
                          maths::RankCorrelation(x, overshoot), maths::MainEffect(x, overshoot, kBins)});
  }
  std::stable_sort(influences.begin(), influences.end(), [](const Influence& a, const Influence& b) {
    return a.settling_effect > b.settling_effect;
  });
  return influences;
}

Nearly NearlyAsKnown(const UncertainSteps& steps, size_t base) {
  const auto member = model::BaseParameters()[base].member;
  Nearly nearly{.base = base, .within = kNearly};
  std::vector<double> settling, overshoot;
  for (const UncertainStep& step : steps.drawn) {
    const double ratio = step.parameters.*member / (steps.trial.model.parameters.*member);
    if (std::fabs(ratio - 1) > kNearly) continue;
    settling.push_back(Settling(step));
    overshoot.push_back(step.overshoot_percent);
  }
  nearly.count = static_cast<int>(settling.size());
  if (settling.empty()) return nearly;
  std::sort(settling.begin(), settling.end());
  std::sort(overshoot.begin(), overshoot.end());
  nearly.settling_p50 = maths::Quantile(settling, 0.5);
  nearly.settling_p95 = maths::Quantile(settling, 0.95);
  nearly.overshoot_p95 = maths::Quantile(overshoot, 0.95);
  return nearly;
}

// At rest, without weight, dp is near 0 and the motor's torque below T_s, so that eqs. (16) and (17) leave an
// error of up to T_s/(k_1 (k_p + feed-forward) c_1). T_s/k_1 is log-normal, too.
double ShareThatFrictionHolds(const tune::StepTrial& trial) {
  const model::ModelDescription& model = trial.model;
  const model::Parameters& p = model.parameters;
  if (p.T_s == 0) return 0;
  const double gain = (trial.pressure.gains.k_p + trial.pressure.reference_feedforward) * trial.position.c1;
  const double allowed = runs::kSettlingBand * std::fabs(trial.step);
  const double deviation = std::hypot(model::UncertaintyOf(model, model::BasePlace("T_s")),
                                      model::UncertaintyOf(model, model::BasePlace("k_1")));
  const double deviations = std::log(allowed * p.k_1 * gain / p.T_s) / deviation;
  return boost::math::cdf(boost::math::complement(boost::math::normal(), deviations));
}

}  // namespace

tune::StepTrial RetunedTrial(double step, double duration) {
  tune::StepTrial trial = TrialOf(ShippedStackText("retuned"), ShippedModelText("table1"), step);
  trial.duration = duration;
  return trial;
}

UncertainStep StepOf(tune::StepTrial trial, const model::ModelDescription& machine) {
  trial.model = machine;
  const tune::StepRun run = tune::RunStepTrial(trial);
  const design::Response& response = run.response;
  const runs::StepResponse measured =
      runs::MeasureStep(response.time, response.angle, 0, response.time.size(), 0, trial.step);
  UncertainStep step;
  step.parameters = machine.parameters;
  step.shortest = design::FastestSettling(design::MakeRigidDrive(machine.parameters, kMotorSpeed), trial.step,
                                          runs::kSettlingBand);
  step.settling = measured.settling_time_s.value_or(std::numeric_limits<double>::quiet_NaN());
  step.overshoot_percent = measured.overshoot_percent;
  step.final_error = measured.final_error_rad;
  step.saturated = run.saturated;
  step.highest_pressure = run.highest_pressure;
  step.highest_speed = run.highest_speed;
  return step;
}

UncertainSteps StepDrawnModels(const tune::StepTrial& trial, int count, uint64_t seed, int jobs,
                               const std::function<void(double)>& progress) {
  UncertainSteps steps;
  steps.trial = trial;
  steps.seed = seed;
  steps.known = StepOf(trial, trial.model);
  steps.drawn.resize(static_cast<size_t>(count));
  const size_t part = steps.drawn.size() / kParts + 1;
  for (size_t begin = 0; begin < steps.drawn.size(); begin += part) {
    ParallelFor(std::min(part, steps.drawn.size() - begin), jobs, [&](size_t i) {
      steps.drawn[begin + i] = StepOf(trial, model::DrawnModel(trial.model, seed, begin + i));
    });
    progress(static_cast<double>(std::min(begin + part, steps.drawn.size())) /
             static_cast<double>(steps.drawn.size()));
  }
  return steps;
}

UncertainSpread SpreadOf(const UncertainSteps& steps) {
  UncertainSpread spread;
  spread.settling = SpreadIn(steps, Settling);
  spread.shortest = SpreadIn(steps, [](const auto& s) { return s.shortest; });
  spread.ratio = SpreadIn(steps, [](const auto& s) { return Settling(s) / s.shortest; });
  spread.overshoot = SpreadIn(steps, [](const auto& s) { return s.overshoot_percent; });
  spread.error = SpreadIn(steps, [](const auto& s) { return std::fabs(s.final_error); });
  spread.saturated = SpreadIn(steps, [](const auto& s) { return s.saturated; });
  spread.never = ShareOf(steps, [](const auto& s) { return !s.settles(); });
  spread.overshoots = ShareOf(steps, [](const auto& s) { return s.overshoot_percent > kMuchOvershoot; });
  spread.friction_holds = ShareThatFrictionHolds(steps.trial);
  spread.influences = Influences(steps);
  if (!spread.influences.empty()) spread.nearly = NearlyAsKnown(steps, spread.influences.front().base);
  spread.slowest = Worst(steps, Settling);
  spread.most_overshoot = Worst(steps, [](const auto& s) { return s.overshoot_percent; });
  return spread;
}

}  // namespace hydro::experiments
