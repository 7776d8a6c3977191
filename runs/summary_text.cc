#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/integers.h"
#include "base/json_text.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "base/units.h"
#include "bus/output_left.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/tuning_history.h"
#include "runs/timing/timing_report.h"
#include "runs/tracking.h"

namespace hydro::runs {
namespace {

using Json = nlohmann::ordered_json;

// The number of ticks from the first state to the last.
int64_t TicksPassed(const LogInfo& info) { return SaturatingDifference(info.ticks.last, info.ticks.first); }

// How values of the arm are shown: an angle in rad, and with `si` also in degrees; a linear arm's position in
// its model's unit of length, or with `si` in m.
class ArmText {
 public:
  ArmText(const UnitSystem& units, bool si) : units_(units), si_(si), unit_(units.UnitFor("rad", 1)) {
    const std::optional<SiUnit> shown = si && units.linear_arm ? FindSiUnit(unit_, 1) : std::nullopt;
    if (!shown) return;
    unit_ = shown->to;
    factor_ = shown->factor;
  }

  std::string Place(double value) const {
    const std::string text = Number(value, 4);
    return si_ && !units_.linear_arm ? fmt::format("{} ({:.2f} deg)", text, Degrees(value)) : text;
  }
  std::string Error(double value) const { return Number(value, 5); }
  std::string Size(double value) const { return Number(value, 4); }

 private:
  // Writes an angle with that many decimals. A length may be in um or ft, so it is written in a short form.
  std::string Number(double value, int decimals) const {
    return units_.linear_arm ? ShortNumber(factor_ * value, decimals) + " " + unit_
                             : fmt::format("{:.{}f} {}", value, decimals, unit_);
  }

  UnitSystem units_;
  bool si_;
  std::string unit_;
  double factor_ = 1;
};

// "; mean of the last 0.1 s": what a final error is.
std::string MeanText(const Tracking& tracking) {
  return "mean of the last " + ShortNumber(tracking.final_time_s, 2) + " s";
}

// How close to its reference a step brought the arm, and when.
std::string SettlingText(const StepResponse& step, const ArmText& arm) {
  const double part = step.tolerance_rad / std::fabs(step.to_rad - step.from_rad);
  const bool usual = part < 1.001 * kSettlingBand;  // a small step has the least tolerance
  const std::string band = usual ? fmt::format("{:g} %", 100 * kSettlingBand) : arm.Size(step.tolerance_rad);
  return step.settling_time_s ? fmt::format("within {} after {:.2f} s", band, *step.settling_time_s)
                              : "not within " + band;
}

// The stop that ended the run early: one that failed it, or else one before its full duration.
const stop_t* EarlyEnd(const LogInfo& info) {
  const stop_t* first = nullptr;
  for (const stop_t& stop : info.stops) {
    if (stop.exit_code != 0) return &stop;
    if (bus::IsCompletion(stop)) return nullptr;
    if (first == nullptr) first = &stop;
  }
  return first;
}

std::string TrackingText(const Tracking& tracking, const LogInfo& info, bool si) {
  const ArmText arm(tracking.units, si);
  const bool early = EarlyEnd(info) != nullptr;
  std::string text = log::EndIsOpen(info.verdict) ? "where this log ends (the run may go on): "
                     : early                      ? "when it ended: "
                                                  : "";
  const std::string rms = ", rms error over the run " + arm.Size(tracking.rms_error_rad) + "\n";
  if (tracking.held) {
    return text +
           "the voltage is held at zero, and the reference follows the arm: it says nothing of a target" +
           rms;
  }
  if (!tracking.at_target) {
    return text +
           (early ? "the reference moves: error " : "the reference still moves at the end: error there ") +
           arm.Error(tracking.final_error_rad) + " (" + MeanText(tracking) + ")" + rms;
  }
  return text +
         fmt::format("arm {} its target {}: {} {} ({}; up to {} is at it)",
                     *tracking.at_target ? "at" : "NOT at", arm.Place(tracking.target_rad),
                     early ? "error" : "final error", arm.Error(tracking.final_error_rad), MeanText(tracking),
                     arm.Size(tracking.tolerance_rad)) +
         rms;
}

}  // namespace

std::string EarlyEndText(const LogInfo& info) {
  const stop_t* const end = EarlyEnd(info);
  if (end == nullptr) return {};
  // hydro-launch does not hear states, so it does not know the tick.
  const std::string when = end->tick >= 0          ? fmt::format(" at tick {}", end->tick)
                           : info.ticks.states > 0 ? fmt::format(" after tick {}", info.ticks.last)
                                                   : "";
  return fmt::format("the run {}{}: {}: {}\n", end->exit_code != 0 ? "FAILED" : "was stopped", when,
                     Printable(end->source), Printable(end->reason));
}

std::string FaultText(const fault_t& fault) {
  return fmt::format("fault {}: {} {} ({})",
                     fault.tick >= 0 ? fmt::format("at tick {}", fault.tick) : "before the first tick",
                     Printable(fault.code), fault.active ? "began" : "ended", Printable(fault.source));
}

std::string LoopsText(const LogInfo& info) {
  const auto ran = [](const LoopInfo& loop) {  // simulated time has no loops to report on
    return loop.cycles > 0 || loop.missed_deadlines > 0 || loop.lost_messages > 0;
  };
  if (std::none_of(info.loops.begin(), info.loops.end(), ran)) return {};
  std::string text =
      fmt::format("{:<14} {:>8} {:>10} {:>10} {:>10} {:>10} {:>10} {:>7} {:>6}\n", "loop", "cycles",
                  "period p50", "period p99", "late p50", "late p99", "late max", "missed", "lost");
  for (const LoopInfo& loop : info.loops) {
    if (!ran(loop)) continue;
    text +=
        fmt::format("{:<14} {:>8} {:>7.0f} us {:>7.0f} us {:>7.0f} us {:>7.0f} us {:>7.0f} us {:>7} {:>6}\n",
                    Printable(loop.last.role), loop.cycles, loop.last.period_p50_us, loop.last.period_p99_us,
                    loop.last.latency_p50_us, loop.last.latency_p99_us, loop.last.latency_max_us,
                    loop.missed_deadlines, loop.lost_messages);
  }
  return text;
}

std::string SummaryText(const Tracking& tracking, const LogInfo& info, bool si) {
  std::string text = EarlyEndText(info);
  const auto line = [&](fmt::string_view format, const auto&... arguments) {
    text += fmt::vformat(format, fmt::make_format_args(arguments...)) + "\n";
  };
  line(
      "{} states over {:.3f} s of plant time, {} ticks skipped (late wake-ups), {} messages missing from the "
      "log",
      info.ticks.states, info.ticks.last_time_s - info.ticks.first_time_s, info.ticks.announced,
      MissingMessages(info));
  // An imported table numbers its rows anew, so its gaps are neither skipped ticks nor missing messages.
  if (info.ticks.missing > SaturatingSum(info.ticks.announced, MissingMessages(info)))
    line("{} ticks have no state in the log, from the first to the last", info.ticks.missing);
  const std::string advice = timing::SkippedTicksAdvice(info.ticks.announced, TicksPassed(info), "CONFIG");
  if (!advice.empty()) line("{}", advice);
  if (info.ticks.sampled > 1) line("the log has {}, not each", DescribeSampling(info.ticks.sampled));
  const std::string caution = log::Caution(info.verdict);
  if (!caution.empty()) line("log: {}", caution);
  if (tracking.has_reference) {
    const ArmText arm(tracking.units, si);
    // A run that ended at its first tick followed no reference.
    if (info.ticks.states > 1 || EarlyEnd(info) == nullptr) text += TrackingText(tracking, info, si);
    for (const StepResponse& step : tracking.steps) {
      line("  step at {:5.2f} s to {}: overshoot {:4.1f} %, {}, error at the end {}", step.time_s,
           arm.Place(step.to_rad), step.overshoot_percent, SettlingText(step, arm),
           arm.Error(step.final_error_rad));
    }
    if (tracking.steps_left_out > 0) {
      line(
          "  {} left out: the reference moved on before it rested (a hold and its way back, a ramp or a "
          "curve)",
          tracking.steps_left_out == 1 ? "1 step is" : fmt::format("{} steps are", tracking.steps_left_out));
    }
  }
  text += LoopsText(info);
  AppendListed(info.faults, FaultText, &text);
  for (const TuningStep& tuning : info.tunings) line("tuned: {}", Printable(DescribeTuning(tuning)));
  for (const output_left_t& left : info.outputs_left) line("{}", Printable(bus::OutputLeftText(left)));
  return text;
}

std::string SummaryJson(const Tracking& tracking, const LogInfo& info) {
  Json json = {
      {"states", info.ticks.states},
      {"ticks", TicksPassed(info)},
      {"duration_s", info.ticks.last_time_s - info.ticks.first_time_s},
      {"skipped_ticks", info.ticks.announced},
      {"ticks_without_state", info.ticks.missing},
      {"ticks_to_next_state", info.ticks.sampled},
      {"missing_messages", MissingMessages(info)},
      {"log", {{"verdict", NameOf(info.verdict.completeness)}, {"caution", log::Caution(info.verdict)}}}};
  if (const stop_t* const end = EarlyEnd(info)) {
    json["ended_early"] = {{"tick", end->tick >= 0 ? Json(end->tick) : Json(nullptr)},
                           {"source", end->source},
                           {"reason", end->reason},
                           {"failed", end->exit_code != 0}};
  }
  if (tracking.has_reference) {
    // "_rad", or "_mm" for a linear arm
    const std::string unit = "_" + UnitInName(tracking.units.UnitFor("rad", 1));
    Json steps = Json::array();
    for (const StepResponse& step : tracking.steps) {
      steps.push_back(
          {{"time_s", step.time_s},
           {"from" + unit, step.from_rad},
           {"to" + unit, step.to_rad},
           {"overshoot_percent", step.overshoot_percent},
           {"tolerance" + unit, step.tolerance_rad},
           {"settling_time_s", step.settling_time_s ? Json(*step.settling_time_s) : Json(nullptr)},
           {"final_error" + unit, step.final_error_rad}});
    }
    json["tracking"] = {{"at_target", tracking.at_target ? Json(*tracking.at_target) : Json(nullptr)},
                        {"target" + unit, tracking.target_rad},
                        {"tolerance" + unit, tracking.tolerance_rad},
                        {"final_error" + unit, tracking.final_error_rad},
                        {"final_time_s", tracking.final_time_s},
                        {"rms_error" + unit, tracking.rms_error_rad},
                        {"steps", steps}};
  }
  json["loops"] = Json::parse(InfoJson(info)).value("loops", Json::array());
  Json faults = Json::array();
  for (const fault_t& fault : info.faults) {
    faults.push_back({{"tick", fault.tick},
                      {"source", fault.source},
                      {"code", fault.code},
                      {"active", bool(fault.active)},
                      {"text", fault.text}});
  }
  json["faults"] = faults;
  Json tunings = Json::array();
  for (const TuningStep& tuning : info.tunings) {
    tunings.push_back({{"version", tuning.version},
                       {"tick", tuning.tick},
                       {"changes", tuning.changes},
                       {"source", tuning.source}});
  }
  json["tunings"] = tunings;
  return JsonText(json, 2) + "\n";
}

}  // namespace hydro::runs
