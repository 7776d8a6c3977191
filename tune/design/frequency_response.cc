#include "tune/design/frequency_response.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/FFT>

#include "base/units.h"

namespace hydro::design {
namespace {

using Spectrum = std::vector<std::complex<double>>;

std::vector<double> HannWindow(size_t length) {
  std::vector<double> window(length);
  for (size_t i = 0; i < length; ++i) {
    window[i] =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length));
  }
  return window;
}

// The signal without its mean, with three quarters of a segment of silence before and after it, so that
// equally many windows cover all of it.
std::vector<double> WithoutMean(const std::vector<double>& signal, size_t length) {
  const double mean = std::accumulate(signal.begin(), signal.end(), 0.0) / static_cast<double>(signal.size());
  const size_t silence = length - length / 4;
  std::vector<double> padded(signal.size() + 2 * silence);
  for (size_t i = 0; i < signal.size(); ++i) padded[silence + i] = signal[i] - mean;
  return padded;
}

// The largest length up to `length` with a fast transform: factors 2, 3 and 5 only.
size_t FastLength(size_t length) {
  for (;; --length) {
    size_t rest = length;
    for (const size_t factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return length;
  }
}

struct CrossSpectra {
  std::vector<double> xx;
  std::vector<double> yy;
  Spectrum xy;  // conj(X) Y
};

CrossSpectra Average(const std::vector<double>& input, const std::vector<double>& output, size_t length) {
  const std::vector<double> window = HannWindow(length);
  const std::vector<double> x_signal = WithoutMean(input, length);
  const std::vector<double> y_signal = WithoutMean(output, length);
  CrossSpectra sums = {std::vector<double>(length / 2), std::vector<double>(length / 2),
                       Spectrum(length / 2)};
  Eigen::FFT<double> transform;
  std::vector<double> segment(length);
  Spectrum x;
  Spectrum y;
  for (size_t first = 0; first + length <= x_signal.size(); first += std::max<size_t>(1, length / 4)) {
    for (size_t i = 0; i < length; ++i) segment[i] = window[i] * x_signal[first + i];
    transform.fwd(x, segment);
    for (size_t i = 0; i < length; ++i) segment[i] = window[i] * y_signal[first + i];
    transform.fwd(y, segment);
    for (size_t k = 0; k < length / 2; ++k) {
      sums.xx[k] += std::norm(x[k]);
      sums.yy[k] += std::norm(y[k]);
      sums.xy[k] += std::conj(x[k]) * y[k];
    }
  }
  return sums;
}

// The gain over lines begin to end as a polynomial in frequency (of degree 2 where there are enough lines),
// by least squares: its value at the centre of power, and the share of the output's power that it explains.
ResponsePoint PointOfBand(const CrossSpectra& spectra, size_t begin, size_t end, double line_hz) {
  double power = 0;
  double moment = 0;
  for (size_t k = begin; k < end; ++k) {
    power += spectra.xx[k];
    moment += spectra.xx[k] * static_cast<double>(k);
  }
  const double centre = moment / power;
  const auto lines = static_cast<double>(end - begin);
  const int unknowns = lines >= 5 ? 3 : lines >= 3 ? 2 : 1;
  Eigen::Matrix3d xx = Eigen::Matrix3d::Zero();
  Eigen::Vector3cd xy = Eigen::Vector3cd::Zero();
  double yy = 0;
  for (size_t k = begin; k < end; ++k) {
    const double offset = 2 * (static_cast<double>(k) - centre) / lines;
    const Eigen::Vector3d basis(1, offset, offset * offset);
    xx += spectra.xx[k] * basis * basis.transpose();
    xy += spectra.xy[k] * basis;
    yy += spectra.yy[k];
  }
  const Eigen::VectorXcd gain =
      xx.topLeftCorner(unknowns, unknowns).cast<std::complex<double>>().ldlt().solve(xy.head(unknowns));
  const double explained = gain.dot(xy.head(unknowns)).real();
  return {centre * line_hz, gain[0], yy > 0 ? std::clamp(explained / yy, 0.0, 1.0) : 0};
}

}  // namespace

std::vector<ResponsePoint> EstimateFrequencyResponse(const std::vector<double>& input,
                                                     const std::vector<double>& output,
                                                     const WelchSettings& settings) {
  if (input.size() != output.size()) {
    throw std::invalid_argument("frequency response: found " + std::to_string(input.size()) +
                                " samples of the input and " + std::to_string(output.size()) +
                                " of the output, must be equal");
  }
  const size_t length = FastLength(
      std::max<size_t>(4, static_cast<size_t>(std::lround(settings.segment_s * settings.sample_rate_hz))));
  if (input.size() < length) {
    throw std::invalid_argument("frequency response: found " + std::to_string(input.size()) +
                                " samples, a segment needs " + std::to_string(length));
  }
  const CrossSpectra spectra = Average(input, output, length);
  const double strongest = *std::max_element(spectra.xx.begin(), spectra.xx.end());
  const double line_hz = settings.sample_rate_hz / static_cast<double>(length);

  std::vector<ResponsePoint> points;
  const int last = static_cast<int>(
      std::floor(settings.points_per_decade * std::log10(settings.last_hz / settings.first_hz) + 1e-9));
  const double half_band = std::pow(10.0, 0.5 / settings.points_per_decade);
  for (int i = 0; i <= last; ++i) {
    const double centre =
        settings.first_hz * std::pow(10.0, static_cast<double>(i) / settings.points_per_decade);
    const auto begin = static_cast<size_t>(std::max(1.0, std::ceil(centre / half_band / line_hz)));
    const auto end =
        std::min(spectra.xx.size(), static_cast<size_t>(std::ceil(centre * half_band / line_hz)));
    double xx = 0;
    for (size_t k = begin; k < end; ++k) xx += spectra.xx[k];
    if (xx > 1e-12 * strongest) points.push_back(PointOfBand(spectra, begin, end, line_hz));
  }
  return points;
}

double Decibels(std::complex<double> gain) { return 20 * std::log10(std::abs(gain)); }

std::vector<double> PhasesDeg(const std::vector<ResponsePoint>& points) {
  std::vector<double> phases;
  for (const ResponsePoint& point : points) {
    double phase = Degrees(std::arg(point.gain));
    if (!phases.empty()) phase -= 360 * std::round((phase - phases.back()) / 360);
    phases.push_back(phase);
  }
  return phases;
}

double BandwidthHz(const std::vector<ResponsePoint>& points, double passband_gain) {
  const double limit = Decibels(passband_gain / std::numbers::sqrt2);
  for (size_t i = points.size(); i-- > 1;) {
    const double before = Decibels(points[i - 1].gain);
    const double after = Decibels(points[i].gain);
    if (after >= limit) break;
    if (before < limit) continue;
    const double part = (before - limit) / (before - after);
    return points[i - 1].frequency_hz * std::pow(points[i].frequency_hz / points[i - 1].frequency_hz, part);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace hydro::design
