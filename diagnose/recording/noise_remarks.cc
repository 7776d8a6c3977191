#include "diagnose/recording/noise_remarks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::diagnose {
namespace {

constexpr double kUnlikeStated = 2;  // ratio of noises

bool IsNoisierThanStated(const SignalData& signal) {
  return signal.estimated_noise > kUnlikeStated * signal.stated_noise;
}
bool IsUnlikeStated(const SignalData& signal) {
  return IsNoisierThanStated(signal) || kUnlikeStated * signal.estimated_noise < signal.stated_noise;
}

// In several runs, one signal whose noise differs from what they state.
struct Unlike {
  model::Channel channel = model::Channel::kP1;
  std::vector<double> stated, shown;  // by run, in the signal's unit
};

// Runs in which the same signals differ from what is stated, all of them noisier or all quieter.
struct Group {
  bool noisier = false, sidecar = false;
  std::vector<std::string> runs, sidecars;
  std::vector<Unlike> signals;
  const UnitSystem* units = nullptr;

  bool Takes(const Group& other) const {
    return noisier == other.noisier && sidecar == other.sidecar &&
           std::equal(signals.begin(), signals.end(), other.signals.begin(), other.signals.end(),
                      [](const Unlike& a, const Unlike& b) { return a.channel == b.channel; });
  }
};

Group GroupOf(const RunData& run, bool noisier) {
  Group group;
  group.noisier = noisier;
  group.runs = {run.name};
  group.units = &run.measured.units;
  const std::string sidecar = std::filesystem::path(run.measured.sidecar).filename().string();
  if (!sidecar.empty()) group.sidecars = {sidecar};
  // A log states the noise of its own configuration, which no sidecar can change.
  group.sidecar = !run.measured.time_source.column.empty();
  for (const SignalData& signal : run.signals) {
    if (!IsUnlikeStated(signal) || IsNoisierThanStated(signal) != noisier) continue;
    group.signals.push_back({signal.channel, {signal.stated_noise}, {signal.estimated_noise}});
  }
  return group;
}

void Join(const Group& more, Group* group) {
  group->runs.push_back(more.runs.front());
  for (const std::string& sidecar : more.sidecars) {
    const bool there = std::ranges::find(group->sidecars, sidecar) != group->sidecars.end();
    if (!there) group->sidecars.push_back(sidecar);
  }
  for (size_t i = 0; i < more.signals.size(); ++i) {
    group->signals[i].stated.push_back(more.signals[i].stated.front());
    group->signals[i].shown.push_back(more.signals[i].shown.front());
  }
}

std::string RemarkOn(const Group& group, size_t runs) {
  std::vector<std::string> found, lines;
  for (const Unlike& signal : group.signals) {
    const double stated = maths::Median(signal.stated), shown = maths::Median(signal.shown);
    const std::string& name = ChannelName(signal.channel);
    found.push_back(name + " " + ShortNumber(shown, 3) + " " + ChannelUnit(signal.channel, *group.units) +
                    ", " + ShortNumber(shown / stated, 2) + " times the stated " + ShortNumber(stated, 3));
    lines.push_back(name + " = " + ShortNumber(shown, 3));
  }
  return RunsNamed(group.runs, runs) +
         (group.noisier
              ? ": the samples show more noise than is stated; gaps count in the stated one, and are "
                "closed where only what the samples show is left: "
              : ": the samples show another noise than is stated, and the stated one counts: ") +
         Joined(found, "; ") +
         (group.sidecar
              ? "; this in " + (group.sidecars.empty() ? "the sidecar" : Enumerated(group.sidecars)) +
                    ", under [noise], mends it: " + Joined(lines, "; ")
              : "");
}

}  // namespace

double NoiseShown(const std::vector<const RunData*>& runs) {
  double sum = 0, count = 0;
  for (const RunData* run : runs) {
    for (const SignalData& signal : run->signals) {
      const double shown = IsNoisierThanStated(signal) ? signal.estimated_noise / signal.stated_noise : 1;
      sum += shown * shown;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 1;
}

std::vector<std::string> NoiseRemarks(const std::vector<const RunData*>& runs) {
  std::vector<Group> groups;
  for (const bool noisier : {true, false}) {
    for (const RunData* run : runs) {
      Group one = GroupOf(*run, noisier);
      if (one.signals.empty()) continue;
      const auto same = std::ranges::find_if(groups, [&](const Group& group) { return group.Takes(one); });
      if (same == groups.end()) {
        groups.push_back(std::move(one));
      } else {
        Join(one, &*same);
      }
    }
  }
  std::vector<std::string> remarks;
  remarks.reserve(groups.size());
  for (const Group& group : groups) remarks.push_back(RemarkOn(group, runs.size()));
  return remarks;
}

}  // namespace hydro::diagnose
