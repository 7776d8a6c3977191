// One case of a swept pressure loop, evaluated: fit, bandwidth, the linearised loop's prediction, Bode plots.
#pragma once

#include <complex>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "base/tables/table.h"
#include "experiments/runs/pressure_sweep.h"
#include "model/terms/state.h"
#include "page/plot.h"
#include "tune/design/linear_loop.h"
#include "tune/design/second_order_fit.h"

namespace hydro::experiments {

// "The bandwidth appears to be about 200/(2 pi) = 32 Hz."
inline constexpr double kPaperBandwidthHz = 200 / (2 * std::numbers::pi);

struct BodeCase {
  std::string key;    // in JSON and in column names
  std::string title;  // in plots: what distinguishes this case
  PressureSweep sweep;
  model::Mode mode;     // the mode that the linear prediction assumes
  bool linear = false;  // the loop stays in that mode, so the prediction must agree

  SweptPressureLoop swept;
  design::SecondOrderFit fit;                    // without delay, over the points up to the fit's last_hz
  double low_gain = 0;                           // dp per dp_ref, mean of the points up to 2.5 Hz
  double bandwidth_hz = 0;                       // 3 dB below low_gain; NaN: beyond the sweep
  std::vector<design::ResponsePoint> predicted;  // at the measured frequencies
  double worst_error_db = 0;  // of measured over predicted, where the coherence exceeds .99
  double worst_error_deg = 0;
};

// Modes of a clamped actuator whose pump slips forward: both valves closed, or side 1 (or 2) held at p_3.
model::Mode BothCompress();
model::Mode Side1Held();
model::Mode Side2Held();

// The linearised loop at the sweep's arm angle, at 1000 psi.
design::LinearPressureLoop LinearLoop(const PressureSweep& sweep, const model::Mode& mode,
                                      const design::LoopTiming& timing);

// Runs the sweep and evaluates it: fills all fields but the first five.
void Evaluate(BodeCase* bode_case, double fit_to_hz, const StackRunner& run_stack);

// A JSON object: conditions, results and the points as arrays.
nlohmann::json CaseJson(const BodeCase& bode_case);
// The first case's object without its key and title. Its `cases` has all cases.
nlohmann::json CasesJson(const std::vector<const BodeCase*>& cases);

// Columns frequency_hz, gain_db, phase_deg and coherence, their names prefixed by the case's key.
std::vector<tables::Column> CaseColumns(const BodeCase& bode_case);
std::vector<tables::Column> CaseColumns(const std::vector<const BodeCase*>& cases);

// One response for the two panels of a Bode plot, as points (coherence of .8 and above) or as curves.
struct BodeCurve {
  std::string label;
  std::vector<design::ResponsePoint> points;
  page::Stroke stroke = page::Stroke::kLine;
  int colour = -1;
};
// A case's linearised loop, from 1 Hz up.
BodeCurve PredictedCurve(const BodeCase& bode_case, const std::string& label, double last_hz,
                         page::Stroke stroke, int colour);

std::vector<page::Panel> BodePanels(const std::string& title, const std::vector<BodeCurve>& curves,
                                    const std::vector<page::Rule>& vertical, double least_db);
// The panels, with one more below them for the coherence of all measured points.
std::vector<page::Panel> WithCoherence(std::vector<page::Panel> panels,
                                       const std::vector<BodeCurve>& measured);

// A response sampled densely enough for a smooth curve.
std::vector<design::ResponsePoint> Sampled(double first_hz, double last_hz,
                                           const std::function<std::complex<double>(double)>& gain);

}  // namespace hydro::experiments
