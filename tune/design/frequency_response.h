// Frequency responses estimated from measured inputs and outputs by averaged cross-spectra.
#pragma once

#include <complex>
#include <vector>

namespace hydro::design {

struct ResponsePoint {
  double frequency_hz = 0;
  std::complex<double> gain;  // output per input
  // 0 to 1: the share of the output's power around this frequency that a linear system driven by this input
  // explains. Noise, friction and saturation lower it.
  double coherence = 0;
};

struct WelchSettings {
  double sample_rate_hz = 0;
  double segment_s = 2;  // length of the averaged segments; gain changes within 2/segment_s are smeared
  double first_hz = 1;   // range of the points
  double last_hz = 100;
  int points_per_decade = 20;  // each point also averages the spectra over its band
};

// Welch's method: segments under Hann windows that overlap by three quarters (their squares then add up to a
// constant, which cancels the first-order effect of what happens across segment ends), and H1 = S_xy / S_xx.
// The gain may vary within the band around each point: a local polynomial is fitted to it by least squares,
// and the coherence counts what that polynomial explains. Means are removed first. The signals should begin
// and end at rest. Each point lies at the input's centre of power in its band. A band without input, or
// narrower than the spacing of the spectrum's lines, gives no point. Throws std::invalid_argument for signals
// of unequal length or shorter than one segment.
std::vector<ResponsePoint> EstimateFrequencyResponse(const std::vector<double>& input,
                                                     const std::vector<double>& output,
                                                     const WelchSettings& settings);

double Decibels(std::complex<double> gain);

// Phases in degrees, unwrapped; the first lies in (-180, 180].
std::vector<double> PhasesDeg(const std::vector<ResponsePoint>& points);

// The frequency above which the gain stays more than 3 dB (a factor of sqrt 2) below `passband_gain`,
// interpolated linearly in dB over log frequency. NaN when the gain was never above that level or is not
// below it at the end.
double BandwidthHz(const std::vector<ResponsePoint>& points, double passband_gain);

}  // namespace hydro::design
