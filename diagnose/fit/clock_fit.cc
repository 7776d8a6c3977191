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

double SampleInterval(const RunData& run) { return run.duration() / static_cast<double>(run.samples() - 1); }

// The clock of a signal in ClockDelay::signals.
size_t ClockOf(const std::string& signal) {
  if (signal.starts_with("arm")) return 2;
  return signal.starts_with("motor") ? 1 : 0;
}

RunData Corrected(const RunData& run, const Correction& correction, const model::Parameters& model) {
  const double step = SampleInterval(run);
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

// Whether the delays of all runs' clocks were found.
bool AllFound(const std::vector<RunData>& runs, const std::vector<ClockDelay>& clocks) {
  return std::all_of(runs.begin(), runs.end(), [&](const RunData& run) {
    return std::any_of(clocks.begin(), clocks.end(),
                       [&](const auto& clock) { return clock.run == run.name; });
  });
}

// The model with those parameters free that change with the clocks.
Hypothesis Begin(const model::ModelDescription& model, const std::vector<size_t>& allowed_base) {
  Hypothesis hypothesis;
  hypothesis.model = model;
  for (const size_t i : allowed_base) {
    const std::string& name = model::BaseParameters()[i].info.name;
    for (const char* free : {"J", "b", "T_s", "beta", "c_E"}) {
      if (name == free) hypothesis.base.push_back(i);
    }
  }
  return hypothesis;
}

// Looks for the correction with which the model fits best, one clock and one step at a time.
class CorrectionSearch {
 public:
  CorrectionSearch(const std::vector<RunData>& runs, Hypothesis from, int jobs)
      : runs_(runs), model_(from.model.parameters), best_(std::move(from)), jobs_(jobs) {}

  Correction Run() {
    Consider(at_, 12);
    for (const int step : kSteps) {
      for (int round = 0; round < kRounds; ++round) {
        if (!MoveEachClock(step)) break;
      }
    }
    return at_;
  }

 private:
  // Whether any clock moved.
  bool MoveEachClock(int step) {
    const int most = static_cast<int>(kMostCorrection / SampleInterval(runs_.front()));
    bool moved = false;
    for (size_t clock = 0; clock < at_.size(); ++clock) {
      for (const int sign : {1, -1}) {
        Correction next = at_;
        bool further = false;
        do {
          next[clock] = at_[clock] + sign * step;
          further = std::abs(next[clock]) <= most && Consider(next, 3);
          moved |= further;
        } while (further);
      }
    }
    return moved;
  }

  // Takes the correction if the model fits better with it than with the best so far.
  bool Consider(const Correction& correction, int iterations) {
    const std::vector<RunData> moved = AllCorrected(runs_, correction, model_);
    const std::vector<const RunData*> pointers = PointersTo(moved);
    FitOptions options;
    options.most_iterations = iterations;
    options.tolerance = 1e-3;
    options.jobs = jobs_;
    const Fitted fitted = Fit(best_, pointers, MeasuredStarts(pointers), options);
    if (!fitted.ok() || !(fitted.squared_gap() < least_)) return false;
    least_ = fitted.squared_gap();
    best_ = fitted.hypothesis;
    at_ = correction;
    return true;
  }

  const std::vector<RunData>& runs_;
  model::Parameters model_;  // as given
  Hypothesis best_;
  int jobs_;
  double least_ = std::numeric_limits<double>::infinity();
  Correction at_ = {0, 0, 0};
};

}  // namespace

void CorrectClocks(const model::ModelDescription& model, const std::vector<size_t>& allowed_base, int jobs,
                   std::vector<RunData>* runs, std::vector<RunData>* held_out,
                   std::vector<ClockDelay>* clocks) {
  if (clocks->empty() || runs->empty() || !AllFound(*runs, *clocks)) return;
  const Correction found = CorrectionSearch(*runs, Begin(model, allowed_base), jobs).Run();
  if (found == Correction{0, 0, 0}) return;
  for (ClockDelay& clock : *clocks) {
    const double by = found[ClockOf(clock.signals.front())] * SampleInterval(runs->front());
    clock.delay += by;
    clock.error = std::hypot(clock.error, by);
  }
  *runs = AllCorrected(*runs, found, model.parameters);
  *held_out = AllCorrected(*held_out, found, model.parameters);
}

}  // namespace hydro::diagnose
