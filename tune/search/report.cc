#include "tune/search/report.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <map>

#include "base/number_text.h"
#include "base/units.h"
#include "base/word_list.h"
#include "tune/design/configured_laws.h"
#include "tune/design/operating_cases.h"
#include "tune/search/unsettled.h"

namespace hydro::tune {
namespace {

constexpr double kGainMargins[] = {2, 2.5, 3, 4, 6, 10};

std::string NumberText(double value) { return ShortNumber(value, 3); }

// A gain with its unit in the model's units, or in SI.
std::string WithUnit(double value, const char* paper_unit, int arm, const UnitSystem& units, bool si) {
  const std::string own = units.UnitFor(paper_unit, arm);
  if (si) {
    if (const auto shown = FindSiUnit(own, value)) {
      return ShortNumber(value * shown->factor, 5) + " " + shown->to;
    }
  }
  return ShortNumber(value, 5) + " " + own;
}

std::string GainsText(const StepJudge& judge, const Gains& gains, bool si) {
  const UnitSystem& units = judge.config().model.description.units;
  std::string text =
      fmt::format("pressure loop {} rad/s, damping {}; c1 = {}, c2 = {}", NumberText(gains.natural_frequency),
                  NumberText(gains.damping_ratio), WithUnit(gains.c1, "psi/rad", -1, units, si),
                  WithUnit(gains.c2, "psi s/rad", -1, units, si));
  if (std::isfinite(gains.deceleration)) {
    text += fmt::format("; braking with {} {}", NumberText(gains.deceleration), units.UnitFor("rad/s^2", 1));
  }
  return text;
}

std::string MarginRow(const char* loop, const design::CheckedLoop& checked) {
  const design::LoopMargins& m = checked.worst;
  if (!m.stable) return fmt::format("  {:<10} UNSTABLE: {}\n", loop, checked.worst_case);
  return fmt::format("  {:<10} {:>6} {:>9} {:>7.0f} {:>9} {:>8} {:>7}  {}\n", loop, NumberText(m.gain),
                     NumberText(m.gain_hz), m.phase_deg, NumberText(1e3 * m.delay),
                     m.bandwidth_hz > 0 ? NumberText(m.bandwidth_hz) : "-", NumberText(m.damping_ratio),
                     checked.worst_case);
}

std::string MarginsText(const Proposal& proposal) {
  const design::LoopCheck& check = proposal.tried.check;
  if (!check.unjudged.empty()) return "  " + check.unjudged + "\n";
  std::string text = fmt::format("  {:<10} {:>6} {:>9} {:>7} {:>9} {:>8} {:>7}  {}\n", "loop", "gain",
                                 "at Hz", "deg", "delay ms", "band Hz", "damping", "worst where");
  if (check.pressure) text += MarginRow("pressure", *check.pressure);
  if (check.position) text += MarginRow("position", *check.position);
  const design::LoopCheck& uncertain = proposal.uncertain;
  if (uncertain.pressure && uncertain.position) {
    text += fmt::format(
        "  over the model's uncertainty: gain margins down to {} (pressure) and {} (position){}\n",
        NumberText(uncertain.pressure->worst.gain), NumberText(uncertain.position->worst.gain),
        uncertain.pressure->worst.stable && uncertain.position->worst.stable ? "" : ", UNSTABLE");
  }
  if (uncertain.unknown) text += "  over part of the model's uncertainty " + uncertain.unjudged + "\n";
  return text;
}

std::string RatioText(double ratio) {
  if (ratio >= kStopped) return "stops";  // a limit ended the run
  return ratio >= kNeverSettled ? ">" + NumberText(kNeverSettled) : fmt::format("{:.2f}", ratio);
}

// Below a table with ">2.5" or "stops": a line for each limit that is behind them.
std::string UnsettledText(const TuningReport& report) {
  const std::string unit = report.judge->config().model.description.units.UnitFor("rad", 1);
  std::string text;
  for (const Proposal& proposal : report.proposals) {
    std::map<std::string, std::vector<std::string>> steps;  // by why they do not settle
    const auto add = [&](const StepCase& step, const std::string& name) {
      const std::string why = WhyUnsettled(*report.judge, proposal.tried.gains, step);
      if (!why.empty()) steps[why].push_back(name);
    };
    const auto never = [](double ratio) { return ratio >= kNeverSettled; };
    for (size_t i = 0; i < proposal.steps.size(); ++i) {
      const double step = report.judge->steps()[i];
      if (never(proposal.steps[i].ratio)) add(report.judge->Nominal(step), NumberText(step) + " " + unit);
    }
    const StepVerdict& verdict = proposal.tried.steps;
    if (never(verdict.ratio)) add(verdict.slowest, "over the travel");
    if (never(verdict.uncertain_ratio)) add(verdict.uncertain_slowest, "uncertain model");
    for (const auto& [why, names] : steps)
      text += "  " + proposal.name + ", " + Joined(names) + ": " + why + "\n";
  }
  return text;
}

std::string StepsText(const TuningReport& report) {
  const UnitSystem& units = report.judge->config().model.description.units;
  std::string text = fmt::format("  {:>8} {:>9}", "step " + units.UnitFor("rad", 1), "bound s");
  for (const Proposal& proposal : report.proposals) text += fmt::format("  | {:^30}", proposal.name);
  text += fmt::format("\n  {:>8} {:>9}", "", "");
  for (size_t i = 0; i < report.proposals.size(); ++i) {
    text += fmt::format("  | {:>9} {:>6} {:>13}", "settles s", "ratio", "overshoot %");
  }
  text += "\n";
  for (size_t i = 0; i < report.judge->steps().size(); ++i) {
    const double step = report.judge->steps()[i], shortest = report.judge->Nominal(step).shortest;
    text += fmt::format("  {:>8} {:>9}", NumberText(step), NumberText(shortest));
    for (const Proposal& proposal : report.proposals) {
      const StepResult& r = proposal.steps[i];
      text += fmt::format("  | {:>9} {:>6} {:>13.1f}",
                          r.settled ? NumberText(r.settling) : ">" + NumberText(kNeverSettled * shortest),
                          RatioText(r.ratio), r.overshoot_percent);
    }
    text += "\n";
  }
  const auto row = [&](const char* what, const auto& value) {
    text += fmt::format("  {:<18}", what);
    for (const Proposal& proposal : report.proposals) {
      text += fmt::format("  | {:>16} {:>13}", RatioText(value(proposal)), "");
    }
    text += "\n";
  };
  row("over the travel", [](const Proposal& p) { return p.tried.steps.ratio; });
  row("uncertain model", [](const Proposal& p) { return p.tried.steps.uncertain_ratio; });
  return text + UnsettledText(report);
}

std::string TradeOffText(const TuningReport& report) {
  std::string text = fmt::format("  {:>11} {:>8} {:>10} {:>8} {:>10} {:>12}\n", "gain margin", "ratio",
                                 "uncertain", "band Hz", "c1", "c2");
  for (const TradeOff& row : report.trade_offs) {
    const Tried& t = row.tried;
    text += fmt::format("  {:>11} {:>8} {:>10} {:>8} {:>10} {:>12}\n", ">= " + NumberText(row.gain_margin),
                        RatioText(t.steps.ratio), RatioText(t.steps.uncertain_ratio),
                        NumberText(t.check.position->worst.bandwidth_hz), NumberText(t.gains.c1),
                        NumberText(t.gains.c2));
  }
  return text;
}

}  // namespace

std::vector<TradeOff> TradeOffs(const std::vector<Tried>& tried) {
  std::vector<TradeOff> rows;
  for (const double margin : kGainMargins) {
    const Tried* best = nullptr;
    for (const Tried& one : tried) {
      if (one.check.position->worst.gain < margin * (1 - 1e-3)) continue;
      if (best == nullptr || one.steps.score() < best->steps.score()) best = &one;
    }
    // Only lists a wider margin that costs something.
    if (best != nullptr && !rows.empty() && rows.back().tried.steps.score() == best->steps.score())
      rows.pop_back();
    if (best != nullptr) rows.push_back({margin, *best});
  }
  return rows;
}

design::LoopCheck UncertainMargins(const StepJudge& judge, const Gains& gains) {
  settings::StackConfig config = With(judge.config(), gains);
  // The gains and the arm's coordinate follow from the model as its file says, whatever the sample's values
  // are.
  const pressure_ctrl::PressureLawSettings law = design::PressureLawSettingsFor(config);
  config.limits.arm_angle_rad = design::LargestArmAngle(config);
  design::LoopCheck all;
  for (const model::ModelDescription& model : judge.models()) {
    config.model.description = model;
    const design::LoopCheck check = design::CheckLoops(config, law);
    if (check.unknown) {
      all.unknown = true;
      all.unjudged = check.unjudged;
    }
    if (!check.pressure || !check.position) continue;
    const auto add = [](const design::CheckedLoop& loop, std::optional<design::CheckedLoop>* worst) {
      if (!*worst)
        *worst = loop;
      else
        (*worst)->worst = design::WorstOf((*worst)->worst, loop.worst);
    };
    add(*check.pressure, &all.pressure);
    add(*check.position, &all.position);
  }
  return all;
}

std::string ReportText(const TuningReport& report, bool si) {
  std::string text;
  for (const Proposal& proposal : report.proposals) {
    text += fmt::format("{}: {}\n", proposal.name, GainsText(*report.judge, proposal.tried.gains, si));
    text += MarginsText(proposal) + "\n";
  }
  text += fmt::format(
      "Steps from mid-stroke{}: settling within 2 % over the shortest that torque and speed allow\n",
      report.noise ? ", with noise" : "");
  text += StepsText(report);
  text += "\nWhat a wider gain margin of the position loop costs (proposed law)\n" + TradeOffText(report);
  return text;
}

}  // namespace hydro::tune
