#include "diagnose/report/picture_parts.h"

#include <algorithm>
#include <cmath>

#include "diagnose/data/run_data.h"

namespace hydro::diagnose {
namespace {

// The size that 99.5 % of the values stay below.
double UsualSize(const std::vector<double>& values) {
  std::vector<double> sizes;
  for (const double value : values) {
    if (std::isfinite(value)) sizes.push_back(std::abs(value));
  }
  if (sizes.empty()) return 0;
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>((sizes.size() - 1) * 995 / 1000);
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

}  // namespace

std::vector<double> Scaled(const std::vector<double>& values, double factor) {
  std::vector<double> scaled = values;
  for (double& value : scaled) value *= factor;
  return scaled;
}

std::vector<double> ScaledResiduals(const std::vector<double>& measured, const std::vector<double>& simulated,
                                    double factor) {
  std::vector<double> left;
  if (simulated.size() != measured.size()) return left;
  for (size_t i = 0; i < measured.size(); ++i) left.push_back(factor * (measured[i] - simulated[i]));
  return left;
}

double NoiseOf(const Diagnosis& diagnosis, model::Channel channel) {
  for (const SignalGap& signal : diagnosis.signals) {
    if (signal.channel == channel) return signal.noise;
  }
  return 0;
}

std::string WithBlanks(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string LabelOf(model::Channel channel, const std::string& unit) {
  return WithBlanks(ChannelName(channel)) + " (" + unit + ")";
}

void SetRange(page::Axis& axis, const page::Range& range) {
  axis.min = range.low;
  axis.max = range.high;
}

double SizeOf(const std::vector<double>& values) {
  page::Range range;
  range.Include(values);
  return range.empty() ? 0 : range.high - range.low;
}

page::Range ResidualRange(const Points& before, const Points& after, double measured_size, double noise) {
  double size = std::max(UsualSize(before.y), UsualSize(after.y));
  if (measured_size > 0) size = std::min(size, measured_size);
  size = std::max(size, 3 * noise);
  return page::Range{-size, size}.WithMargin();
}

page::Curve DrawnCurve(const std::string& label, const Points& points, int colour, page::Weight weight,
                       page::Stroke stroke) {
  page::Curve curve = page::Line(label, points.x, points.y, colour, stroke);
  curve.weight = weight;
  return curve;
}

}  // namespace hydro::diagnose
