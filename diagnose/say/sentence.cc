#include "diagnose/say/sentence.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/say/claims.h"

namespace hydro::diagnose {
namespace {

std::string WordsFor(const std::string& rival) {
  const std::string begin = "parameter ", between = " + ";
  if (rival == "parameters") return "other values of the model's parameters";
  std::vector<std::string> words, names;
  for (size_t at = 0; at < rival.size();) {
    const size_t end = std::min(rival.find(between, at), rival.size());
    const std::string part = rival.substr(at, end - at);
    if (part.starts_with(begin)) {
      names.push_back(part.substr(begin.size()));
    } else {
      words.push_back(ChangeInWords(part));
    }
    at = end + between.size();
  }
  if (!names.empty())
    words.push_back((names.size() == 1 ? "another value of " : "other values of ") + Enumerated(names));
  return Joined(words, between);
}

std::vector<std::string> EffectsOf(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const FoundEffect& effect : d.effects) {
    std::string name = effect.summary + " [" + effect.id + "]";
    if (!effect.tied_with.empty()) name += " (or " + Joined(InWords(effect.tied_with), ", or ") + ")";
    names.push_back(name);
  }
  return names;
}

std::string NoneAlone(const std::vector<std::string>& names) {
  return names.size() == 1
             ? names.front() + ", which these runs do not show by itself (see the remarks)"
             : Enumerated(names) + " together, none of which these runs show alone (see the remarks)";
}

// Values that the runs show by themselves, then the names of those that they show beside others only. Values
// whose intervals hold what was given are named where there are no others: they may do all of the work.
std::vector<std::string> ParametersOf(const Diagnosis& d) {
  std::vector<std::string> clear, within, others;  // within: the interval holds the value as given
  bool moved = false;                              // one of the others, away from what was given
  const auto differs_by_run = [&](const std::string& name) {
    return std::ranges::find(d.by_run, name) != d.by_run.end();
  };
  for (const ChangedParameter& changed : d.parameters) {
    if (differs_by_run(changed.fitted.name)) continue;
    const std::string now = ShortNumber(changed.fitted.value), before = ShortNumber(changed.model);
    const bool beside = changed.resting || !changed.fitted.shown;
    const bool holds = changed.fitted.low <= changed.model && changed.model <= changed.fitted.high;
    if (!beside && now != before)
      (holds ? within : clear).push_back(changed.fitted.name + " = " + now + " instead of " + before);
    if (!beside) continue;
    others.push_back(changed.fitted.name);
    moved = moved || (changed.resting && !holds);
  }
  std::vector<std::string> parameters = clear.empty() && d.effects.empty() ? within : clear;
  if (parameters.empty() && !moved) others.insert(others.begin(), d.unsure.begin(), d.unsure.end());
  if (d.effects.empty() && !others.empty() && d.by_run.empty()) parameters.push_back(NoneAlone(others));
  for (const std::string& name : d.by_run) parameters.push_back(name + ", which differs from run to run");
  return parameters;
}

// "Missing: a and b; with J = 0.02 instead of 0.01", or "Other values: J = ..." without effects.
std::string Found(const std::string& missing, const std::string& values,
                  const std::vector<std::string>& effects, const std::vector<std::string>& parameters) {
  if (effects.empty()) return values + Enumerated(parameters);
  return missing + Enumerated(effects) + (parameters.empty() ? "" : "; with " + Enumerated(parameters));
}

bool Tied(const Diagnosis& d) {
  return std::ranges::any_of(d.effects, [](const FoundEffect& effect) { return !effect.tied_with.empty(); });
}

// Whether the gap falls so far that a reader sees it in the digits. From a gap that the model cannot follow,
// any remainder is a fall.
bool Falls(const BeforeAfter& gap) {
  if (!std::isfinite(gap.before)) return std::isfinite(gap.after);
  return gap.after < gap.before && ShortNumber(gap.before, 3) != ShortNumber(gap.after, 3);
}

// "over 0.4 s". For whole runs, "", unless windows usually decide.
std::string OverWhat(const Diagnosis& d, const ComparedGap& compared) {
  if (compared.seconds > 0) return " over " + ShortNumber(compared.seconds, 2) + " s";
  return d.horizons.empty() ? "" : " over whole runs";
}

// Where the samples are noisier than is stated, a gap of more than 1 may be their noise alone.
std::string OfTheSamples(const Diagnosis& d) {
  return d.noise_shown > 1 ? "; the noise that the samples show makes " + ShortNumber(d.noise_shown, 3) : "";
}

// What a model that explains the windows leaves of whole runs, where that is much more.
std::string OverWholeRuns(const Diagnosis& d, const ComparedGap& compared) {
  constexpr double kMuchMore = 2;
  const double whole = std::max(d.held_out.before, d.fit.before);
  if (compared.seconds == 0 || !std::isfinite(whole) || whole < kMuchMore * compared.gap.before) return "";
  return ", and whole runs, over which every small error adds up, to " + ShortNumber(whole, 3);
}

std::string GapOf(const Diagnosis& d, const ComparedGap& compared) {
  const BeforeAfter& gap = compared.gap;
  const std::string over = OverWhat(d, compared);
  const std::string which = compared.of_fitted ? "fitted " : d.half_fitted ? "" : "held-out ";
  const std::string before = ShortNumber(gap.before, 3), after = ShortNumber(gap.after, 3);
  if (!std::isfinite(gap.after)) {
    return " (" + std::string(std::isfinite(gap.before) ? "with it the model" : "the model") +
           " cannot follow the " + which + "runs" + over + ").";
  }
  if (!std::isfinite(gap.before)) {
    return " (the model as given cannot follow the " + which + "runs" + over + "; " + after +
           " noise units are left" + OfTheSamples(d) + ").";
  }
  const std::string of = which + "gap" + over;
  if (before == after) return " (the " + of + " stays at " + before + " noise units" + OfTheSamples(d) + ").";
  if (gap.after > gap.before)
    return " (the " + of + " rises from " + before + " to " + after + " noise units" + OfTheSamples(d) + ").";
  return " (" + of + " " + before + " to " + after + " noise units" + OfTheSamples(d) + ").";
}

// The text after what was found, for a verdict that leaves something open.
std::string WhatIsLeft(const Diagnosis& d, const ComparedGap& compared) {
  if (!compared.closed) return ", and a significant gap is left";
  return d.closures.empty() ? "" : ", and a curve, which is no cause, closes the rest";
}

std::string Unexplained(const Diagnosis& d, const ComparedGap& compared,
                        const std::vector<std::string>& effects, const std::vector<std::string>& parameters) {
  std::string sentence = "Something is missing that no known effect explains";
  const BeforeAfter& gap = compared.gap;
  if (effects.empty()) {
    if (d.closures.empty()) return sentence;
    sentence += compared.closed ? "; a curve, which is no cause, closes the gap"
                                : "; a curve closes a part of the gap";
    return d.parameters.empty() ? sentence : sentence + ", with " + Enumerated(parameters);
  }
  if (!Falls(gap))
    return sentence + "; the nearest, " + Enumerated(effects) + ", takes nothing of the " +
           (compared.of_fitted ? "fitted" : "held-out") + " gap";
  if (d.recorder_may_be && compared.closed)
    return "Something acts late, by no more than two samples: " + Enumerated(effects) +
           " explains the runs to the noise, and so may the recorder, whose means and filters are as late";
  sentence += "; the nearest is " + Enumerated(effects);
  // Where only noise is left, no share says anything.
  if (!std::isfinite(gap.before) || !(gap.before > 1 && gap.after > 1)) return sentence;
  const double left = (gap.after * gap.after - 1) / (gap.before * gap.before - 1);
  return sentence + ", which leaves " + ShortNumber(100 * left, 2) + " % of the squared gap";
}

std::string Partly(const Diagnosis& d, const ComparedGap& compared, const std::vector<std::string>& effects,
                   const std::vector<std::string>& parameters) {
  if (effects.empty() && !d.closures.empty()) return Unexplained(d, compared, effects, parameters);
  const std::string values = Falls(compared.gap) ? "Other values explain part of the gap: "
                                                 : "Other values explain part of what is missing: ";
  return Found("Missing, but not all that is missing: ", values, effects, parameters) +
         (Tied(d) ? "; these data cannot tell what stands before a bracket from what is in it"
                  : "; nothing else that was tried takes as much of the gap") +
         WhatIsLeft(d, compared);
}

}  // namespace

std::string Sentence(const Diagnosis& d, const ComparedGap& compared) {
  const std::string gap = GapOf(d, compared);
  const std::vector<std::string> effects = EffectsOf(d), parameters = ParametersOf(d);
  switch (d.verdict) {
    case Verdict::kNothingMissing:
      return "Nothing is missing: the model as given explains the data to " +
             ShortNumber(compared.gap.before, 3) + " noise units" +
             (compared.seconds > 0 ? " over " + ShortNumber(compared.seconds, 2) + " s" : "") +
             OfTheSamples(d) + OverWholeRuns(d, compared) + ".";
    case Verdict::kParameters:
      if (Falls(compared.gap))
        return "The equations suffice with other values: " + Enumerated(parameters) + gap;
      return "The equations suffice; other values fit the runs better, but predict the " +
             std::string(compared.of_fitted ? "fitted" : "held-out") +
             " ones no better: " + Enumerated(parameters) + gap;
    case Verdict::kNamed:
      return Found("Missing: ", "", effects, parameters) + gap;
    case Verdict::kTied:
      return Found("Missing, but these data cannot tell which: ", "", effects, parameters) + gap;
    case Verdict::kPartly:
      return Partly(d, compared, effects, parameters) + gap;
    case Verdict::kUnexplained:
      return Unexplained(d, compared, effects, parameters) + gap;
  }
  return "";
}

std::string ChangeInWords(const std::string& change) {
  const auto begins = [&](const std::string& with) { return change.starts_with(with); };
  if (begins("value.")) return "another value of " + change.substr(6);
  if (begins("run.")) return change.substr(4) + " that differs by run";
  if (!begins("closure.")) return change;
  const size_t open = change.find('('), close = change.rfind(')');
  std::string of = change.substr(8, open == std::string::npos ? open : open - 8), over;
  if (open != std::string::npos && close != std::string::npos)
    over = " over " + change.substr(open + 1, close - open - 1);
  std::ranges::replace(of, '_', ' ');
  std::ranges::replace(over, '_', ' ');
  return "an unknown curve" + over + " in " + of;
}

std::vector<std::string> InWords(const std::vector<std::string>& rivals) {
  std::vector<std::string> words;
  words.reserve(rivals.size());
  for (const std::string& rival : rivals) words.push_back(WordsFor(rival));
  return words;
}

std::string WhyNext(const std::vector<FoundEffect>& effects) {
  for (const FoundEffect& effect : effects) {
    if (!effect.tied_with.empty()) {
      return "distinguishes " + effect.id + " from " + Enumerated(InWords(effect.tied_with));
    }
  }
  return "";
}

std::string ChoiceRemark(const Diagnosis& d) {
  std::map<std::string, std::vector<std::string>> others;  // runs by what the others choose without them
  std::vector<std::string> runs;
  for (const ChoiceWithout& choice : d.choices) {
    if (choice.same) continue;
    others[choice.chosen].push_back(choice.run);
    runs.push_back(choice.run);
  }
  const std::string begin =
      d.half_fitted
          ? "Every second window of each run was fitted, and the others chose between models, so that "
            "held-out gaps are those of a model that saw half of each run"
          : "Each run was predicted from the others, with values that were not fitted to it";
  if (others.empty()) {
    return begin + "; among what was tried, the others choose the same without it";
  }
  std::vector<std::string> said;
  for (const auto& [chosen, without] : others) {
    std::vector<std::string> named;
    for (const std::string& run : without) named.push_back(RunNamed(run));
    said.push_back("without " + Joined(named, " or ") + " the others choose " +
                   (chosen == kAsGiven ? "the model as given" : InWords({chosen}).front()));
  }
  return begin + "; but " + Enumerated(said) + ": how well " + RunsNamed(runs) +
         (runs.size() == 1 ? " is" : " are") +
         " predicted is no proof of what was found. For one, fit two runs or more and name another with "
         "--hold-out";
}

}  // namespace hydro::diagnose
