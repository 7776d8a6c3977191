// What every step of a diagnosis needs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "diagnose/fit/fit.h"
#include "diagnose/prove/progress.h"

namespace hydro::diagnose {

struct ProofContext {
  model::ModelDescription given;
  std::vector<const RunData*> runs;
  std::vector<const RunData*> held_out;  // empty: the runs are held out in turn
  std::vector<Change> changes;           // those that may be made
  Sizes sizes;
  int jobs = 1;
  uint64_t seed = 1;
  // The runs that are predicted.
  const std::vector<const RunData*>& predicted() const { return held_out.empty() ? runs : held_out; }
  std::function<bool()> time_is_up;  // may be empty: the search has all the time it needs
  ProgressCallback report_progress;  // may be empty

  // `fraction`: of all the work.
  void Report(const char* stage, double fraction) const {
    if (report_progress) report_progress({stage, fraction});
  }
};

// Whether the search has to end with what it has.
bool TimeIsUp(const ProofContext& context);

// The most changes that are made to a model.
inline constexpr int kMostChanges = 3;
// Below this squared gap on held-out runs, nothing is left to search for.
inline constexpr double kCloseEnough = 1.25;
// s. Long enough for the arm to move and the pressures to settle, short enough that drift does not drown what
// is missing. With 2 s, what differs from run to run drowned a laboratory drive's friction.
inline constexpr double kHorizon = 0.4;

// s. How long windows are: 0.4 s, more where samples are slow, less in short runs.
double SearchHorizon(const std::vector<const RunData*>& runs);

// How what is reported is fitted, and what is only compared: steps that gain less say nothing about which is better.
inline constexpr double kToCompare = 1e-3;
FitOptions FineFit(int jobs);
FitOptions FitToCompare(int jobs);

// What is known of base parameters beforehand, where a fit to these runs or windows leaves `sum`: a deviation of one standard deviation
// has to gain its part.
std::shared_ptr<const Knowledge> KnownAt(const model::ModelDescription& given,
                                         const std::vector<const RunData*>& runs, double sum);

}  // namespace hydro::diagnose
