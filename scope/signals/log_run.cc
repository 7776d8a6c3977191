#include "scope/signals/log_run.h"

#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "bus/channels.h"
#include "runs/log/log_reader.h"
#include "runs/recorded/channel_suffix.h"
#include "scope/signals/run_builder.h"

namespace hydro::scope {
namespace {

// Reads the names of the channels that the log holds, and the configurations by which its limbs describe
// themselves.
runs::RunLog ChannelsOf(log::LogReader& reader, const std::string& file, runs::LimbConfigs* configs) {
  std::map<std::string, int64_t, std::less<>> events;
  log::LogEvent event;
  while (reader.Next(event)) {
    if (const auto known = events.find(event.channel); known != events.end()) {
      ++known->second;
      continue;
    }
    events[std::string(event.channel)] = 1;
    configs->TakeFirst(event);
  }
  reader.Rewind();
  runs::RunLog names;
  names.file = file;
  for (const auto& [channel, count] : events) {
    runs::ChannelSummary summary;
    summary.channel = channel;
    summary.events = count;
    names.channels.push_back(summary);
  }
  return names;
}

// Sorts a stack's messages into its runs.
class StackOfLog {
 public:
  StackOfLog(std::string file, std::string name, std::string suffix)
      : file_(std::move(file)), name_(std::move(name)), suffix_(std::move(suffix)), channels_(suffix_) {}

  const bus::Channels& channels() const { return channels_; }
  RunBuilder& run_builder() { return run_builder_; }
  std::vector<std::unique_ptr<Run>>& runs() { return runs_; }

 private:
  Run* NextRun() {
    const std::string name = runs_.empty() ? name_ : name_ + " (" + std::to_string(runs_.size() + 1) + ")";
    runs_.push_back(std::make_unique<Run>(0, name, Run::Kind::kLog, std::numeric_limits<uint64_t>::max()));
    runs_.back()->log_file = file_;
    runs_.back()->suffix = suffix_;
    return runs_.back().get();
  }

  const std::string file_;
  const std::string name_;
  const std::string suffix_;
  const bus::Channels channels_;
  std::vector<std::unique_ptr<Run>> runs_;
  RunBuilder run_builder_{suffix_, [this](int64_t) { return NextRun(); }};
};

// All joints of a limb, or the one stack that was chosen, and the suffix of the limb's own channels.
std::vector<std::unique_ptr<StackOfLog>> StacksOf(const runs::RunLog& channels,
                                                  const runs::LimbConfigs& configs, const std::string& name,
                                                  const runs::StackChoice& choice, std::string* limb) {
  std::vector<std::unique_ptr<StackOfLog>> stacks;
  std::vector<runs::JointChannels> joints = runs::JointsIn(channels);
  configs.Order(&joints);
  const bool all = runs::IsWholeLimb(channels, choice);
  const std::string chosen = all ? "" : runs::ChooseSuffix(channels, choice);
  for (const runs::JointChannels& joint : joints) {
    if (!all && joint.suffix != chosen) continue;
    *limb = joint.limb;
    stacks.push_back(std::make_unique<StackOfLog>(channels.file, joint.name + " of " + name, joint.suffix));
  }
  if (stacks.empty()) stacks.push_back(std::make_unique<StackOfLog>(channels.file, name, chosen));
  return stacks;
}

}  // namespace

std::vector<std::unique_ptr<Run>> OpenLogRuns(const std::string& file, const std::string& name,
                                              std::string* problem, const runs::StackChoice& choice) {
  log::LogReader reader(file, log::OnDamage::kStop);
  std::string limb;
  runs::LimbConfigs configs;
  const runs::RunLog channels = ChannelsOf(reader, file, &configs);
  const auto stacks = StacksOf(channels, configs, name, choice, &limb);
  std::unordered_map<std::string_view, StackOfLog*> by_channel;
  for (const auto& stack : stacks) {
    for (const std::string& channel : stack->channels().names()) by_channel.emplace(channel, stack.get());
  }
  const bus::Channels of_limb(limb);
  const std::set<std::string, std::less<>> limb_names(of_limb.names().begin(), of_limb.names().end());
  log::LogEvent event;
  while (reader.Next(event)) {
    const auto stack = by_channel.find(event.channel);
    if (stack != by_channel.end()) {
      stack->second->run_builder().Take(event.channel, event.data, event.size, event.utime);
      continue;
    }
    if (!limb_names.contains(event.channel)) continue;
    for (const auto& one : stacks)
      one->run_builder().TakeOfLimb(of_limb, event.channel, event.data, event.size, event.utime);
  }
  std::vector<std::unique_ptr<Run>> runs;
  for (const auto& stack : stacks) {
    stack->run_builder().Flush();
    std::move(stack->runs().begin(), stack->runs().end(), std::back_inserter(runs));
  }
  if (runs.empty()) {
    throw InputError(file + ": found no states of a stack, allowed is a log with HYDRO_STATE messages");
  }
  *problem = log::Caution(reader.verdict());
  return runs;
}

}  // namespace hydro::scope
