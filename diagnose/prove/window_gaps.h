// What a model leaves of single windows.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "diagnose/prove/proof_windows.h"
#include "model/response.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// The logarithm of a squared gap, kept finite. Typical gaps are means of these.
double LogarithmOf(double squared_gap);

// One window, predicted from its measured start. A step of least squares corrects the start as far as its
// errors allow.
struct WindowGap {
  bool tested = false;  // false: it cannot be simulated, or needs more steps than a window may take
  // Mean squares of the residuals, in noise units; NaN for channels that are not compared.
  std::array<double, model::kChannels> squared{};
  double sum = 0;    // of squared residuals, in noise units
  size_t count = 0;  // of residuals
  model::StartState start{};

  // The squared gap: the geometric mean over the channels, so that the channel with the finest sensor does
  // not decide alone.
  double Typical() const;
};

WindowGap GapOf(const model::ModelDescription& model, const RunData& window);

// The model that predicts the run at this place.
using ModelOfRun = std::function<const model::ModelDescription&(size_t run)>;
std::vector<WindowGap> GapsOfEach(const model::ModelDescription& model,
                                  const std::vector<const RunData*>& windows, int jobs);
std::vector<WindowGap> GapsOfWindows(const ModelOfRun& model, const JudgingWindows& windows, int jobs);

// The mean of log(gap before / gap after) over the windows on which both models can be tested.
struct GapFall {
  double logarithm = 0;  // positive: `after` is smaller
  double error = 0;      // its standard error, from the scatter between windows
  size_t windows = 0;

  // Whether the fall is at least this part of the gap, and larger than its own error.
  bool Exceeds(double part) const;
};

// Each window and channel counts by a factor of 4 at most: a prediction that diverges shows that it does, not
// how far. Channels that both predict to their noise do not count. Without windows to compare, the fall is 0
// from 0 windows.
GapFall FallOf(const std::vector<WindowGap>& before, const std::vector<WindowGap>& after);

// Whether at least half of the windows can be tested.
bool IsTested(const std::vector<WindowGap>& gaps);

// The squared gap of all windows that can be tested, a geometric mean; NaN if there are none.
double TypicalGap(const std::vector<WindowGap>& gaps);

}  // namespace hydro::diagnose
