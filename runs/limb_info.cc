#include "runs/limb_info.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/integers.h"
#include "base/json_text.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "bus/output_left.h"
#include "runs/recorded/run_config.h"

namespace hydro::runs {
namespace {

// Joins the two in the same form as the launcher.
std::string Named(const std::string& joint, const std::string& source) { return joint + " " + source; }

// Whatever happened to a joint also happened to its limb.
void AddEvents(const JointInfo& joint, LogInfo* limb) {
  for (fault_t fault : joint.info.faults) {
    fault.source = Named(joint.name, fault.source);
    limb->faults.push_back(std::move(fault));
  }
  for (stop_t stop : joint.info.stops) {
    stop.source = Named(joint.name, stop.source);
    limb->stops.push_back(std::move(stop));
  }
  for (TuningStep tuning : joint.info.tunings) {
    tuning.source = Named(joint.name, tuning.source);
    limb->tunings.push_back(std::move(tuning));
  }
  for (output_left_t left : joint.info.outputs_left) {
    left.role = Named(joint.name, left.role);
    limb->outputs_left.push_back(std::move(left));
  }
}

using Json = nlohmann::ordered_json;

// The codes of the joint's faults, each once.
std::string Faults(const JointInfo& joint) {
  std::string codes;
  std::set<std::string> seen;
  for (const fault_t& fault : joint.info.faults) {
    if (seen.insert(fault.code).second) codes += (codes.empty() ? "" : ", ") + Printable(fault.code);
  }
  return codes.empty() ? "none" : codes;
}

std::string Target(const Tracking& tracking) {
  if (!tracking.has_reference) return "none";
  if (!tracking.at_target) return "moves";
  return *tracking.at_target ? "reached" : "NOT reached";
}

// Writes a value with its unit. Joints may turn or move along a line.
std::string WithUnit(const Tracking& tracking, double value, int decimals) {
  const std::string unit = " " + tracking.units.UnitFor("rad", 1);
  return (tracking.units.linear_arm ? ShortNumber(value, decimals)
                                    : fmt::format("{:.{}f}", value, decimals)) +
         unit;
}

std::string RowsOf(const LimbInfo& info) {
  size_t width = 16;
  for (const JointInfo& joint : info.joints) width = std::max(width, joint.name.size());
  std::string text =
      fmt::format("{:<{}} {:>9} {:>6} {:>9} {:>7} {:>8} {:>15} {:>13} {:<11} {}\n", "joint", width, "states",
                  "every", "time s", "missing", "skipped", "final error", "rms error", "target", "faults");
  for (const JointInfo& joint : info.joints) {
    const TickInfo& ticks = joint.info.ticks;
    const bool has = joint.tracking.has_reference;
    text += fmt::format("{:<{}} {:>9} {:>6} {:>9.3f} {:>7} {:>8} {:>15} {:>13} {:<11} {}\n",
                        Printable(joint.name), width, ticks.states, ticks.sampled,
                        ticks.last_time_s - ticks.first_time_s, MissingMessages(joint.info), ticks.announced,
                        has ? WithUnit(joint.tracking, joint.tracking.final_error_rad, 5) : "-",
                        has ? WithUnit(joint.tracking, joint.tracking.rms_error_rad, 4) : "-",
                        Target(joint.tracking), Faults(joint));
  }
  const auto sampled = std::find_if(info.joints.begin(), info.joints.end(),
                                    [](const JointInfo& joint) { return joint.info.ticks.sampled > 1; });
  if (sampled != info.joints.end()) {
    text += "the log has " + DescribeSampling(sampled->info.ticks.sampled) + ", not each\n";
  }
  return text;
}

// The joints whose rows stay empty because a mean over several runs would describe none of them.
std::string SeveralRunsOf(const LimbInfo& info) {
  std::string text;
  for (const JointInfo& joint : info.joints) {
    if (joint.info.several_runs)
      text += "joint " + Printable(joint.name) + " has states of several runs: --joint shows each\n";
  }
  return text;
}

// "2 joints: --joint NAME (hip, knee) for one alone"
std::string HintOf(const LimbInfo& info) {
  return fmt::format("a limb with {} joints; --joint {} and so on for one alone\n", info.joints.size(),
                     Printable(info.joints.front().name));
}

Json TrackingOf(const JointInfo& joint) { return Json::parse(SummaryJson(joint.tracking, joint.info)); }

std::string Dump(const Json& json) { return JsonText(json, 2) + "\n"; }

}  // namespace

LimbInfo SummariseLimb(const LimbLog& log, bool si) {
  LimbInfo all;
  all.limb = Summarise(log.limb, si);
  std::unordered_map<std::string_view, int> named;
  for (const RunLog& joint : log.joints) ++named[joint.joint];
  for (const RunLog& joint : log.joints) {
    // Where another limb has a joint of the same name, the channels' suffix tells the two apart.
    const std::string& name = named[joint.joint] == 1 ? joint.joint : joint.suffix;
    LogInfo info = Summarise(joint, si);
    // A mean over several runs would describe none of them.
    Tracking tracking = info.several_runs ? Tracking{} : TrackArm(joint);
    all.joints.push_back({name, std::move(info), std::move(tracking)});
    AddEvents(all.joints.back(), &all.limb);
  }
  const auto by_tick = [](const auto& a, const auto& b) { return a.tick < b.tick; };
  std::stable_sort(all.limb.faults.begin(), all.limb.faults.end(), by_tick);
  // Each joint has its own rows. The channels of a limb with many joints would fill the screen.
  std::unordered_set<std::string_view> of_joints;
  for (const JointInfo& joint : all.joints) {
    for (const ChannelInfo& channel : joint.info.channels) of_joints.insert(channel.summary.channel);
  }
  std::erase_if(all.limb.channels,
                [&](const ChannelInfo& channel) { return of_joints.contains(channel.summary.channel); });
  return all;
}

std::string LimbInfoText(const LimbInfo& info) {
  return InfoText(info.limb) + HintOf(info) + RowsOf(info) + SeveralRunsOf(info);
}

std::string LimbSummaryText(const LimbInfo& info) {
  std::string text = EarlyEndText(info.limb) + HintOf(info) + RowsOf(info);
  const std::string caution = log::Caution(info.limb.verdict);
  if (!caution.empty()) text += "log: " + caution + "\n";
  text += LoopsText(info.limb);
  AppendListed(info.limb.faults, FaultText, &text);
  AppendListed(
      info.limb.tunings,
      [](const TuningStep& tuning) { return "tuned: " + Printable(DescribeTuning(tuning)); }, &text);
  AppendListed(
      info.limb.outputs_left, [](const output_left_t& left) { return Printable(bus::OutputLeftText(left)); },
      &text);
  return text;
}

std::string LimbInfoJson(const LimbInfo& info) {
  Json json = Json::parse(InfoJson(info.limb));
  json["joints"] = Json::object();
  for (const JointInfo& joint : info.joints) {
    Json one = Json::parse(InfoJson(joint.info));
    const Json summary = TrackingOf(joint);
    if (summary.contains("tracking")) one["tracking"] = summary["tracking"];
    json["joints"][joint.name] = std::move(one);
  }
  return Dump(json);
}

std::string LimbSummaryJson(const LimbInfo& info) {
  Json json = {
      {"log",
       {{"verdict", NameOf(info.limb.verdict.completeness)}, {"caution", log::Caution(info.limb.verdict)}}},
      {"joints", Json::object()}};
  for (const JointInfo& joint : info.joints) {
    Json one = TrackingOf(joint);
    one.erase("log");
    json["joints"][joint.name] = std::move(one);
  }
  const Json limb = Json::parse(InfoJson(info.limb));
  json["loops"] = limb["loops"];
  json["faults"] = limb["faults"];
  return Dump(json);
}

}  // namespace hydro::runs
