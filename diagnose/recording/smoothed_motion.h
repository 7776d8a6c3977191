// The motion of a driven shaft from noisy or coarse samples. The direct derivative of the samples would feed
// noise into the simulation.
#pragma once

#include <memory>
#include <vector>

#include "model/trajectory/trajectory.h"

namespace hydro::diagnose {

// The smoothest motion through samples of an angle and, if measured, of its rate (otherwise empty). NaN is a
// missing sample. The noises are their standard deviations. The samples determine the smoothness: the jerk is
// modelled as white noise of the strength that makes the samples likeliest, and the motion is its expected
// value given the samples (a quintic smoothing spline). The motion is constant before the first time and
// after the last. At least one angle must be present.
std::unique_ptr<trajectory::Trajectory> SmoothMotion(const std::vector<double>& time,
                                                     const std::vector<double>& angle, double angle_noise,
                                                     const std::vector<double>& rate, double rate_noise);

}  // namespace hydro::diagnose
