#include "diagnose/fit/clock_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/terms/parameter_info.h"
#include "runs/run_delays.h"

namespace hydro::diagnose {
namespace {

constexpr double kMostCorrection = 0.15;       // s
constexpr std::array<int, 2> kSteps = {2, 1};  // samples
constexpr int kRounds = 3;                     // over all clocks, for each step size

// By how many samples command, motor and arm are later than the balances suggest.
using Correction = std::array<int, 3>;

double Interval(const RunData& run) { return run.duration() / static_cast<double>(run.samples() - 1); }

// The clock of a signal in ClockDelay::signals.
size_t ClockOf(const std::string& signal) {
  if (signal.starts_with("arm")) return 2;
  return signal.starts_with("motor") ? 1 : 0;
}

RunData Corrected(const RunData& run, const Correction& correction, const model::Parameters& model) {
  const double step = Interval(run);
  runs::MeasuredRun moved = run.measured;
  std::vector<runs::SignalDelay> delays = {{&runs::MeasuredRun::voltage, step * correction[0]},
                                           {&runs::MeasuredRun::pressure_ref, step * correction[0]},
                                           {&runs::MeasuredRun::motor_speed, step * correction[1]},
                                           {&runs::MeasuredRun::motor_angle, step * correction[1]},
                                           {&runs::MeasuredRun::arm_angle, step * correction[2]},
                                           {&runs::MeasuredRun::arm_speed, step * correction[2]}};
  runs::RemoveDelays(delays, &moved);
  RunData corrected = PrepareRun(std::move(moved), model);
  // Keep the noise that timing errors add.
  for (SignalData& signal : corrected.signals) {
    if (const SignalData* before = run.Find(signal.channel)) signal.noise = before->noise;
  }
  corrected.name = run.name;
  return corrected;
}

std::vector<RunData> AllCorrected(const std::vector<RunData>& runs, const Correction& correction,
                                  const model::Parameters& model) {
  std::vector<RunData> corrected;
  corrected.reserve(runs.size());
  for (const RunData& run : runs) corrected.push_back(Corrected(run, correction, model));
  return corrected;
}

}  // namespace

void CorrectClocks(const model::ModelDescription& model, const std::vector<size_t>& allowed_base, int jobs,
                   std::vector<RunData>* runs, std::vector<RunData>* held_out,
                   std::vector<ClockDelay>* clocks) {
  if (clocks->empty() || runs->empty()) return;
  for (const RunData& run : *runs) {
    const bool found =
        std::any_of(clocks->begin(), clocks->end(), [&](const auto& clock) { return clock.run == run.name; });
    if (!found) return;
  }
  Hypothesis best;
  best.model = model;
  for (const size_t i : allowed_base) {
    const std::string& name = model::BaseParameters()[i].info.name;
    for (const char* free : {"J", "b", "T_s", "beta", "c_E"}) {
      if (name == free) best.base.push_back(i);
    }
  }
  double least = std::numeric_limits<double>::infinity();
  Correction at = {0, 0, 0};
  const auto consider = [&](const Correction& correction, int iterations) {
    const std::vector<RunData> moved = AllCorrected(*runs, correction, model.parameters);
    std::vector<const RunData*> pointers;
    std::vector<model::StartState> starts;
    for (const RunData& run : moved) {
      pointers.push_back(&run);
      starts.push_back(run.start);
    }
    FitOptions options;
    options.most_iterations = iterations;
    options.tolerance = 1e-3;
    options.jobs = jobs;
    const Fitted fitted = Fit(best, pointers, starts, options);
    if (!fitted.ok() || !(fitted.squared_gap() < least)) return false;
    least = fitted.squared_gap();
    best = fitted.hypothesis;
    at = correction;
    return true;
  };
  consider(at, 12);
  const int most = static_cast<int>(kMostCorrection / Interval(runs->front()));
  for (const int step : kSteps) {
    bool moved = true;
    for (int round = 0; round < kRounds && moved; ++round) {
      moved = false;
      for (size_t clock = 0; clock < at.size(); ++clock) {
        for (const int sign : {1, -1}) {
          Correction next = at;
          bool further = false;
          do {
            next[clock] = at[clock] + sign * step;
            further = std::abs(next[clock]) <= most && consider(next, 3);
            moved |= further;
          } while (further);
        }
      }
    }
  }
  if (at == Correction{0, 0, 0}) return;
  for (ClockDelay& clock : *clocks) {
    const double by = at[ClockOf(clock.signals.front())] * Interval(runs->front());
    clock.delay += by;
    clock.error = std::hypot(clock.error, by);
  }
  *runs = AllCorrected(*runs, at, model.parameters);
  *held_out = AllCorrected(*held_out, at, model.parameters);
}

}  // namespace hydro::diagnose
