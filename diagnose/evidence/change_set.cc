#include "diagnose/evidence/change_set.h"

#include <algorithm>
#include <cmath>

#include "diagnose/fit/closure.h"

namespace hydro::diagnose {
namespace {

// A curve without a known cause is named only where no effect will do, because a curve can imitate most
// effects.
constexpr double kOddsOfAClosure = 1.0 / 300;

}  // namespace

std::string EffectOf(std::string_view name) { return std::string(name.substr(0, name.find_first_of("(|"))); }

std::string_view ChangeOf(std::string_view name) { return name.substr(0, name.find('|')); }

ChangeSet ChangesOf(const ChangeSet& set) {
  ChangeSet changes;
  for (const std::string& name : set) changes.emplace_back(ChangeOf(name));
  std::ranges::sort(changes);
  return changes;
}

bool IsMissingTerm(std::string_view name) { return !name.starts_with("value.") && !name.starts_with("run."); }

bool HasCurve(const ChangeSet& set) { return std::ranges::any_of(set, IsClosureEffect); }

ChangeSet WithChange(const ChangeSet& set, const std::string& name) {
  ChangeSet with = set;
  with.insert(std::ranges::lower_bound(with, name), name);
  return with;
}

bool HasChange(const ChangeSet& set, std::string_view name) {
  return std::ranges::any_of(set, [&](const std::string& one) { return ChangeOf(one) == ChangeOf(name); });
}

ChangeOdds::ChangeOdds(const std::vector<std::string>& names) {
  for (const std::string& name : names) ++variants_[std::string(ChangeOf(name))];
}

double ChangeOdds::LogOdds(const ChangeSet& set) const {
  double sum = 0;
  for (const std::string& name : set) {
    const auto variants = variants_.find(ChangeOf(name));
    sum += std::log(IsClosureEffect(name) ? kOddsOfAClosure : kOddsOfAChange);
    if (variants != variants_.end()) sum -= std::log(variants->second);
  }
  return sum;
}

}  // namespace hydro::diagnose
