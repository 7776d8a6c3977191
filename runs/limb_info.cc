#include "runs/limb_info.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

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

}  // namespace hydro::runs
