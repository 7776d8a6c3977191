#include "diagnose/fit/closure.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/recording/run_data.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {
namespace {

std::string BalanceOf(const Closure& closure) {
  const std::string balance = closure.id.substr(closure.id.find('.') + 1);
  if (balance == "pump_torque") return "the torque on the pump";
  if (balance == "arm_torque") return "the torque on the arm";
  return balance == "flow_1" ? "the flow into side 1" : "the flow into side 2";
}

// The unit of a variable on which closures depend, in the model's units.
std::string UnitOf(const std::string& variable, const UnitSystem& units) {
  if (variable == "voltage") return "V";
  std::string angle = ChannelUnit(model::Channel::kArmAngle, units);
  if (variable == "arm_angle") return angle;
  if (variable == "arm_speed") return angle + "/s";
  if (variable == "motor_angle") return ChannelUnit(model::Channel::kMotorAngle, units);
  return ChannelUnit(variable == "motor_speed" ? model::Channel::kMotorSpeed : model::Channel::kP1, units);
}

Closure Described(const model::EffectDescription& effect, const UnitSystem& units,
                  const std::vector<FreeParameter>& free, const std::vector<Interval>& intervals) {
  Closure closure;
  closure.id = effect.id;
  closure.unit = ParameterOf(effect, "values").UnitIn(units);
  closure.against = effect.name_lists.at("against");
  for (const std::string& name : closure.against) closure.against_units.push_back(UnitOf(name, units));
  closure.knots.push_back(effect.lists.at("knots"));
  if (closure.against.size() == 2) closure.knots.push_back(effect.lists.at("knots_2"));
  closure.value = closure.low = closure.high = effect.lists.at("values");
  size_t value = 0;
  for (size_t i = 0; i < std::min(free.size(), intervals.size()) && value < closure.value.size(); ++i) {
    if (!free[i].name.starts_with(effect.id + ".values[")) continue;
    closure.low[value] = std::min(closure.value[value], intervals[i].low);
    closure.high[value] = std::max(closure.value[value], intervals[i].high);
    ++value;
  }
  closure.resembles = Resemblance(closure);
  return closure;
}

}  // namespace

bool IsClosureEffect(std::string_view effect) { return effect.starts_with("closure."); }

std::vector<Closure> FoundClosures(const Hypothesis& hypothesis, const std::vector<Interval>& intervals) {
  const std::vector<FreeParameter> free = hypothesis.Free();
  std::vector<Closure> closures;
  for (const Change& change : hypothesis.changes) {
    if (!IsClosureEffect(change.effect)) continue;
    for (const model::EffectDescription& effect : hypothesis.model.effects) {
      if (effect.id != change.effect) continue;
      closures.push_back(Described(effect, hypothesis.model.units, free, intervals));
      break;
    }
  }
  return closures;
}

std::string ClosureSentence(const std::vector<Closure>& closures) {
  if (closures.empty()) return "";
  // A change that rounding hides is no improvement.
  if (ShortNumber(closures.front().before, 3) == ShortNumber(closures.front().after, 3)) return "";
  std::vector<std::string> curves;
  curves.reserve(closures.size());
  for (const Closure& closure : closures) {
    curves.push_back((closure.against.size() == 2 ? "a surface over " : "a curve of ") +
                     Enumerated(closure.against) + " in " + BalanceOf(closure) + " (it " + closure.resembles +
                     ")");
  }
  const Closure& first = closures.front();
  std::string sentence = " The model and " + Enumerated(curves) + " predict held-out runs over " +
                         ShortNumber(first.seconds, 2) + " s";
  if (!std::isfinite(first.before) || !(first.before > 0)) return sentence + ", which it cannot without.";
  const double taken = 1 - std::pow(first.after / first.before, 2);
  return sentence + " better: " + ShortNumber(first.before, 3) + " to " + ShortNumber(first.after, 3) +
         " noise units, " + ShortNumber(100 * taken, 2) + " % of the squared gap.";
}

}  // namespace hydro::diagnose
