// The pressure loop, eq. (16), closed around a linearised actuator: frequency responses and poles, as an
// analog loop or sampled at the plant's ticks. Exact: matrix exponential, eigenvalues.
#pragma once

#include <complex>
#include <vector>

#include "model/linearise.h"
#include "pressure_ctrl/pressure_law.h"

namespace hydro::experiments {

struct LoopTiming {
  double interval = 0;  // s: the voltage is computed at each multiple and held; 0: continuously
  int delay_ticks = 0;  // sampled only: a voltage computed from tick k acts from tick k + this on; 0 or 1
};

class LinearPressureLoop {
 public:
  // `model`: as Linearise gives it. States that nothing moves (an open valve's pressure) and the motor's
  // angle, which nothing depends on, are left out. Throws std::invalid_argument: an interval below 0, a delay
  // that is not 0 or 1 or without interval.
  LinearPressureLoop(const model::LinearModel& model, const LoopTiming& timing);

  // Responses at a frequency, Hz (above 0). Of the sampled loop: samples of the output per samples of the
  // input.
  std::complex<double> PressurePerVolt(double frequency_hz) const;  // dp/v
  std::complex<double> SpeedPerVolt(double frequency_hz) const;     // theta'/v
  std::complex<double> LoopGain(const pressure_ctrl::PressureGains& gains,
                                double frequency_hz) const;  // k_p (dp + k_v theta')/v
  std::complex<double> ClosedGain(const pressure_ctrl::PressureGains& gains,
                                  double frequency_hz) const;  // dp/dp_ref

  // Poles of the closed loop in the s plane, 1/s, from left to right; gains of 0: of the actuator alone.
  // Sampled ones are mapped by s = ln(z)/interval; those at z = 0 are left out.
  std::vector<std::complex<double>> Poles(const pressure_ctrl::PressureGains& gains) const;

  // The largest real part of the closed loop's poles, 1/s: stable below 0.
  double Growth(const pressure_ctrl::PressureGains& gains) const;

  // Those of them that show in dp or in the motor's speed: without, for instance, what the two sides do in
  // common at mid-stroke.
  std::vector<std::complex<double>> VisiblePoles(const pressure_ctrl::PressureGains& gains) const;

  // Of the visible poles that oscillate the one nearest to instability (upper half plane); 0 when none does.
  std::complex<double> LeastDampedPole(const pressure_ctrl::PressureGains& gains) const;

 private:
  std::vector<std::complex<double>> ClosedPoles(const pressure_ctrl::PressureGains& gains,
                                                bool visible_only) const;
  std::complex<double> PerVolt(const std::vector<double>& output, double frequency_hz) const;

  LoopTiming timing_;
  int states_ = 0;
  std::vector<double> A_, B_;       // by columns; sampled: of one interval
  std::vector<double> dp_, speed_;  // rows of C
};

// The largest factor on `gains.k_p` (gains.k_v as it is) with which the loop is stable, and the frequency
// (Hz) at which it then oscillates; factors up to `most` are searched, in steps of 2 % and then by bisection.
struct GainLimit {
  double factor = 0;  // `most` when it is stable there
  double frequency_hz = 0;
};
GainLimit LargestStableFactor(const LinearPressureLoop& loop, const pressure_ctrl::PressureGains& gains,
                              double most);

}  // namespace hydro::experiments
