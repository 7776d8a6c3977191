// Figure 4: the closed pressure loop follows a square wave.
#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/tracking_study.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

struct Level {
  double reference = 0;  // psi
  double error = 0;      // psi, reference - dp at its end
};

// Increasing constant references, each held for 1 s.
std::vector<Level> HoldLevels(const StackRunner& run_stack, const std::string& name, double feedforward) {
  std::vector<Level> levels;
  std::string steps;
  for (const double reference : {50.0, 100.0, 200.0, 300.0, 450.0, 600.0}) {
    steps += fmt::format("{}[{}, {}]", levels.empty() ? "" : ", ", levels.size(), reference);
    levels.push_back({reference, 0});
  }
  const PressureLoopRun run = RunPressureLoop(
      run_stack, {.name = name,
                  .reference = "signal = \"pressure\"\nkind = \"steps\"\nsteps = [" + steps + "]\n",
                  .duration = static_cast<double>(levels.size()),
                  .feedforward = feedforward,
                  .motion = ""});
  for (size_t i = 0; i < levels.size(); ++i) {
    levels[i].error = MeanError(run, static_cast<double>(i + 1) - 1 / kLoopRate);
  }
  return levels;
}

// A feed-forward and the error that it leaves.
struct Remainder {
  std::string label;
  double feedforward = 0;
  std::vector<Level> levels;
};

page::Panel HeldPanel(const TrackingStudy& study) {
  return {.title = fmt::format("A reference of {} psi, held", kWaveAmplitude),
          .x = {.label = "time, s", .min = 0, .max = 0.5},
          .y = {.label = "p_2 - p_1, psi", .min = kWaveAmplitude - 25, .max = kWaveAmplitude + 10},
          .curves = {SignalCurve("without feed-forward", study.hold, study.hold.dp, 0, 0.5),
                     SignalCurve("with feed-forward", study.hold_with, study.hold_with.dp, 1, 0.5)},
          .rules = {{"reference", false, kWaveAmplitude},
                    {"closed form, without", false, SettledPressure(kWaveAmplitude, 0)},
                    {"closed form, with", false, SettledPressure(kWaveAmplitude, study.feedforward)}}};
}

page::Panel LevelsPanel(const std::vector<Remainder>& remainders) {
  page::Panel panel{.title = "Steady-state error at rising references",
                    .x = {.label = "reference, psi", .min = 0, .max = 650},
                    .y = {.label = "reference - (p_2 - p_1), psi"}};
  int colour = 0;
  for (const Remainder& remainder : remainders) {
    page::Curve measured{.label = remainder.label};
    measured.stroke = page::Stroke::kPoints;
    measured.colour = colour++;
    page::Curve closed = measured;
    closed.label.clear();
    closed.stroke = page::Stroke::kLine;
    for (const Level& level : remainder.levels) {
      measured.x.push_back(level.reference);
      measured.y.push_back(level.error);
      closed.x.push_back(level.reference);
      closed.y.push_back(level.reference - SettledPressure(level.reference, remainder.feedforward));
    }
    panel.curves.push_back(std::move(closed));
    panel.curves.push_back(std::move(measured));
  }
  return panel;
}

json LevelsJson(const Remainder& remainder) {
  json out = json::array();
  for (const Level& level : remainder.levels) {
    out.push_back(
        {{"reference_psi", level.reference},
         {"steady_state_error_psi", level.error},
         {"closed_form_psi", level.reference - SettledPressure(level.reference, remainder.feedforward)}});
  }
  return out;
}

// The wave with the loop sampled ten times as often, closer to an analog one. Always in this process:
// separate processes cannot keep up with that rate in real time.
TrackingError TrackFinely() {
  return MeasureTracking(
      RunPressureLoop(RunStackInProcess, {.name = "fig4-50kHz",
                                          .reference = WaveReference("square", kWaveFrequency),
                                          .duration = kWaveDuration,
                                          .motion = "",
                                          .rate = 10 * kLoopRate}),
      kWaveSettled);
}

std::vector<Remainder> HoldAllLevels(const ExperimentOptions& options, const TrackingStudy& study) {
  std::vector<Remainder> remainders = {
      {"no feed-forward", 0, {}},
      {fmt::format("{:.5f} V/psi: all but friction", study.feedforward), study.feedforward, {}},
      {fmt::format("{:.5f} V/psi: no error at {} psi", study.tuned_feedforward, kWaveAmplitude),
       study.tuned_feedforward,
       {}}};
  for (size_t i = 0; i < remainders.size(); ++i) {
    remainders[i].levels =
        HoldLevels(options.run_stack, fmt::format("fig4-levels-{}", i), remainders[i].feedforward);
  }
  return remainders;
}

// in-lbf, the torque that a jump of the reference demands if dp had settled and the pump stopped before it.
double JumpTorque(const TrackingStudy& study) {
  return 2 * kWaveAmplitude * PressureLoopParameters().k_1 * study.gains.k_p;
}

std::string Explanation(const TrackingStudy& study) {
  const TrackingError& error = study.error;
  const TrackingError& slow = study.by_frequency.front().error;
  const double T_pmax = PressureLoopParameters().T_pmax;
  return fmt::format(
             "A jump of {} psi demands 2 A k_1 k_p = {:.0f} in-lbf, but the motor has {}, so it is at its "
             "limit for {:.0f} % of the time, and dp changes as fast as {} in-lbf can accelerate the pump. "
             "It peaks at {:.0f} psi, and the reference reverses before it settles. At 1 Hz it has time to "
             "settle: {:.1f} % of the time at the limit, and an RMS error of {:.0f} psi instead of {:.0f}. ",
             2 * kWaveAmplitude, JumpTorque(study), T_pmax, 100 * error.saturated_fraction, T_pmax,
             error.highest, 100 * slow.saturated_fraction, slow.rms, error.rms) +
         SteadyStateText(study);
}

Finding SaturationFinding(const TrackingStudy& study, const TrackingError& finer) {
  const TrackingError& error = study.error;
  const double jump = JumpTorque(study);
  const double T_pmax = PressureLoopParameters().T_pmax;
  return {9, "Figure 4's simulation has the constraint |T_p| <= 40 in-lb; its reference is not printed.",
          fmt::format(
              "A jump from {:+} to {:+} psi demands 2 A k_1 k_p = {:.0f} in-lbf, {:.1f} times the limit "
              "({:.0f} at {} Hz, where dp has not settled before it). At {} Hz the motor is at the limit "
              "{:.0f} % of the time and dp peaks at {:+.1f} and {:+.1f} psi ({:+.1f} and {:+.1f} with the "
              "loop sampled at 50 kHz).",
              -kWaveAmplitude, kWaveAmplitude, jump, jump / T_pmax, study.largest_demand, kWaveFrequency,
              kWaveFrequency, 100 * error.saturated_fraction, error.highest, error.lowest, finer.highest,
              finer.lowest),
          "Shown in Figure 4, with the torque and its limit below the pressure."};
}

void AddNumbers(const TrackingStudy& study, const TrackingError& finer,
                const std::vector<Remainder>& remainders, ExperimentResult* result) {
  json numbers = ParseJson(result->numbers);
  numbers["demand_at_a_settled_jump_in_lbf"] = JumpTorque(study);
  numbers["at_50_khz"] = {{"highest_dp_psi", finer.highest}, {"lowest_dp_psi", finer.lowest}};
  numbers["steady_state_by_reference"] = LevelsJson(remainders[0]);
  numbers["with_feedforward"]["steady_state_by_reference"] = LevelsJson(remainders[1]);
  numbers["with_tuned_feedforward"] = {{"feedforward_V_per_psi", study.tuned_feedforward},
                                       {"steady_state_by_reference", LevelsJson(remainders[2])}};
  result->numbers = JsonText(numbers);
}

}  // namespace

ExperimentResult RunFig4(const ExperimentOptions& options) {
  const TrackingStudy study = RunTrackingStudy(options, "fig4", "square");
  const TrackingError finer = TrackFinely();
  const std::vector<Remainder> remainders = HoldAllLevels(options, study);
  ExperimentResult result = DescribeTracking(study);
  result.paper_says =
      "Figure 4 shows dp following a square wave in experiment and simulation, with |T_p| <= 40 in-lb. A "
      "small feed-forward linear in dp_ref could eliminate the steady-state error.";
  result.explanation = Explanation(study);
  result.comparisons.push_back(
      {"torque that the loop demands at a jump", "in-lbf", "limited to 40", JumpTorque(study),
       study.largest_demand, "expected: 2 A k_1 k_p, had dp settled and the pump stopped before the jump"});
  result.comparisons.push_back(
      {"steady peaks of dp", "psi", "", page::kAutomatic, study.error.highest,
       fmt::format(
           "in the other direction {:.1f}; {:.1f} with the loop sampled at 50 kHz, closer to an analog loop",
           study.error.lowest, finer.highest)});
  result.findings = {SaturationFinding(study, finer)};
  AddNumbers(study, finer, remainders, &result);
  result.pictures.push_back(
      {"-hold",
       {.caption = "Closed pressure loop, Table 1, clamped at α = 0. Below: points are runs of the stack, "
                   "lines the balance of eqs. (4) and (16) in closed form.",
        .panels = {HeldPanel(study), LevelsPanel(remainders)}}});
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
