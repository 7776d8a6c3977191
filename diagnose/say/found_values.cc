#include "diagnose/say/found_values.h"

#include <algorithm>
#include <limits>
#include <string>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/fit/hypothesis.h"
#include "diagnose/say/shown.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {
namespace {

// A number of the model as given, and its value in the model that was found.
struct OwnNumber {
  std::string name, unit;
  double given = 0, found = 0;
  bool is_base = false;
  const model::ParameterInfo* info = nullptr;
};

std::vector<OwnNumber> OwnNumbers(const model::ModelDescription& given, model::ModelDescription found) {
  std::vector<OwnNumber> numbers;
  for (const model::BaseParameter& base : model::BaseParameters()) {
    numbers.push_back({base.info.name, base.info.UnitIn(given.units), given.parameters.*base.member,
                       found.parameters.*base.member, true, &base.info});
  }
  model::ModelDescription before = given;
  for (const model::EffectParameter& parameter : model::EffectParameters(given)) {
    if (!parameter.IsStated(given)) continue;
    const std::string& id = given.effects[parameter.effect].id;
    // Effects that were added come after those that the model has.
    if (parameter.effect >= found.effects.size() || found.effects[parameter.effect].id != id) continue;
    const model::ParameterInfo& info = ParameterOf(given.effects[parameter.effect], parameter.name);
    numbers.push_back({id + "." + parameter.Label(), info.UnitIn(given.units), parameter.In(&before),
                       parameter.In(&found), false, &info});
  }
  return numbers;
}

ChangedParameter DescribeParameter(const OwnNumber& number, const Interval& interval) {
  ChangedParameter changed;
  changed.fitted = {number.name, number.found, interval.low, interval.high, number.unit, true};
  changed.model = number.given;
  JudgeInterval(*number.info, &changed.fitted);
  changed.why = WhyRemarkable(*number.info, changed);
  changed.implausible = !changed.why.empty();
  return changed;
}

// Whether the command demands more than the largest torque in one of the runs, fitted or not. A command that
// was recorded after it was limited demands just this torque, and does not show a larger one.
bool ExceedsTorqueLimit(const ProofContext& context, const model::Parameters& model) {
  constexpr double kRounding = 1e-3;  // of a recorded command
  const auto exceeds = [&](const RunData* run) {
    return std::ranges::any_of(run->stimulus.voltage, [&](double volts) {
      return std::abs(model.k_1 * volts) > (1 + kRounding) * model.T_pmax;
    });
  };
  return std::ranges::any_of(context.runs, exceeds) || std::ranges::any_of(context.held_out, exceeds);
}

// Which of the free numbers the fitted runs do not show, whatever the others are: nothing in the runs depends
// on the number, or they tell less than a hundredth of what was known of it beforehand.
std::vector<bool> Unseen(const Fitted& told) {
  constexpr double kNothing = 0.01;
  const Hypothesis& hypothesis = told.hypothesis;
  const size_t numbers = hypothesis.Free().size();
  std::vector<bool> unseen(numbers, false);
  if (!told.ok() || hypothesis.known == nullptr || !(hypothesis.known->weight > 0)) return unseen;
  const Prior prior = KnownBefore(hypothesis);
  const double discrepancy = std::max(1.0, told.squared_gap());
  for (size_t i = 0; i < numbers; ++i) {
    double shown = 0;
    for (const RunFit& run : told.runs) shown += run.information[i * numbers + i] / discrepancy;
    unseen[i] = shown < kNothing * prior.weight[i] / hypothesis.known->weight;
  }
  return unseen;
}

void KeepAsGiven(const OwnNumber& number, model::ModelDescription* model) {
  for (const model::BaseParameter& base : model::BaseParameters()) {
    if (number.is_base && base.info.name == number.name) model->parameters.*base.member = number.given;
  }
  for (const model::EffectParameter& parameter : model::EffectParameters(*model)) {
    const std::string name = model->effects[parameter.effect].id + "." + parameter.Label();
    if (!number.is_base && name == number.name) parameter.In(model) = number.given;
  }
}

bool LooksTheSame(const OwnNumber& number) { return ShortNumber(number.found) == ShortNumber(number.given); }

}  // namespace

void DescribeValues(const ProofContext& context, const Proof& proof, const std::vector<Interval>& intervals,
                    Diagnosis* d) {
  const Hypothesis& hypothesis = proof.Found();
  const std::vector<FreeParameter> free = hypothesis.Free();
  const std::vector<bool> rests =
      proof.told.ok() ? RestOnKnown(proof.told) : std::vector<bool>(free.size(), false);
  const std::vector<bool> unseen =
      proof.told.ok() ? Unseen(proof.told) : std::vector<bool>(free.size(), false);
  const bool limited = ExceedsTorqueLimit(context, context.given.parameters) ||
                       ExceedsTorqueLimit(context, hypothesis.model.parameters);
  std::vector<std::string> unsure, resting;
  for (const OwnNumber& number : OwnNumbers(context.given, hypothesis.model)) {
    const auto it =
        std::ranges::find_if(free, [&](const FreeParameter& one) { return one.name == number.name; });
    const auto place = static_cast<size_t>(it - free.begin());
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const bool held = it == free.end();
    if (held && LooksTheSame(number)) continue;
    if ((!held && unseen[place]) || (number.name == "T_pmax" && !limited)) {
      KeepAsGiven(number, &d->model);
      d->not_shown.push_back(number.name);
      continue;
    }
    const Interval interval = held ? Interval{kUnknown, kUnknown} : intervals[place];
    // Held base values follow from the free ones: a displacement scales all flows.
    const bool follows = held && number.is_base;
    const bool as_given = number.given >= interval.low && number.given <= interval.high;
    if (follows || (hypothesis.known != nullptr && as_given)) {
      const bool by_run = std::ranges::find(d->by_run, number.name) != d->by_run.end();
      if (!by_run && !LooksTheSame(number)) {
        d->unsure.push_back(number.name);
        unsure.push_back(number.name + " = " + ShortNumber(number.found) + " (was " +
                         ShortNumber(number.given) + ")");
      }
      continue;
    }
    d->parameters.push_back(DescribeParameter(number, interval));
    d->parameters.back().resting = !held && rests[place];
    if (d->parameters.back().resting) resting.push_back(number.name);
  }
  if (!d->not_shown.empty()) {
    d->remarks.push_back("These runs do not show " + Enumerated(d->not_shown) +
                         (d->not_shown.size() == 1
                              ? ": nothing in them depends on it, and it stays as given"
                              : ": nothing in them depends on these, and they stay as given"));
  }
  if (!resting.empty()) {
    d->remarks.push_back(
        "These runs do not show " + Enumerated(resting) +
        " apart from other values: what is said of them rests on how well the model's values are known "
        "([uncertainty] in the model file; --free names those to refit)");
  }
  if (!unsure.empty()) {
    d->remarks.push_back(
        "model.toml has refitted values that these runs do not show to differ from those given: " +
        Joined(unsure));
  }
}

}  // namespace hydro::diagnose
