// The motion of a driven shaft, from noisy or coarse samples of it: differentiated as they are, they would
// pump noise.
#pragma once

#include <memory>
#include <vector>

#include "trajectory/trajectory.h"

namespace hydro::diagnose {

// Smoothest motion through samples of an angle and, where measured, of its rate (else empty), NaN where
// missing; the noises are their standard deviations. How smooth it is the samples say: the jerk is taken for
// white noise of the strength that makes them likeliest, and the motion is what is then expected of it (a
// quintic smoothing spline). Constant before the first time and after the last. At least one angle must be
// there.
std::unique_ptr<trajectory::Trajectory> SmoothMotion(const std::vector<double>& time,
                                                     const std::vector<double>& angle, double angle_noise,
                                                     const std::vector<double>& rate, double rate_noise);

}  // namespace hydro::diagnose
