#include "experiments/studies/bode_case.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kShownCoherence = 0.8;
constexpr double kTrustedCoherence = 0.99;
constexpr double kLowHz = 2.5;

// As in a column: NaN becomes null in JSON.
json Number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

struct Parts {
  std::vector<double> frequency, gain_db, phase_deg, coherence;
  explicit Parts(const std::vector<design::ResponsePoint>& points) : phase_deg(design::PhasesDeg(points)) {
    for (const design::ResponsePoint& point : points) {
      frequency.push_back(point.frequency_hz);
      gain_db.push_back(design::Decibels(point.gain));
      coherence.push_back(point.coherence);
    }
  }
};

}  // namespace

model::Mode BothCompress() {
  model::Mode mode;
  mode.pump = 1;
  return mode;
}

model::Mode Side1Held() {
  model::Mode mode = BothCompress();
  mode.valve_1 = 1;
  return mode;
}

model::Mode Side2Held() {
  model::Mode mode = BothCompress();
  mode.valve_2 = 1;
  return mode;
}

design::LinearPressureLoop LinearLoop(const PressureSweep& sweep, const model::Mode& mode,
                                      const design::LoopTiming& timing) {
  const model::Equations equations(sweep.model,
                                   {.shaft = model::Shaft::kClamped, .arm_angle = sweep.arm_angle});
  double state[model::kMaxStates];
  model::Mode start;
  equations.Start(1000, state, &start);
  return design::LinearPressureLoop(model::Linearise(equations, 0, 0, mode, state), timing);
}

void Evaluate(BodeCase* out, double fit_to_hz, const StackRunner& run_stack) {
  out->swept = RunPressureSweep(out->sweep, run_stack);
  const std::vector<design::ResponsePoint>& points = out->swept.points;
  out->fit = design::FitSecondOrder(points, {.last_hz = fit_to_hz, .least_coherence = kShownCoherence});
  double low_points = 0;
  for (const design::ResponsePoint& point : points) {
    if (point.frequency_hz > kLowHz) break;
    out->low_gain += std::abs(point.gain);
    low_points += 1;
  }
  out->low_gain /= low_points;
  out->bandwidth_hz = design::BandwidthHz(points, out->low_gain);
  const design::LinearPressureLoop loop = LinearLoop(out->sweep, out->mode, {1 / out->sweep.rate_hz, 0});
  for (const design::ResponsePoint& point : points) {
    const std::complex<double> gain = loop.ClosedGain(out->sweep.gains, point.frequency_hz);
    out->predicted.push_back({point.frequency_hz, gain, 1});
    if (point.coherence < kTrustedCoherence) continue;
    const std::complex<double> error = point.gain / gain;
    out->worst_error_db = std::max(out->worst_error_db, std::abs(design::Decibels(error)));
    out->worst_error_deg = std::max(out->worst_error_deg, Degrees(std::abs(std::arg(error))));
  }
}

json CaseJson(const BodeCase& c) {
  const Parts measured(c.swept.points);
  const Parts predicted(c.predicted);
  json out = {{"key", c.key},
              {"title", c.title},
              {"arm_angle_rad", c.sweep.arm_angle},
              {"amplitude_psi", c.sweep.amplitude},
              {"offset_psi", c.sweep.offset},
              {"T_s_in_lbf", c.sweep.model.parameters.T_s},
              {"k_p_V_per_psi", c.sweep.gains.k_p},
              {"k_v_psi_s_per_rad", c.sweep.gains.k_v},
              {"low_frequency_gain", c.low_gain},
              {"bandwidth_hz", Number(c.bandwidth_hz)},
              {"bandwidth_from_0_db_hz", Number(design::BandwidthHz(c.swept.points, 1))},
              {"natural_frequency_rad_s", c.fit.model.natural_frequency},
              {"damping_ratio", c.fit.model.damping_ratio},
              {"static_gain", c.fit.model.static_gain},
              {"fit_error_db", c.fit.rms_error_db},
              {"fit_error_deg", c.fit.rms_error_deg},
              {"saturated_fraction", c.swept.saturated_fraction},
              {"stuck_fraction", c.swept.stuck_fraction},
              {"both_compress_fraction", c.swept.both_compress_fraction},
              {"largest_torque_in_lbf", c.swept.largest_torque},
              {"frequency_hz", measured.frequency},
              {"gain_db", measured.gain_db},
              {"phase_deg", measured.phase_deg},
              {"coherence", measured.coherence}};
  if (c.linear) {
    out["linear_gain_db"] = predicted.gain_db;
    out["linear_phase_deg"] = predicted.phase_deg;
    out["worst_error_db"] = c.worst_error_db;
    out["worst_error_deg"] = c.worst_error_deg;
  }
  return out;
}

json CasesJson(const std::vector<const BodeCase*>& cases) {
  json listed = json::array();
  for (const BodeCase* one : cases) listed.push_back(CaseJson(*one));
  json numbers = listed.front();
  numbers.erase("key");
  numbers.erase("title");
  numbers["cases"] = listed;
  return numbers;
}

std::vector<tables::Column> CaseColumns(const BodeCase& c) {
  Parts measured(c.swept.points);
  return {{c.key + "_frequency_hz", std::move(measured.frequency)},
          {c.key + "_gain_db", std::move(measured.gain_db)},
          {c.key + "_phase_deg", std::move(measured.phase_deg)},
          {c.key + "_coherence", std::move(measured.coherence)}};
}

std::vector<tables::Column> CaseColumns(const std::vector<const BodeCase*>& cases) {
  std::vector<tables::Column> columns;
  for (const BodeCase* one : cases) {
    for (tables::Column& column : CaseColumns(*one)) columns.push_back(std::move(column));
  }
  return columns;
}

BodeCurve PredictedCurve(const BodeCase& bode_case, const std::string& label, double last_hz,
                         page::Stroke stroke, int colour) {
  const design::LinearPressureLoop loop =
      LinearLoop(bode_case.sweep, bode_case.mode, {1 / bode_case.sweep.rate_hz, 0});
  return {label, Sampled(1, last_hz, [&](double hz) { return loop.ClosedGain(bode_case.sweep.gains, hz); }),
          stroke, colour};
}

std::vector<page::Panel> BodePanels(const std::string& title, const std::vector<BodeCurve>& curves,
                                    const std::vector<page::Rule>& vertical, double least_db) {
  page::Panel magnitude{.title = title,
                        .x = {.label = "frequency, Hz", .logarithmic = true},
                        .y = {.label = "gain dp/dp_ref, dB", .min = least_db},
                        .rules = vertical};
  page::Panel phase{.x = {.label = "frequency, Hz", .logarithmic = true}, .y = {.label = "phase, degrees"}};
  for (page::Rule rule : vertical) {
    rule.label.clear();
    phase.rules.push_back(rule);
  }
  for (const BodeCurve& curve : curves) {
    const Parts parts(curve.points);
    page::Curve gain{.label = curve.label,
                     .x = parts.frequency,
                     .y = parts.gain_db,
                     .stroke = curve.stroke,
                     .colour = curve.colour};
    page::Curve angle = gain;
    angle.label.clear();
    angle.y = parts.phase_deg;
    for (size_t i = 0; i < curve.points.size(); ++i) {
      if (parts.gain_db[i] < least_db) gain.y[i] = page::kAutomatic;
      if (parts.coherence[i] < kShownCoherence) gain.y[i] = angle.y[i] = page::kAutomatic;
    }
    magnitude.curves.push_back(std::move(gain));
    phase.curves.push_back(std::move(angle));
  }
  return {magnitude, phase};
}

std::vector<page::Panel> WithCoherence(std::vector<page::Panel> panels,
                                       const std::vector<BodeCurve>& measured) {
  page::Panel coherence{
      .x = panels.front().x, .y = {.label = "coherence", .min = 0, .max = 1.05}, .height = 0.6};
  // The same range as the panels above, whose curves may extend beyond the points.
  std::vector<double> frequencies;
  for (const page::Curve& curve : panels.front().curves) {
    frequencies.insert(frequencies.end(), curve.x.begin(), curve.x.end());
  }
  const auto [least, most] = std::minmax_element(frequencies.begin(), frequencies.end());
  coherence.x.min = *least;
  coherence.x.max = *most;
  for (const BodeCurve& curve : measured) {
    const Parts parts(curve.points);
    coherence.curves.push_back({.x = parts.frequency,
                                .y = parts.coherence,
                                .stroke = page::Stroke::kPoints,
                                .colour = curve.colour});
  }
  panels.push_back(std::move(coherence));
  return panels;
}

std::vector<design::ResponsePoint> Sampled(double first_hz, double last_hz,
                                           const std::function<std::complex<double>(double)>& gain) {
  constexpr int kIntervals = 300;
  std::vector<design::ResponsePoint> points;
  for (int i = 0; i <= kIntervals; ++i) {
    const double frequency = first_hz * std::pow(last_hz / first_hz, static_cast<double>(i) / kIntervals);
    points.push_back({frequency, gain(frequency), 1});
  }
  return points;
}

}  // namespace hydro::experiments
