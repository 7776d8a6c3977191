// Figure 8's design model under the digital law: eq. (17) sampled with a zero-order hold, exact from sample
// to sample.
#pragma once

#include <cstddef>
#include <vector>

#include "tune/design/position_design.h"

namespace hydro::design {

// alpha over time.
struct Response {
  std::vector<double> time;   // s
  std::vector<double> angle;  // rad
};

// State `output` of x' = A x, starting at `state`, every `spacing` seconds, by the matrix exponential. A is
// stored by columns.
Response FreeResponse(const std::vector<double>& A, const std::vector<double>& state, size_t output,
                      double duration, double spacing);

// Response to a reference step at time 0, from rest, every `spacing` seconds, by the matrix exponential of
// the closed loop.
Response ContinuousStep(const DesignModel& model, double gain, DerivativeForm form, double step,
                        double duration, double spacing);

// The same with the law sampled every `interval` seconds and its command held. The reference steps at the
// sample at time 0. The response has `points` points per interval.
Response SampledStep(const DesignModel& model, double gain, double interval, DerivativeForm form, double step,
                     double duration, int points);

// Poles of the sampled loop in the z plane. The form of the derivative only moves zeros: it changes where the
// reference enters, not the loop.
std::vector<Complex> SampledPoles(const DesignModel& model, double gain, double interval);
double SpectralRadius(const DesignModel& model, double gain, double interval);

// The sampling interval, s, at which a loop that is stable at shorter intervals becomes unstable.
double LargestStableInterval(const DesignModel& model, double gain);

// The gain, psi s/rad, at which the sampled loop becomes unstable.
double SampledCriticalGain(const DesignModel& model, double interval);

}  // namespace hydro::design
