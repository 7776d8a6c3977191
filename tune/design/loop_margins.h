// The margins of a sampled loop, computed from its poles: how far gain, phase and delay are from instability.
#pragma once

#include <complex>
#include <functional>
#include <limits>
#include <vector>

namespace hydro::design {

struct LoopMargins {
  bool stable = false;
  double spectral_radius = 0;  // of the closed loop from one period to the next; stable below 1
  // The smallest factor above 1 on the loop's gain at which a stable loop becomes unstable; infinity: none.
  // For an unstable loop, the factor below 1 at and below which the loop would be stable; 0: there is none.
  double gain = std::numeric_limits<double>::infinity();
  double gain_hz = 0;     // at which it then oscillates
  double least_gain = 0;  // the largest factor below 1 at which a stable loop becomes unstable; 0: none
  // The smallest rotation of the loop's phase, and the smallest extra delay, at which a stable loop becomes
  // unstable. They are 180 and infinity when the gain is below 1 at all frequencies, and both 0 for an
  // unstable loop.
  double phase_deg = 180;
  double phase_hz = 0;                                     // where the gain is 1
  double delay = std::numeric_limits<double>::infinity();  // s
  // The smallest damping ratio of the oscillating poles that the loop moves. A pole faster than half the
  // loop's sampling rate appears as a slower one that decays as fast.
  double damping_ratio = 1;
  // Hz, from the loop's reference to its output: the frequency above which the gain stays below 1/sqrt(2). 0
  // for an unstable loop and where it was not requested.
  double bandwidth_hz = 0;
  // The smallest distance of the loop's response from -1 in the complex plane, the inverse of the largest
  // sensitivity; 0 for an unstable loop.
  double distance = std::numeric_limits<double>::infinity();
};

// Whether a pole on the positive real axis (a motion that grows without oscillating) makes a loop unstable.
// If it is ignored, an oscillation that grows far below the highest frequency with a gain of 1 does not count
// either, nor does the response there: another loop must stop that motion.
enum class Drift { kCounts, kIgnored };

// A filter over z through which the reference passes before it enters where the output is fed back: c1/(c1 +
// c2 (1 - 1/z)/T) for a derivative on the measured output alone.
using Filter = std::function<std::complex<double>(const std::complex<double>& z)>;

// `poles` gives the closed loop's poles in the z plane, sampled every `period` s, with the loop's gain
// multiplied by a factor; the number of poles is the same for each factor. The open loop's response follows
// from the poles at factors 1 and 0, 1 + L(z) = product of (z - closed pole)/(z - open pole), so only
// eigenvalues are needed. The bandwidth is that of filter(z) L(z)/(1 + L(z)); without a filter it is not
// computed.
LoopMargins MarginsOf(const std::function<std::vector<std::complex<double>>(double factor)>& poles,
                      double period, Drift drift = Drift::kCounts, const Filter& filter = {});

// The worse of both, number by number.
LoopMargins WorstOf(const LoopMargins& a, const LoopMargins& b);

}  // namespace hydro::design
