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

// One window, predicted from its measured start, which a step of least squares corrects as far as its errors allow.
struct WindowGap {
  bool tested = false;  // false: it cannot be simulated, or takes more steps than a window may
  // Mean squares of the residuals, in noise units; NaN for channels that are not compared.
  std::array<double, model::kChannels> squared{};
  double sum = 0;    // of squared residuals, in noise units
  size_t count = 0;  // of residuals
  model::StartState start{};

  // The squared gap: the geometric mean over the channels, so that the one with the finest sensor does not decide alone.
  double Typical() const;
};

WindowGap GapOf(const model::ModelDescription& model, const RunData& window);

// Which model predicts the run at this place.
using ModelOfRun = std::function<const model::ModelDescription&(size_t run)>;
std::vector<WindowGap> GapsOfEach(const model::ModelDescription& model,
                                  const std::vector<const RunData*>& windows, int jobs);
std::vector<WindowGap> GapsOfWindows(const ModelOfRun& model, const JudgingWindows& windows, int jobs);

// The mean of log(gap before / gap after) over the windows that both can be tested on.
struct GapFall {
  double logarithm = 0;  // positive: `after` is smaller
  double error = 0;      // its standard error, from the scatter between windows
  size_t windows = 0;

  // Whether it is at least this part of the gap, and more than its own error.
  bool Exceeds(double part) const;
};

// Of each window and channel no more than a factor of 4 counts: one that diverges says that it does, and not how far. Channels that
// both predict to their noise have no say. Without windows to compare: nothing, from no window.
GapFall FallOf(const std::vector<WindowGap>& before, const std::vector<WindowGap>& after);

// Whether half of the windows or more can be tested.
bool IsTested(const std::vector<WindowGap>& gaps);

// The squared gap of all windows that can be tested, a geometric mean; NaN without any.
double TypicalGap(const std::vector<WindowGap>& gaps);

}  // namespace hydro::diagnose
