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
  std::vector<const RunData*> held_out;  // empty: each run is held out in turn
  std::vector<Change> changes;           // changes that the diagnosis may make
  Sizes sizes;
  int jobs = 1;
  uint64_t seed = 1;
  // The runs that are predicted.
  const std::vector<const RunData*>& predicted() const { return held_out.empty() ? runs : held_out; }
  std::function<bool()> time_is_up;  // may be empty: the search has unlimited time
  ProgressCallback report_progress;  // may be empty

  // `fraction`: of all the work.
  void Report(const char* stage, double fraction) const {
    if (report_progress) report_progress({stage, fraction});
  }
};

// The places of the base parameters that the diagnosis may change.
std::vector<size_t> MovableValues(const ProofContext& context);

// Whether the search has to end with what it has found.
bool TimeIsUp(const ProofContext& context);

// The largest number of changes made to a model.
inline constexpr int kMostChanges = 3;
// Below this squared gap on held-out runs, nothing is left to search for.
inline constexpr double kCloseEnough = 1.25;
// Squared, in noise units: what a model leaves beside the noise is no larger than the noise itself. A
// stricter limit makes no sense, because the noise is known to about 10 %, and starts and values are
// estimates.
inline constexpr double kNoiseAndAsMuchAgain = 2;
// Windows of slow recorders are longer: a start of up to five numbers explains much of fewer samples.
inline constexpr double kFewestSamplesOfAWindow = 60;
// s. Windows of this length let the arm move and the pressures settle, and are short enough that drift does
// not drown what is missing. With 2 s, differences between runs drowned a laboratory drive's friction.
inline constexpr double kHorizon = 0.4;

// s, the length of windows: 0.4 s, more where samples are slow, less in short runs.
double SearchHorizon(const std::vector<const RunData*>& runs);

// Tolerances of fits that are reported, and of fits that are only compared: steps that gain less do not show
// which set is better.
inline constexpr double kToCompare = 1e-3;
FitOptions FineFit(int jobs);
FitOptions FitToCompare(int jobs);

// What is known of base parameters beforehand, where a fit to these runs or windows leaves `sum`: a deviation
// of one standard deviation has to gain its part of that sum.
std::shared_ptr<const Knowledge> KnownAt(const model::ModelDescription& given,
                                         const std::vector<const RunData*>& runs, double sum);

}  // namespace hydro::diagnose
