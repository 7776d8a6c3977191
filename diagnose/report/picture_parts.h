// What the pictures of a diagnosis share: colours, labels, residuals, ranges.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "page/plot.h"
#include "page/range.h"

namespace hydro::diagnose {

inline constexpr double kPageWidth = 960;
inline constexpr double kRowHeight = 104;

// Colours of the palette; they mean the same throughout the report.
inline constexpr int kAfter = 0, kBefore = 1, kRefit = 5;

inline constexpr char kBeforeLabel[] = "model as given";
inline constexpr char kAfterLabel[] = "with what was found";
inline constexpr char kNoiseLabel[] = "twice the noise";

struct Points {
  std::vector<double> x, y;
};

std::vector<double> Scaled(const std::vector<double>& values, double factor);

// measured - simulated, scaled; empty without a simulation.
std::vector<double> ScaledResiduals(const std::vector<double>& measured, const std::vector<double>& simulated,
                                    double factor);

// A channel's noise, in the model's unit; 0 where it is not known.
double NoiseOf(const Diagnosis& diagnosis, model::Channel channel);

// "pump torque" for "pump_torque".
std::string WithBlanks(std::string name);
std::string LabelOf(model::Channel channel, const std::string& unit);

void SetRange(page::Axis& axis, const page::Range& range);

// From the smallest to the largest value.
double SizeOf(const std::vector<double>& values);

// The range of residuals, limited to the size of the measured signal.
page::Range ResidualRange(const Points& before, const Points& after, double measured_size, double noise);

page::Curve DrawnCurve(const std::string& label, const Points& points, int colour, page::Weight weight,
                       page::Stroke stroke = page::Stroke::kLine);

}  // namespace hydro::diagnose
