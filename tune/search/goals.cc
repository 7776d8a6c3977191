#include "tune/search/goals.h"

#include <cmath>

#include "base/number_text.h"
#include "base/text_file.h"
#include "settings/read_quantities.h"

namespace hydro::tune {
namespace {

struct Goal {
  const char* name;
  std::optional<double> Goals::*value;
  bool zero_allowed;
};

constexpr Goal kGoals[] = {{"bandwidth_hz", &Goals::bandwidth_hz, false},
                           {"overshoot_percent", &Goals::overshoot_percent, true},
                           {"settling_s", &Goals::settling_s, false},
                           {"step", &Goals::step, false}};

// `step_rad` is the former name of `step`. It is correct only for an arm that turns.
const Goal& Find(const std::string& text, std::string name, const std::string& unit) {
  if (name == "step_rad" && unit == "rad") name = "step";
  std::vector<std::string> names;
  for (const Goal& goal : kGoals) {
    if (name == goal.name) return goal;
    names.emplace_back(goal.name);
  }
  throw InputError("--goal: found " + Quoted(text) + ", allowed NAME=VALUE with NAME " + QuotedList(names));
}

}  // namespace

Goals ParseGoals(const std::vector<std::string>& texts, const std::string& unit) {
  Goals goals;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    const Goal& goal = Find(text, text.substr(0, equals), unit);
    const std::string given = equals == std::string::npos ? "" : text.substr(equals + 1);
    auto number = ParseNumber(given);
    // "30 mm", "30mm"
    if (goal.value == &Goals::step && !number && given.find_first_of("0123456789") != std::string::npos) {
      number = settings::NumberOf(given, unit, "--goal", goal.name);
    }
    const bool allowed = number && std::isfinite(*number) && (goal.zero_allowed ? *number >= 0 : *number > 0);
    if (!allowed) {
      throw InputError("--goal: found " + Quoted(text) + ", allowed " + goal.name + "= a finite number " +
                       (goal.zero_allowed ? "from 0 on" : "above 0"));
    }
    if (goals.*goal.value) {
      throw InputError(std::string("--goal: found ") + goal.name + " twice, allowed each goal once");
    }
    goals.*goal.value = number;
  }
  return goals;
}

}  // namespace hydro::tune
