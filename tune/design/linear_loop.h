// The pressure loop, eq. (16), closed around a linearised actuator: frequency responses and poles, as an
// analog loop or sampled at the plant's ticks. Exact, by matrix exponential and eigenvalues.
#pragma once

#include <complex>
#include <vector>

#include "model/linearise.h"
#include "pressure_ctrl/law/pressure_law.h"

namespace hydro::design {

struct LoopTiming {
  double interval = 0;  // s; the voltage is computed at each multiple and held; 0: continuous
  int delay_ticks = 0;  // sampled only; 0 or 1: ticks from computing a voltage to its effect
};

class LinearPressureLoop {
 public:
  // `model` comes from Linearise. States that do not change (an open valve's pressure) are left out, and so
  // is the motor's angle, on which nothing depends. Throws std::invalid_argument for an interval below 0, a
  // delay other than 0 or 1, or a delay without an interval.
  LinearPressureLoop(const model::LinearModel& model, const LoopTiming& timing);

  // Frequency responses at a frequency in Hz (above 0). For a sampled loop, they relate input samples to
  // output samples.
  std::complex<double> PressurePerVolt(double frequency_hz) const;  // dp/v
  std::complex<double> SpeedPerVolt(double frequency_hz) const;     // theta'/v
  std::complex<double> LoopGain(const pressure_ctrl::PressureGains& gains,
                                double frequency_hz) const;  // k_p (dp + k_v theta')/v
  std::complex<double> ClosedGain(const pressure_ctrl::PressureGains& gains,
                                  double frequency_hz) const;  // dp/dp_ref

  // Poles of the closed loop in the s plane, 1/s, from left to right; with gains of 0, the actuator's own.
  // Sampled poles are mapped by s = ln(z)/interval, except those at z = 0, which are left out.
  std::vector<std::complex<double>> Poles(const pressure_ctrl::PressureGains& gains) const;

  // The largest real part of the closed loop's poles, 1/s; negative when the loop is stable.
  double Growth(const pressure_ctrl::PressureGains& gains) const;

  // The poles that appear in dp or in the motor's speed. The common motion of the two sides at mid-stroke,
  // for instance, appears in neither.
  std::vector<std::complex<double>> VisiblePoles(const pressure_ctrl::PressureGains& gains) const;

  // The visible oscillating pole nearest to instability (upper half plane); 0 when none oscillates.
  std::complex<double> LeastDampedPole(const pressure_ctrl::PressureGains& gains) const;

 private:
  std::vector<std::complex<double>> ClosedPoles(const pressure_ctrl::PressureGains& gains,
                                                bool visible_only) const;
  std::complex<double> PerVolt(const std::vector<double>& output, double frequency_hz) const;

  LoopTiming timing_;
  int states_ = 0;
  std::vector<double> A_, B_;       // by columns; sampled: over one interval
  std::vector<double> dp_, speed_;  // rows of C
};

// The largest factor on `gains.k_p`, with gains.k_v unchanged, at which the loop is stable, and the frequency
// (Hz) at which it then oscillates. Factors up to `most` are searched in steps of 2 %, then by bisection.
struct GainLimit {
  double factor = 0;  // `most` when the loop is stable there
  double frequency_hz = 0;
};
GainLimit LargestStableFactor(const LinearPressureLoop& loop, const pressure_ctrl::PressureGains& gains,
                              double most);

}  // namespace hydro::design
