// Frequency responses from measured inputs and outputs, by averaged cross-spectra.
#pragma once

#include <complex>
#include <vector>

namespace hydro::experiments {

struct ResponsePoint {
  double frequency_hz = 0;
  std::complex<double> gain;  // output per input
  // 0 to 1: the share of the output's power around this frequency that a linear system driven by this input
  // explains. Below 1: noise, friction, saturation.
  double coherence = 0;
};

struct WelchSettings {
  double sample_rate_hz = 0;
  double segment_s = 2;  // length of the averaged pieces; a gain that changes within 2/segment_s is smeared
  double first_hz = 1;   // points lie between these two
  double last_hz = 100;
  int points_per_decade = 20;  // spectra are also averaged over the band around each point
};

// Welch's method: segments under Hann windows that overlap by three quarters (so that their squares add up
// to a constant, which cancels the first-order effect of what happens across their ends), and H1 = S_xy /
// S_xx. Within the band around each point the gain may vary: it is a local polynomial there, fitted by least
// squares, and the coherence counts what that polynomial explains. Means are taken off first. The signals
// should begin and end at rest. A point lies at the input's centre of power in its band; bands without
// input, or narrower than the spectrum's lines, give no point. Throws std::invalid_argument: unequal
// lengths, or shorter than one segment.
std::vector<ResponsePoint> EstimateFrequencyResponse(const std::vector<double>& input,
                                                     const std::vector<double>& output,
                                                     const WelchSettings& settings);

double Decibels(std::complex<double> gain);

// Phases in degrees, without jumps by 360 between neighbours; the first lies in (-180, 180].
std::vector<double> PhasesDeg(const std::vector<ResponsePoint>& points);

// The frequency from which on the gain is more than 3 dB (a factor of sqrt 2) below `passband_gain`, between
// points on straight lines in dB over log frequency; NaN when it never was above or is not below at the end.
double BandwidthHz(const std::vector<ResponsePoint>& points, double passband_gain);

}  // namespace hydro::experiments
