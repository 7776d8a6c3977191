#include "diagnose/say/claims.h"

#include <algorithm>

#include "base/word_list.h"
#include "diagnose/fit/closure.h"
#include "diagnose/prove/proof_context.h"

namespace hydro::diagnose {
namespace {

// The label as Change::Label() writes it: "sensor.skew (p1)".
std::string LabelOf(const std::string& change) {
  const size_t names = change.find('(');
  if (names == std::string::npos || IsClosureEffect(change)) return change;
  return change.substr(0, names) + " " + change.substr(names);
}

std::string JoinedClaim(std::vector<std::string> said) {
  std::ranges::sort(said);
  return said.empty() ? kAsGiven : Joined(said, " + ");
}

}  // namespace

std::string ClaimOf(const Hypothesis& hypothesis) {
  std::vector<std::string> said;
  for (const Change& change : hypothesis.changes) {
    if (!change.effect.empty()) said.push_back(change.Label());
  }
  if (said.empty()) {
    if (hypothesis.base.size() + hypothesis.effects.size() > static_cast<size_t>(kMostChanges))
      return "parameters";
    for (const size_t i : hypothesis.base)
      said.push_back("parameter " + model::BaseParameters()[i].info.name);
    for (const std::string& id : hypothesis.effects) said.push_back("parameters of " + id);
  }
  return JoinedClaim(std::move(said));
}

std::string ClaimOfSet(const std::vector<std::string>& changes) {
  std::vector<std::string> effects, values;
  for (const std::string& change : changes) {
    const bool value = change.starts_with("value.");
    if (value || change.starts_with("run.")) {
      values.push_back(value ? "parameter " + change.substr(change.find('.') + 1) : change);
    } else {
      effects.push_back(LabelOf(change));
    }
  }
  return JoinedClaim(effects.empty() ? std::move(values) : std::move(effects));
}

std::string NameInSets(const Change& change) {
  if (change.effect.empty()) return "value." + change.parameter;
  std::string label = change.Label();
  std::erase(label, ' ');
  return label;
}

double WeightOf(const Change& change, const std::vector<WeightedSet>& explanations) {
  const std::string name = NameInSets(change);
  double sum = 0;
  for (const WeightedSet& one : explanations) {
    const bool has = std::ranges::any_of(one.changes, [&](const std::string& other) {
      return other == name || (IsClosureEffect(name) && other.starts_with(name + "("));
    });
    sum += has ? one.weight : 0;
  }
  return std::min(1.0, sum);
}

}  // namespace hydro::diagnose
