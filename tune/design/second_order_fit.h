// A second-order model fitted to a measured frequency response.
#pragma once

#include <complex>
#include <vector>

#include "tune/design/frequency_response.h"

namespace hydro::design {

// K wn^2 / (s^2 + 2 zeta wn s + wn^2) exp(-s delay)
struct SecondOrderModel {
  double static_gain = 1;        // K
  double natural_frequency = 0;  // wn, rad/s
  double damping_ratio = 0;      // zeta
  double delay = 0;              // s

  std::complex<double> Gain(double frequency_hz) const;

  // Where the gain is K / sqrt 2.
  double BandwidthHz() const;
};

struct SecondOrderFitSettings {
  double first_hz = 0;  // the fit uses points in this range with at least this coherence
  double last_hz = 1e9;
  double least_coherence = 0.8;
  bool with_delay = false;
};

struct SecondOrderFit {
  SecondOrderModel model;
  double rms_error_db = 0;  // of the points used
  double rms_error_deg = 0;
  int points = 0;
};

// Least squares on the logarithm of measured over fitted gain: an error of 1 dB weighs as much as one of 6.6
// degrees. Throws std::invalid_argument when fewer than four points can be used.
SecondOrderFit FitSecondOrder(const std::vector<ResponsePoint>& points,
                              const SecondOrderFitSettings& settings);

}  // namespace hydro::design
