// One case of a swept pressure loop, evaluated: fit, bandwidth, what the linearised loop predicts, Bode
// plots.
#pragma once

#include <complex>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/maths/linear_loop.h"
#include "experiments/maths/second_order_fit.h"
#include "experiments/runs/pressure_sweep.h"
#include "model/terms/mode.h"
#include "page/plot.h"
#include "tables/table.h"

namespace hydro::experiments {

// "The bandwidth appears to be about 200/(2 pi) = 32 Hz."
inline constexpr double kPaperBandwidthHz = 200 / (2 * std::numbers::pi);

struct BodeCase {
  std::string key;    // in JSON and as the column's name
  std::string title;  // in plots: what is special about it
  PressureSweep sweep;
  model::Mode mode;     // which the linear prediction holds for
  bool linear = false;  // the loop stays in that mode, so that the prediction must agree

  SweptPressureLoop swept;
  SecondOrderFit fit;                    // without a delay, of the points up to the fit's last_hz
  double low_gain = 0;                   // dp per dp_ref, mean of the points up to 2.5 Hz
  double bandwidth_hz = 0;               // 3 dB below low_gain; NaN: beyond the sweep
  std::vector<ResponsePoint> predicted;  // at the measured frequencies
  double worst_error_db = 0;             // of measured over predicted, where coherence is above .99
  double worst_error_deg = 0;
};

// Modes of a clamped actuator whose pump slips forward: both valves closed, or side 1 (2) held at p_3.
model::Mode BothCompress();
model::Mode Side1Held();
model::Mode Side2Held();

// The linearised loop at the sweep's arm angle, at 1000 psi.
LinearPressureLoop LinearLoop(const PressureSweep& sweep, const model::Mode& mode, const LoopTiming& timing);

// Runs the sweep and evaluates it: fills all but the first five.
void Evaluate(BodeCase* bode_case, double fit_to_hz, const StackRunner& run_stack);

// A JSON object: conditions, results and the points as arrays.
nlohmann::json CaseJson(const BodeCase& bode_case);
// The first case's object without its key and title, and all of them in its `cases`.
nlohmann::json CasesJson(const std::vector<const BodeCase*>& cases);

// frequency_hz, gain_db, phase_deg, coherence, as columns that begin with the case's key.
std::vector<tables::Column> CaseColumns(const BodeCase& bode_case);
std::vector<tables::Column> CaseColumns(const std::vector<const BodeCase*>& cases);

// Points (coherence of .8 and above) or curves of one response, for the two panels of a Bode plot.
struct BodeCurve {
  std::string label;
  std::vector<ResponsePoint> points;
  page::Stroke stroke = page::Stroke::kLine;
  int colour = -1;
};
// The linearised loop of a case, from 1 Hz on.
BodeCurve PredictedCurve(const BodeCase& bode_case, const std::string& label, double last_hz,
                         page::Stroke stroke, int colour);

std::vector<page::Panel> BodePanels(const std::string& title, const std::vector<BodeCurve>& curves,
                                    const std::vector<page::Rule>& vertical, double least_db);
// The panels with one more below them: the coherence of what was measured, all points of it.
std::vector<page::Panel> WithCoherence(std::vector<page::Panel> panels,
                                       const std::vector<BodeCurve>& measured);

// A response at frequencies close enough for a smooth curve.
std::vector<ResponsePoint> Sampled(double first_hz, double last_hz,
                                   const std::function<std::complex<double>(double)>& gain);

}  // namespace hydro::experiments
