// Figure 8's design model under the digital law: eq. (17) sampled with a zero-order hold, step by step exact.
#pragma once

#include <cstddef>
#include <vector>

#include "experiments/maths/position_design.h"

namespace hydro::experiments {

// alpha over time.
struct Response {
  std::vector<double> time;   // s
  std::vector<double> angle;  // rad
};

// State `output` of x' = A x from `state` on, at `spacing` seconds: by the matrix exponential. A by columns.
Response FreeResponse(const std::vector<double>& A, const std::vector<double>& state, size_t output,
                      double duration, double spacing);

// The answer to a step of the reference at time 0, from rest, at `spacing` seconds: by the matrix exponential
// of the closed loop.
Response ContinuousStep(const DesignModel& model, double gain, DerivativeForm form, double step,
                        double duration, double spacing);

// The same with the law sampled each `interval` seconds and its command held. The reference steps at the
// sample at time 0. `points` per interval are computed.
Response SampledStep(const DesignModel& model, double gain, double interval, DerivativeForm form, double step,
                     double duration, int points);

// Poles of the sampled loop in the z plane. The form of the derivative moves only zeros: it changes where the
// reference enters, nothing in the loop.
std::vector<Complex> SampledPoles(const DesignModel& model, double gain, double interval);
double SpectralRadius(const DesignModel& model, double gain, double interval);

// The sampling interval, s, at which the loop that is stable at shorter ones loses its stability.
double LargestStableInterval(const DesignModel& model, double gain);

// The gain, psi s/rad, at which the sampled loop loses its stability.
double SampledCriticalGain(const DesignModel& model, double interval);

}  // namespace hydro::experiments
