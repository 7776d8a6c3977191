// The Monte Carlo study of Figure 10's retuned loop: how fast gains for Table 1 are on machines that differ
// from Table 1.
#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/figures/fig10_runs.h"
#include "experiments/figures/fig10_uncertainty_pictures.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/uncertain_machines.h"
#include "model/terms/parameter_info.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kWatched = 2;  // s, after the step
constexpr double kRecordedShare = 0.95;

const std::string& NameOf(size_t base) { return model::BaseParameters()[base].info.name; }

json AsJson(const Spread& spread) {
  return {{"table_1", spread.known},  {"lowest", spread.lowest}, {"p5", spread.p5},
          {"p50", spread.p50},        {"p95", spread.p95},       {"p99", spread.p99},
          {"highest", spread.highest}};
}

json AsJson(const maths::Estimate& share) {
  return {{"share", share.value}, {"ci95", {share.low, share.high}}};
}

// One machine: its step, and its parameters over those of the model.
json MachineJson(const UncertainSteps& steps, size_t number) {
  const UncertainStep& step = steps.drawn[number];
  json ratios = json::object();
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    const double known = steps.trial.model.parameters.*parameter.member;
    if (known != 0) ratios[parameter.info.name] = step.parameters.*parameter.member / known;
  }
  return {{"machine", number},
          {"settling_time_s", step.settling},
          {"shortest_settling_time_s", step.shortest},
          {"overshoot_percent", step.overshoot_percent},
          {"steady_state_error_rad", step.final_error},
          {"saturated_time_s", step.saturated},
          {"parameters_over_table_1", ratios}};
}

json MachinesJson(const UncertainSteps& steps, const std::vector<size_t>& numbers) {
  json machines = json::array();
  for (const size_t number : numbers) machines.push_back(MachineJson(steps, number));
  return machines;
}

json InfluencesJson(const UncertainSpread& spread) {
  json rows = json::array();
  for (const Influence& influence : spread.influences) {
    rows.push_back({{"parameter", NameOf(influence.base)},
                    {"standard_deviation", influence.standard_deviation},
                    {"settling_time",
                     {{"variance_share", influence.settling_effect},
                      {"rank_correlation", influence.settling_correlation}}},
                    {"overshoot",
                     {{"variance_share", influence.overshoot_effect},
                      {"rank_correlation", influence.overshoot_correlation}}}});
  }
  return rows;
}

json Numbers(const UncertainSteps& steps, const UncertainSpread& spread) {
  return {{"machines", steps.drawn.size()},
          {"step_rad", steps.trial.step},
          {"watched_s", steps.trial.duration},
          {"settling_time_s", AsJson(spread.settling)},
          {"shortest_settling_time_s", AsJson(spread.shortest)},
          {"settling_to_shortest", AsJson(spread.ratio)},
          {"overshoot_percent", AsJson(spread.overshoot)},
          {"largest_error_rad", AsJson(spread.error)},
          {"saturated_time_s", AsJson(spread.saturated)},
          {"never_settles", AsJson(spread.never)},
          {"friction_can_hold_outside_2_percent", spread.friction_holds},
          {"overshoots_by_more_than_5_percent", AsJson(spread.overshoots)},
          {"influences", InfluencesJson(spread)},
          {"nearly_as_table_1",
           {{"parameter", NameOf(spread.nearly.base)},
            {"within", spread.nearly.within},
            {"machines", spread.nearly.count},
            {"settling_time_p50_s", spread.nearly.settling_p50},
            {"settling_time_p95_s", spread.nearly.settling_p95},
            {"overshoot_p95_percent", spread.nearly.overshoot_p95}}},
          {"slowest", MachinesJson(steps, spread.slowest)},
          {"most_overshoot", MachinesJson(steps, spread.most_overshoot)}};
}

std::string Explanation(const UncertainSpread& spread) {
  const Influence& first = spread.influences.front();
  const Nearly& nearly = spread.nearly;
  return fmt::format(
      "Gains that bring Table 1 to its target in {:.3f} s, {:.2f} times the shortest possible, take more "
      "than {:.3f} s "
      "on half of the machines that Table 1's uncertainty allows, and more than {:.3f} s on one in twenty; "
      "{:.0f} % of "
      "them overshoot by more than {:g} %. The motors are not to blame: for nine machines in ten the "
      "shortest possible "
      "time lies between {:.3f} and {:.3f} s. {} alone explains {:.0f} % of the variance of the settling "
      "time and {:.0f} "
      "% of that of the overshoot. The law takes Table 1's (c/D) α' out of the k_v term: too much where D is "
      "larger, so "
      "that the arm is driven on and overshoots, and too little where D is smaller, so that it creeps in; "
      "both cost "
      "time. Of the machines whose {} is within {:g} % of Table 1's, half settle within {:.3f} s and 95 % "
      "within "
      "{:.3f} s. Those that never settle are held by friction, which can keep the arm outside 2 % of the "
      "step where "
      "T_s/k_1 is large: on {:.2g} % of all machines by the closed form; {:.2g} % did not settle.",
      spread.settling.known, spread.ratio.known, spread.settling.p50, spread.settling.p95,
      100 * spread.overshoots.value, kMuchOvershoot, spread.shortest.p5, spread.shortest.p95,
      NameOf(first.base), 100 * first.settling_effect, 100 * first.overshoot_effect, NameOf(nearly.base),
      100 * nearly.within, nearly.settling_p50, nearly.settling_p95, 100 * spread.friction_holds,
      100 * spread.never.value);
}

Comparison Row(const std::string& quantity, const std::string& unit, double expected, double here,
               const std::string& remark) {
  return {quantity, unit, "", expected, here, remark};
}

std::string PercentilesText(const Spread& spread) {
  return fmt::format("5, 95, 99 % of the machines: {:.3g}, {:.3g}, {:.3g}", spread.p5, spread.p95,
                     spread.p99);
}

std::string IntervalText(const maths::Estimate& share) {
  return fmt::format("95 % interval {:.2g} to {:.2g} %", 100 * share.low, 100 * share.high);
}

std::vector<Comparison> Comparisons(const UncertainSpread& spread, const ArmRun& stack) {
  const double none = page::kAutomatic;
  return {
      Row("settling time (2 %), Table 1 itself", "s", stack.response.settling_time_s.value_or(none),
          spread.settling.known, "expected: the stack with its messages"),
      Row("overshoot, Table 1 itself", "%", stack.response.overshoot_percent, spread.overshoot.known,
          "expected: the stack with its messages"),
      Row("settling time, median machine", "s", none, spread.settling.p50, PercentilesText(spread.settling)),
      Row("shortest possible settling time, median machine", "s", spread.shortest.known, spread.shortest.p50,
          "expected: Table 1's. " + PercentilesText(spread.shortest)),
      Row("settling time over the shortest, median machine", "", none, spread.ratio.p50,
          PercentilesText(spread.ratio)),
      Row("overshoot, median machine", "%", none, spread.overshoot.p50, PercentilesText(spread.overshoot)),
      Row("machines that overshoot by more than 5 %", "%", none, 100 * spread.overshoots.value,
          IntervalText(spread.overshoots)),
      Row("machines that never settle", "%", 100 * spread.friction_holds, 100 * spread.never.value,
          "expected: at most, where friction can hold the arm outside 2 %. " + IntervalText(spread.never)),
  };
}

std::vector<tables::Column> Columns(const UncertainSteps& steps) {
  std::vector<tables::Column> columns;
  const auto add = [&](const std::string& name, const auto& quantity) {
    tables::Column& column = columns.emplace_back(tables::Column{name, {}});
    for (const UncertainStep& step : steps.drawn) column.values.push_back(quantity(step));
  };
  add("machine", [&](const auto& step) { return static_cast<double>(&step - steps.drawn.data()); });
  add("settling_time_s", [](const auto& step) { return step.settling; });
  add("shortest_settling_time_s", [](const auto& step) { return step.shortest; });
  add("overshoot_percent", [](const auto& step) { return step.overshoot_percent; });
  add("steady_state_error_rad", [](const auto& step) { return step.final_error; });
  add("saturated_time_s", [](const auto& step) { return step.saturated; });
  add("highest_pressure_psi", [](const auto& step) { return step.highest_pressure; });
  add("highest_motor_speed_rad_s", [](const auto& step) { return step.highest_speed; });
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    add(parameter.info.name, [&](const auto& step) { return step.parameters.*parameter.member; });
  }
  return columns;
}

std::string Conditions(const UncertainSteps& steps) {
  std::string known;
  for (size_t base = 0; base < model::BaseParameters().size(); ++base) {
    if (steps.trial.model.parameters.*model::BaseParameters()[base].member == 0) continue;
    known += fmt::format("{}{} {:g} %", known.empty() ? "" : ", ", NameOf(base),
                         100 * model::UncertaintyOf(steps.trial.model, base));
  }
  return fmt::format(
      "{} machines drawn from Table 1 (seed {}), each parameter log-normal about its value: {}. The loop of "
      "config/retuned.toml at 5 kHz with a command delay of one tick, its gains, feed-forwards and limits "
      "those for "
      "Table 1, on the full model without messages; step of {:g} rad, watched for {:g} s.",
      steps.drawn.size(), steps.seed, known, steps.trial.step, steps.trial.duration);
}

}  // namespace

ExperimentResult RunFig10Uncertainty(const ExperimentOptions& options) {
  const ArmRun stack =
      RunArm(options.run_stack, "fig10_uncertainty",
             ShippedStackText("retuned", {fmt::format("reference.steps=[[0.1, {}]]", kFigure10Step),
                                          fmt::format("time.duration_s={}", 0.1 + kWatched)}),
             ShippedModel("table1"), kFigure10Step);
  const UncertainSteps steps = StepDrawnModels(RetunedTrial(kFigure10Step, kWatched), options.machines,
                                               static_cast<uint64_t>(options.seed), options.jobs,
                                               [&](double done) { options.progress(kRecordedShare * done); });
  const UncertainSpread spread = SpreadOf(steps);
  ExperimentResult result;
  result.conditions = Conditions(steps);
  result.paper_says =
      "Figure 10 shows the step of one machine. Table 1 gives its values without saying how well they are "
      "known.";
  result.explanation = Explanation(spread);
  result.comparisons = Comparisons(spread, stack);
  result.numbers = JsonText(Numbers(steps, spread));
  result.table.columns = Columns(steps);
  result.pictures = UncertaintyPictures(steps, spread);
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
