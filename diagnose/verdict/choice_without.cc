#include "diagnose/verdict/choice_without.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/word_list.h"
#include "diagnose/search/explanation.h"
#include "diagnose/verdict/evidence.h"
#include "diagnose/verdict/sentence.h"

namespace hydro::diagnose {
namespace {

// The squared gap of all blocks but those of one run.
double GapWithout(const Contest& contest, const Evidence& one, const std::string& run) {
  double sum = 0, count = 0;
  for (size_t b = 0; b < contest.runs.size(); ++b) {
    if (contest.runs[b] == run) continue;
    sum += contest.geometric ? LogarithmOf(one.squared_gaps[b]) : one.squared_gaps[b];
    count += 1;
  }
  return contest.geometric ? std::exp(sum / count) : sum / count;
}

bool IsSimpler(const Evidence& one, const Evidence& than) {
  return one.parts.size() < than.parts.size() &&
         std::includes(than.parts.begin(), than.parts.end(), one.parts.begin(), one.parts.end());
}

struct RatedChoice {
  const Evidence* one = nullptr;
  double gap = std::numeric_limits<double>::infinity();

  double Cost() const { return diagnose::Cost(gap, one->numbers); }
};

// Where an explanation was fitted in several ways, the way that predicts best.
const RatedChoice* BestOf(const std::vector<RatedChoice>& rated, const std::string& id) {
  const RatedChoice* best = nullptr;
  for (const RatedChoice& one : rated) {
    if (one.one->id == id && (best == nullptr || one.gap < best->gap)) best = &one;
  }
  return best;
}

std::string Choice(const Contest& contest, const std::string& found, const std::string& run) {
  std::vector<RatedChoice> rated;
  for (const Evidence& one : contest.evidence) rated.push_back({&one, GapWithout(contest, one, run)});
  const RatedChoice* of_found = BestOf(rated, found);
  const auto least =
      std::min_element(rated.begin(), rated.end(),
                       [](const RatedChoice& a, const RatedChoice& b) { return a.Cost() < b.Cost(); });
  if (Material(of_found->gap, least->gap)) return least->one->id;
  for (const RatedChoice& other : rated) {
    const bool else_said = other.one->id != found;
    if (else_said && IsSimpler(*other.one, *of_found->one) && !Material(other.gap, of_found->gap))
      return other.one->id;
  }
  return found;
}

}  // namespace

std::vector<ChoiceWithout> ChoicesWithoutEach(const Contest& contest, const std::string& found) {
  std::vector<std::string> runs;
  for (const std::string& run : contest.runs) {
    if (std::find(runs.begin(), runs.end(), run) == runs.end()) runs.push_back(run);
  }
  const bool there = std::any_of(contest.evidence.begin(), contest.evidence.end(),
                                 [&](const Evidence& one) { return one.id == found; });
  if (runs.size() < kFewestInTurn || !there) return {};
  std::vector<ChoiceWithout> choices;
  for (const std::string& run : runs) {
    const std::string chosen = Choice(contest, found, run);
    choices.push_back({run, chosen, chosen == found});
  }
  return choices;
}

std::string ChoiceRemark(const std::vector<ChoiceWithout>& choices) {
  std::map<std::string, std::vector<std::string>> others;  // runs by what is chosen without them
  std::vector<std::string> runs;
  for (const ChoiceWithout& choice : choices) {
    if (choice.same) continue;
    others[choice.chosen].push_back(choice.run);
    runs.push_back(choice.run);
  }
  const std::string begin = "Each run was predicted from the others, with values that were not fitted to it";
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
