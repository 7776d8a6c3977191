#include "scope/signals/log_run.h"

#include <map>
#include <string_view>

#include "log/log_reader.h"
#include "runs/channel_suffix.h"
#include "scope/signals/intake.h"

namespace hydro::scope {
namespace {

// The suffix of the stack that the log holds.
std::string SuffixOf(log::LogReader& reader, const std::string& file) {
  std::map<std::string, int64_t, std::less<>> events;
  log::LogEvent event;
  while (reader.Next(event)) {
    const auto known = events.find(event.channel);
    known != events.end() ? ++known->second : events[std::string(event.channel)] = 1;
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
  return runs::ChooseSuffix(names, {});
}

}  // namespace

std::vector<std::unique_ptr<Run>> OpenLogRuns(const std::string& file, const std::string& name,
                                              std::string* problem) {
  log::LogReader reader(file, log::OnDamage::kStop);
  const std::string suffix = SuffixOf(reader, file);
  std::vector<std::unique_ptr<Run>> runs;
  Intake intake(suffix, [&](int64_t) {
    const std::string its_name = runs.empty() ? name : name + " (" + std::to_string(runs.size() + 1) + ")";
    runs.push_back(std::make_unique<Run>(0, its_name, Run::Kind::kLog, std::numeric_limits<uint64_t>::max()));
    runs.back()->log_file = file;
    runs.back()->suffix = suffix;
    return runs.back().get();
  });
  log::LogEvent event;
  while (reader.Next(event)) intake.Take(event.channel, event.data, event.size, event.utime);
  intake.Flush();
  if (runs.empty()) {
    throw InputError(file + ": found no states of a stack, allowed is a log with HYDRO_STATE messages");
  }
  *problem = log::Caution(reader.verdict());
  return runs;
}

}  // namespace hydro::scope
