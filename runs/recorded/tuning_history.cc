#include "runs/recorded/tuning_history.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/word_list.h"

namespace hydro::runs {

std::vector<tuned_settings_t> TuningHistory(const RunMessages& messages) {
  std::map<std::pair<int64_t, int64_t>, tuned_settings_t> versions;  // by session and version
  for (const tuned_settings_t& settings : messages.Of<tuned_settings_t>()) {
    const bool holds =
        settings.stage == tuned_settings_t::DECIDED || settings.stage == tuned_settings_t::IN_FORCE;
    if (holds && settings.version > 0 && settings.acts_at >= 0) {
      versions.emplace(std::pair{settings.session, settings.version}, settings);
    }
  }
  std::vector<tuned_settings_t> history;
  history.reserve(versions.size());
  for (auto& [key, settings] : versions) history.push_back(std::move(settings));
  std::stable_sort(history.begin(), history.end(),
                   [](const auto& a, const auto& b) { return a.acts_at < b.acts_at; });
  return history;
}

int64_t EffectTick(const RunMessages& messages, const tuned_settings_t& settings, const std::string& role) {
  for (const tuning_status_t& status : messages.Of<tuning_status_t>()) {
    const bool same = status.plant == settings.session && status.in_force == settings.version;
    if (same && status.role == role && status.since >= 0) return status.since;
  }
  return settings.acts_at;
}

namespace {

using Lines = std::map<std::string, std::string>;  // by key, "key = value"

Lines ByKey(const std::string& changes) {
  Lines lines;
  for (const std::string& line : TextLines(changes)) {
    lines.emplace(Trimmed(line.substr(0, line.find('='))), line);
  }
  return lines;
}

std::string AskedBy(const std::string& source) { return source.empty() ? "" : " (" + source + ")"; }

std::string OnOneLine(const std::string& changes) { return Joined(TextLines(changes)); }

}  // namespace

TuningStep StepTo(const tuned_settings_t& settings, const tuned_settings_t* before) {
  TuningStep step;
  step.version = settings.version;
  step.tick = settings.acts_at;
  step.source = settings.source;
  step.before_unknown = before == nullptr && settings.version > 1;
  const Lines was = before == nullptr ? Lines() : ByKey(before->changes), is = ByKey(settings.changes);
  for (const auto& [key, line] : is) {
    const auto known = was.find(key);
    if (known == was.end() || known->second != line) step.changes += line + "\n";
  }
  for (const auto& [key, line] : was) {
    if (!is.contains(key)) step.changes += key + " as configured\n";
  }
  return step;
}

std::vector<TuningStep> TuningSteps(const RunMessages& messages) {
  std::map<int64_t, tuned_settings_t> in_force;  // by session
  for (const tuned_settings_t& settings : messages.Of<tuned_settings_t>()) {
    if (settings.version == 0 && settings.stage == tuned_settings_t::IN_FORCE)
      in_force.emplace(settings.session, settings);
  }
  std::vector<TuningStep> steps;
  for (tuned_settings_t& settings : TuningHistory(messages)) {
    const auto before = in_force.find(settings.session);
    steps.push_back(StepTo(settings, before == in_force.end() ? nullptr : &before->second));
    in_force.insert_or_assign(settings.session, std::move(settings));
  }
  return steps;
}

std::string DescribeTuning(const TuningStep& step) {
  const std::string changes = step.changes.empty() ? "nothing changes" : OnOneLine(step.changes);
  return "version " + std::to_string(step.version) + " from tick " + std::to_string(step.tick) + " on" +
         (step.before_unknown ? ", which differs from the configuration: " : ": ") + changes +
         AskedBy(step.source);
}

std::string DescribeInForce(const tuned_settings_t& settings) {
  std::string text = "version " + std::to_string(settings.version);
  if (settings.version > 0)
    text += " since tick " + std::to_string(settings.acts_at) + AskedBy(settings.source);
  return text + (settings.changes.empty()
                     ? ": as configured"
                     : "; differs from the configuration: " + OnOneLine(settings.changes));
}

}  // namespace hydro::runs
