// Sets of changes by name, and how probable they are before the runs are seen.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::diagnose {

// Sorted names of changes that are switched on beside the columns of every hypothesis (ScanColumn::set). An
// empty set means that nothing is missing.
using ChangeSet = std::vector<std::string>;

// About thirty effects are available, and models usually lack one of them.
inline constexpr double kOddsOfAChange = 1.0 / 30;

// Returns the change without its variant: "pump.stribeck" for "pump.stribeck|0.03". Variants of one change
// exclude each other.
std::string_view ChangeOf(std::string_view name);

// The changes of a set, sorted and without their variants.
ChangeSet ChangesOf(const ChangeSet& set);

// The id of the effect: "sensor.skew" for "sensor.skew(p1)" and for "sensor.skew(p1)|0.02". For a closure it
// is the id for its balance.
std::string EffectOf(std::string_view name);

// Whether the change is an effect, with or without a form of its own (a closure), and not merely another
// value of something that the model already has.
bool IsMissingTerm(std::string_view name);

// Whether one of the changes is an unknown curve. A curve can imitate most effects and names none, so it is
// no rival of a name.
bool HasCurve(const ChangeSet& set);

// Returns `set` with `name` added, sorted.
ChangeSet WithChange(const ChangeSet& set, const std::string& name);

// Whether `set` contains a variant of `name`, or `name` itself.
bool HasChange(const ChangeSet& set, std::string_view name);

// The odds of changes before the runs are seen.
class ChangeOdds {
 public:
  // The odds among these changes. The variants of one change share its odds.
  explicit ChangeOdds(const std::vector<std::string>& names);

  // ln of the odds of `set` against the empty set.
  double LogOdds(const ChangeSet& set) const;

 private:
  std::map<std::string, int, std::less<>> variants_;
};

}  // namespace hydro::diagnose
