#include "diagnose/verdict/sentence.h"

#include <algorithm>

#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::diagnose {

namespace {

std::string WordsFor(const std::string& rival) {
  const std::string begin = "parameter ", between = " + " + begin;
  if (rival == "parameters") return "other values of the model's parameters";
  if (!rival.starts_with(begin)) return rival;
  std::vector<std::string> names;
  for (size_t at = begin.size(); at < rival.size();) {
    const size_t end = std::min(rival.find(between, at), rival.size());
    names.push_back(rival.substr(at, end - at));
    at = end + between.size();
  }
  return (names.size() == 1 ? "another value of " : "other values of ") + Enumerated(names);
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

std::vector<std::string> ParametersOf(const Diagnosis& d) {
  std::vector<std::string> parameters;
  for (const ChangedParameter& changed : d.parameters) {
    if (changed.resting) continue;
    parameters.push_back(changed.fitted.name + " = " + ShortNumber(changed.fitted.value) + " instead of " +
                         ShortNumber(changed.model));
  }
  if (parameters.empty() && !d.parameters.empty() && d.effects.empty()) {
    parameters.emplace_back("several together, none of which these runs show alone (see the remarks)");
  }
  return parameters;
}

// "Missing: a and b; with J = 0.02 instead of 0.01", or "Other values: J = ..." without effects.
std::string Found(const std::string& missing, const std::string& values,
                  const std::vector<std::string>& effects, const std::vector<std::string>& parameters) {
  if (effects.empty()) return values + Enumerated(parameters);
  return missing + Enumerated(effects) + (parameters.empty() ? "" : "; with " + Enumerated(parameters));
}

bool Tied(const Diagnosis& d) {
  return std::any_of(d.effects.begin(), d.effects.end(),
                     [](const FoundEffect& effect) { return !effect.tied_with.empty(); });
}

// Whether the gap falls by what a reader sees in its digits.
bool Falls(const BeforeAfter& gap) {
  return gap.after < gap.before && ShortNumber(gap.before, 3) != ShortNumber(gap.after, 3);
}

std::string GapOf(const BeforeAfter& gap) {
  const std::string before = ShortNumber(gap.before, 3), after = ShortNumber(gap.after, 3);
  if (before == after) return " (the held-out gap stays at " + before + " noise units).";
  return " (held-out gap " + before + " to " + after + " noise units).";
}

std::string Unexplained(const Diagnosis& d, const std::vector<std::string>& effects) {
  const double before = d.held_out.before * d.held_out.before - 1;
  const double left = (d.held_out.after * d.held_out.after - 1) / before;
  std::string sentence = "Something is missing that no known effect explains";
  if (effects.empty()) return sentence;
  if (!Falls(d.held_out))
    return sentence + "; the nearest, " + Enumerated(effects) + ", takes nothing of the held-out gap";
  return sentence + "; the nearest is " + Enumerated(effects) + ", which leaves " +
         ShortNumber(100 * left, 2) + " % of the squared gap";
}

}  // namespace

std::string Sentence(const Diagnosis& d, const std::vector<std::string>& doubts) {
  const std::string gap = GapOf(d.held_out);
  const std::vector<std::string> effects = EffectsOf(d), parameters = ParametersOf(d);
  if (!doubts.empty() && IsOpen(d.verdict)) {
    const std::string begin = Falls(d.held_out) ? "The gap becomes smaller with "
                                                : "Only the fitted runs are predicted better with ";
    return Found(begin, begin + "other values: ", effects, parameters) +
           ", but that is not the cause: " + Enumerated(doubts) + gap;
  }
  switch (d.verdict) {
    case Verdict::kNothingMissing:
      return "Nothing is missing: the model as given explains the data to " +
             ShortNumber(d.held_out.before, 3) + " noise units.";
    case Verdict::kParameters:
      return "The equations suffice with other values: " + Enumerated(parameters) + gap;
    case Verdict::kNamed:
      return Found("Missing: ", "", effects, parameters) + gap;
    case Verdict::kTied:
      return Found("Missing, but these data cannot tell which: ", "", effects, parameters) + gap;
    case Verdict::kPartly:
      return Found("Missing, but not all that is missing: ", "Other values explain part of the gap: ",
                   effects, parameters) +
             (Tied(d) ? "; these data cannot tell what stands before a bracket from what is in it"
                      : "; nothing else that was tried takes as much of the gap") +
             std::string(", and a significant gap is left") + gap;
    case Verdict::kUnexplained:
      return Unexplained(d, effects) + gap;
  }
  return "";
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

}  // namespace hydro::diagnose
