#include "batch/slurm/slurm_answers.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::batch {
namespace {

// s between the end of a job and the next one on the same processor, with idle slurmctld and slurmd: measured
// 0.05 to 0.1 s.
constexpr double kLaunch_s = 0.1;

std::vector<std::string> Split(const std::string& text, char between) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, between);) parts.push_back(part);
  return parts;
}

std::optional<double> SchedulerParameter(const std::string& parameters, const std::string& name) {
  for (const std::string& part : Split(parameters, ',')) {
    if (part.starts_with(name + "=")) return ParseNumber(part.substr(name.size() + 1));
  }
  return std::nullopt;
}

}  // namespace

ClusterLimits ParseLimits(const std::string& text) {
  ClusterLimits limits;
  std::map<std::string, std::string> values;
  for (const std::string& line : Split(text, '\n')) {
    const size_t equals = line.find('=');
    if (equals != std::string::npos)
      values[Trimmed(line.substr(0, equals))] = Trimmed(line.substr(equals + 1));
  }
  const auto take = [&](const std::string& name, int64_t* out) {
    const auto number = ParseInteger(values[name]);
    if (number && *number > 0) *out = *number;
  };
  take("MaxArraySize", &limits.array_jobs);
  take("MaxJobCount", &limits.all_jobs);
  // Slurm looks at most once a second.
  const double delay = SchedulerParameter(values["SchedulerParameters"], "batch_sched_delay").value_or(3);
  limits.start_s = std::max(delay, 1.0) + kLaunch_s;
  return limits;
}

int64_t ParseProcessors(const std::string& text, const std::string& partition) {
  int64_t processors = 0;
  for (const std::string& line : Split(text, '\n')) {
    const size_t bar = line.find('|');
    if (bar == std::string::npos) continue;
    const std::string name = line.substr(0, bar);
    const bool wanted =
        partition.empty() ? name.ends_with('*') : name == partition || name == partition + "*";
    const std::vector<std::string> counts = Split(Trimmed(line.substr(bar + 1)), '/');
    if (!wanted || counts.size() != 4) continue;
    processors += ParseInteger(counts[0]).value_or(0) + ParseInteger(counts[1]).value_or(0);
  }
  return processors;
}

std::optional<int64_t> ParseSubmitted(const std::string& text) {
  const std::vector<std::string> lines = Split(text, '\n');
  if (lines.empty()) return std::nullopt;
  const auto id = ParseInteger(Trimmed(lines.back().substr(0, lines.back().find(';'))));
  return id && *id > 0 ? id : std::nullopt;
}

std::vector<QueuedArray> ParseQueue(const std::string& text) {
  std::map<int64_t, QueuedArray> arrays;
  for (const std::string& line : Split(text, '\n')) {
    const std::vector<std::string> fields = Split(line, '|');
    const auto id = fields.size() == 4 ? ParseInteger(Trimmed(fields[0])) : std::nullopt;
    if (!id) continue;
    QueuedArray& array = arrays[*id];
    array.id = *id;
    array.name = fields[3];
    if (fields[1] == "PENDING") {
      ++array.pending;
      // JobArrayTaskLimit only means that a job waits for others of its array, which is the purpose of that
      // limit, so any other reason is preferred.
      array.held = array.held || fields[2] == "JobHeldUser";
      if (array.reason.empty() || array.reason == "JobArrayTaskLimit") array.reason = fields[2];
    } else {
      ++array.running;
    }
  }
  std::vector<QueuedArray> list;
  list.reserve(arrays.size());
  for (const auto& [id, array] : arrays) list.push_back(array);
  return list;
}

std::string WayOut(const std::string& refusal) {
  // sbatch's messages (slurm_errno.c), and what helps.
  constexpr std::pair<const char*, const char*> kWays[] = {
      {"QOS policy",
       "the cluster limits how many jobs a user may have, their size and their time: take fewer and longer "
       "jobs "
       "(--cases-per-job), fewer processors (--cpus-per-job), a shorter --time-limit, or another QOS "
       "(--sbatch=--qos=NAME); sacctmgr show qos lists the limits"},
      {"nvalid qos",
       "give one that you may use with --sbatch=--qos=NAME; sacctmgr show assoc user=$USER "
       "format=account,qos lists them"},
      {"nvalid partition", "give one with --partition; sinfo lists them"},
      {"nvalid account", "give one with --account; sacctmgr show assoc user=$USER lists yours"},
      {"time limit", "give a shorter one with --time-limit; sinfo lists each partition's"},
      {"job array specification", "take fewer jobs with more cases in each (--cases-per-job)"},
      {"node configuration",
       "ask for less: --cpus-per-job, --sbatch=--mem=SIZE; sinfo -N -l lists what the nodes have"}};
  for (const auto& [words, way] : kWays) {
    if (refusal.find(words) != std::string::npos) return way;
  }
  return {};
}

std::optional<double> ParseTimeLimit(const std::string& text) {
  const size_t dash = text.find('-');
  double days = 0;
  if (dash != std::string::npos) {
    const auto number = ParseInteger(text.substr(0, dash));
    if (!number) return std::nullopt;
    days = static_cast<double>(*number);
  }
  std::vector<double> parts;
  for (const std::string& part : Split(dash == std::string::npos ? text : text.substr(dash + 1), ':')) {
    const auto number = ParseInteger(part);
    if (!number || *number < 0) return std::nullopt;
    parts.push_back(static_cast<double>(*number));
  }
  if (parts.empty() || parts.size() > 3) return std::nullopt;
  // After days come hours. Without days, the first number is minutes, or hours when two others follow.
  const bool hours_first = dash != std::string::npos || parts.size() == 3;
  parts.resize(3, 0);
  if (!hours_first) parts = {0, parts[0], parts[1]};
  return ((days * 24 + parts[0]) * 60 + parts[1]) * 60 + parts[2];
}

}  // namespace hydro::batch
