// Short stretches of a recording in which its signals move, and how well a model predicts them.
#pragma once

#include <array>
#include <vector>

#include "model/response.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// Up to `most` stretches that do not overlap, those first in which most signals move most. Of each signal, `noise`
// is what no prediction needs to be better than: the noise, and a little of how far the signal moves in the run.
std::vector<runs::MeasuredRun> MovingWindows(const runs::MeasuredRun& run, size_t most);

// Which channels move in a window by several times their noise. Where none does, MovingWindows takes no window.
std::array<bool, model::kChannels> ChannelsThatMove(const runs::MeasuredRun& window);

// The mean squared error of each channel's prediction in a window, from the start that suits the model best or,
// much quicker, that nearby samples give.
// 1: a tenth of the channel's movement there (of an angle: beyond a straight line); about 100: predicts
// nothing. NaN: not measured. A window that cannot be simulated has kUnpredicted.
using PredictionErrors = std::array<double, model::kChannels>;
inline constexpr double kUnpredicted = 1e4;
enum class WindowStart { kFitted, kMeasured };
PredictionErrors PredictWindow(const model::ModelDescription& model, const runs::MeasuredRun& window,
                               WindowStart start);

}  // namespace hydro::diagnose
