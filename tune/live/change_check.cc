#include "tune/live/change_check.h"

#include <algorithm>
#include <array>
#include <map>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "settings/quantity_keys.h"
#include "settings/toml/toml_edit.h"
#include "tune/design/loop_check.h"
#include "tune/design/operating_cases.h"
#include "tune/live/reference_range.h"
#include "tune/live/tunable_keys.h"
#include "tune/live/tuned_values.h"

namespace hydro::tuning {
namespace {

constexpr size_t kMostChanges = 64;

std::string KeyOf(const std::string& change) {
  return settings::PresentName(Trimmed(change.substr(0, change.find('='))));
}

std::map<std::string, std::string> TunableEntries(const settings::StackConfig& config) {
  std::map<std::string, std::string> entries;
  for (const auto& [key, value] : settings::TomlEntries(settings::ParseToml(config.text, config.file))) {
    if (FindTunable(key) != nullptr) entries.emplace(key, value);
  }
  return entries;
}

struct Limit {
  const char* key;
  double settings::LimitsSection::*value;
};
constexpr std::array kLimits{Limit{"limits.pressure", &settings::LimitsSection::pressure_psi},
                             Limit{"limits.motor_speed", &settings::LimitsSection::motor_speed_rad_s},
                             Limit{"limits.arm_angle", &settings::LimitsSection::arm_angle_rad},
                             Limit{"limits.arm_torque", &settings::LimitsSection::arm_torque_in_lbf}};

std::string LoosenedLimit(const settings::LimitsSection& before, const settings::LimitsSection& after,
                          const UnitSystem& units) {
  for (const Limit& limit : kLimits) {
    const std::string unit = " " + settings::UnitOfKey(limit.key, units, "");
    const double was = before.*limit.value, is = after.*limit.value;
    if (!(is > was)) continue;
    return std::string(limit.key) + ": found " + ShortestNumber(is) + unit + ", allowed up to " +
           ShortestNumber(was) + unit +
           ", which is in force: a limit is loosened only while a fault holds zero volts (limits.rearm = "
           "\"explicit\"), before "
           "the re-arm, or by a restart";
  }
  return "";
}

// Whether an unstable loop becomes more stable and no other loop becomes less stable: a stable loop stays
// stable, and an unstable loop grows no faster. Rounding does not count as improvement.
bool MoreStable(const design::LoopCheck& next, const design::LoopCheck& now) {
  bool better = false;
  for (const auto loop : {&design::LoopCheck::pressure, &design::LoopCheck::position}) {
    const std::optional<design::CheckedLoop>&was = now.*loop, &is = next.*loop;
    if (!is || is->worst.stable) continue;
    if (!was || was->worst.stable) return false;
    const double grew = was->worst.spectral_radius, grows = is->worst.spectral_radius;
    if (grows > grew) return false;
    better |= grows < grew - 1e-6;
  }
  const bool mended =
      (now.pressure && !now.pressure->worst.stable && next.pressure && next.pressure->worst.stable) ||
      (now.position && !now.position->worst.stable && next.position && next.position->worst.stable);
  return better || mended;
}

// Stable in the model, but perhaps not in a rig that differs from it by the usual amount.
bool HardlyStable(const design::LoopCheck& check) {
  const auto hardly = [](const std::optional<design::CheckedLoop>& loop) {
    if (!loop || !loop->margins_known) return false;
    const design::LoopMargins& worst = loop->worst;
    return !(worst.gain >= 1.25) || !(worst.least_gain <= 0.8) || !(worst.phase_deg >= 10);
  };
  return check.stable() && (hardly(check.pressure) || hardly(check.position));
}

bool GoesNoFarther(const settings::StackConfig& than, const settings::StackConfig& next) {
  return design::LargestArmAngle(next) <= design::LargestArmAngle(than) &&
         SameLaws(ValuesOf(than), ValuesOf(next));
}

// Why the loops forbid the change; empty: they permit it. Writes their margins to `text`.
std::string WhyTheLoopsForbid(const settings::StackConfig& configured, const settings::StackConfig& in_force,
                              const settings::StackConfig& next, bool undo, std::string* text) {
  if (GoesNoFarther(in_force, next)) return "";
  const design::LoopCheck check = design::CheckLoops(next);
  *text = design::Describe(check);
  if (check.unknown) {
    // The values with which the stack was started are the responsibility of the person who started it.
    if (undo || GoesNoFarther(configured, next)) return "";
    return *text +
           "; allowed are values whose loops can be judged: change these in the configuration, and restart";
  }
  if (HardlyStable(check))
    *text += "; HARDLY STABLE: a rig that differs a little from its model may oscillate";
  if (check.stable()) return "";
  if (undo) {
    *text += "; an UNSTABLE loop, as it was when these values were in force before";
    return "";
  }
  // If loops are already unstable, a change may lead towards stable ones.
  const design::LoopCheck now = design::CheckLoops(in_force);
  if (!now.unknown && MoreStable(check, now)) {
    *text += "; still UNSTABLE, but less than what was in force";
    return "";
  }
  return "would be unstable: " + *text +
         (now.unknown || now.stable()
              ? ""
              : "; what is in force is unstable, too: allowed is what makes it more stable");
}

// What to ask for instead of an undo that would loosen a limit, and therefore does nothing.
std::string HowToTakeBackTheRest(const settings::StackConfig& in_force, const settings::StackConfig& next) {
  std::string words;
  for (const std::string& line : TextLines(DifferenceOf(in_force, next))) {
    const std::string key = KeyOf(line);
    if (std::any_of(kLimits.begin(), kLimits.end(), [&](const Limit& limit) { return key == limit.key; }))
      continue;
    const std::string value = Trimmed(line.substr(line.find('=') + 1));
    const bool plain = value.find_first_of(" \"[]{}") == std::string::npos;
    words += plain ? " " + key + "=" + value : " '" + key + "=" + value + "'";
  }
  if (words.empty())
    return "; nothing else would change: with the limit as it is there is nothing to take back";
  return "; to take back the rest alone, set it: hydro-set CONFIG" + words;
}

// For people, because an undo may remove a key again.
std::string KeysTakenOut(const settings::StackConfig& from, const settings::StackConfig& to) {
  const auto before = TunableEntries(from), after = TunableEntries(to);
  std::string lines;
  for (const auto& [key, value] : before) {
    if (!after.contains(key)) lines += key + " as by default\n";
  }
  return lines;
}

}  // namespace

std::vector<std::string> ParseChanges(const std::string& lines) {
  std::vector<std::string> changes;
  for (const std::string& line : TextLines(lines)) {
    if (Trimmed(line).empty()) continue;
    const std::string key = KeyOf(line);
    if (line.find('=') == std::string::npos || key.empty()) {
      throw InputError(Quoted(line) + ": allowed key=value, e.g. position.c2=900");
    }
    if (std::any_of(changes.begin(), changes.end(), [&](const auto& other) { return KeyOf(other) == key; })) {
      throw InputError(key + ": found twice, allowed once in a change");
    }
    if (changes.size() == kMostChanges) {
      throw InputError("found more than " + std::to_string(kMostChanges) + " values in one change");
    }
    changes.push_back(line);
  }
  if (changes.empty()) throw InputError("found no value, allowed key=value, e.g. position.c2=900");
  return changes;
}

std::string OnOneLine(const std::string& changes) { return Joined(TextLines(changes)); }

std::string DifferenceOf(const settings::StackConfig& from, const settings::StackConfig& to) {
  const auto before = TunableEntries(from), after = TunableEntries(to);
  std::string lines;
  for (const auto& [key, value] : after) {
    const auto was = before.find(key);
    if (was == before.end() || was->second != value) lines += key + " = " + value + "\n";
  }
  return lines;
}

PreparedChange PrepareChange(const settings::StackConfig& configured, const settings::StackConfig& in_force,
                             const std::vector<std::string>& changes, const Situation& situation) {
  PreparedChange refused;
  for (const std::string& change : changes) {
    const std::string key = KeyOf(change);
    if (FindTunable(key) == nullptr) refused.text = WhyNotTunable(key);
    if (key.starts_with("noise.") && !situation.simulated) {
      refused.text = key + ": the rig is a real one, whose noise is its own";
    }
    if (!refused.text.empty()) return refused;
  }
  try {
    auto next = std::make_shared<settings::StackConfig>(settings::Changed(in_force, changes));
    return PrepareChange(configured, in_force, std::move(next), situation);
  } catch (const InputError& error) {
    refused.text = error.what();
    if (refused.text.starts_with("--set ")) refused.text.erase(0, 6);
  }
  return refused;
}

PreparedChange PrepareChange(const settings::StackConfig& configured, const settings::StackConfig& in_force,
                             std::shared_ptr<const settings::StackConfig> next, const Situation& situation) {
  PreparedChange change;
  try {
    Write(ValuesOf(*next), &change.message);
  } catch (const InputError& error) {  // the gains cannot be derived
    change.text = error.what();
    return change;
  }
  if (!situation.held)
    change.text = LoosenedLimit(in_force.limits, next->limits, next->model.description.units);
  if (!change.text.empty() && situation.undo) change.text += HowToTakeBackTheRest(in_force, *next);
  if (change.text.empty()) change.text = WhatTheRigCannotFollow(*next);
  if (!change.text.empty()) return change;
  std::string margins;
  change.text = WhyTheLoopsForbid(configured, in_force, *next, situation.undo, &margins);
  if (!change.text.empty()) return change;

  const std::string reference = settings::ReferenceText(*next);
  change.new_reference = reference != settings::ReferenceText(in_force);
  if (reference != settings::ReferenceText(configured)) change.message.reference = reference;
  change.message.changes = DifferenceOf(configured, *next);
  change.text = DifferenceOf(in_force, *next) + KeysTakenOut(in_force, *next);
  change.nothing_differs = change.text.empty();
  if (change.nothing_differs) change.text = "nothing differs from what is in force";
  change.text = OnOneLine(change.text);
  if (!margins.empty()) change.text += "; " + margins;
  change.config = std::move(next);
  return change;
}

}  // namespace hydro::tuning
