// Sets of changes by name, and how probable they are beforehand.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::diagnose {

// The names of what is switched on together with the columns of every hypothesis (ScanColumn::set), sorted.
// Empty: nothing is missing.
using ChangeSet = std::vector<std::string>;

// There are some thirty effects to choose from, and models usually lack one of them.
inline constexpr double kOddsOfAChange = 1.0 / 30;

// "pump.stribeck" of "pump.stribeck|0.03": the change without its variant. Variants of one change exclude
// each other.
std::string_view ChangeOf(std::string_view name);

// The changes of a set, sorted, without their variants.
ChangeSet ChangesOf(const ChangeSet& set);

// The effect's id: "sensor.skew" of "sensor.skew(p1)" and of "sensor.skew(p1)|0.02"; of a closure its balance's.
std::string EffectOf(std::string_view name);

// Is it an effect, with or without a form of its own (a closure), and not merely another value of what the
// model has?
bool IsMissingTerm(std::string_view name);

// `set` with `name`, sorted.
ChangeSet WithChange(const ChangeSet& set, const std::string& name);

// Does `set` have a variant of `name`, or `name` itself?
bool HasChange(const ChangeSet& set, std::string_view name);

// Odds of changes before the runs are seen.
class ChangeOdds {
 public:
  // Among these changes. The variants of one of them share its odds.
  explicit ChangeOdds(const std::vector<std::string>& names);

  // ln of the odds of `set` against none.
  double LogOdds(const ChangeSet& set) const;

 private:
  std::map<std::string, int, std::less<>> variants_;
};

}  // namespace hydro::diagnose
