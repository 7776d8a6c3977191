#include "runs/tuning_history.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/text_lines.h"
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

std::string DescribeTuning(const tuned_settings_t& settings) {
  const std::string changes =
      settings.changes.empty() ? "as configured" : Joined(TextLines(settings.changes));
  return "version " + std::to_string(settings.version) + " from tick " + std::to_string(settings.acts_at) +
         " on: " + changes + (settings.source.empty() ? "" : " (" + settings.source + ")");
}

}  // namespace hydro::runs
