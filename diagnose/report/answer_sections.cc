// Sections with answers: what was found, how certain that is, what remains, what to measure next.
#include <algorithm>
#include <cmath>
#include <set>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/report/page_sections.h"
#include "diagnose/report/report.h"
#include "diagnose/report/report_pictures.h"
#include "diagnose/say/sentence.h"
#include "page/figure_svg.h"
#include "page/typeset.h"

namespace hydro::diagnose {
namespace {

// The effect's term over its own variable or, where it acts through time, a stretch in which it shows.
std::string PictureOf(const Diagnosis& diagnosis, const FoundEffect& effect, bool si) {
  for (const MeasuredCurve& term : diagnosis.terms) {
    if (term.element != effect.id) continue;
    return "<p class=\"lead\">What the runs lack without it, with 95 % intervals, and its own term:</p>\n" +
           page::HtmlFigure(CurveFigure(term), "the term of " + effect.id);
  }
  for (const FoundStretch& stretch : diagnosis.stretches) {
    if (stretch.effect != effect.id) continue;
    return "<p class=\"lead\">Where it shows most, in " + page::EscapeMarkup(RunNamed(stretch.run)) +
           ":</p>\n" +
           page::HtmlFigure(StretchFigure(stretch, diagnosis.model.units, si),
                            "where " + effect.id + " shows most");
  }
  return "";
}

std::string Effect(const Diagnosis& diagnosis, const FoundEffect& effect, bool si) {
  std::string out = "<h3>" + page::EscapeMarkup(effect.id) + ": " + page::TypesetHtml(effect.summary) +
                    "</h3>\n<p class=\"equation\">" + page::TypesetHtml(effect.equation) + "</p>\n";
  std::string rows;
  for (const Estimated& parameter : effect.parameters) {
    rows += "<tr>" + Cell(parameter.name) + NumberCell(parameter.value) + IntervalCell(parameter) +
            Cell(parameter.unit) + "</tr>\n";
  }
  if (!rows.empty()) out += Table({"parameter", "#value", "#95 % interval", "unit"}, rows, "narrow");
  if (!effect.names.empty()) out += "<p>" + page::EscapeMarkup(Joined(effect.names)) + "</p>\n";
  if (!effect.tied_with.empty()) {
    out += "<p class=\"flag\">These data cannot distinguish it from " +
           page::TypesetHtml(Joined(InWords(effect.tied_with))) + ".</p>\n";
  }
  return out + PictureOf(diagnosis, effect, si);
}

std::string OwnParameters(const Diagnosis& diagnosis) {
  std::string rows;
  for (const ChangedParameter& parameter : diagnosis.parameters) {
    const double change = 100 * (parameter.fitted.value / parameter.model - 1);
    rows += "<tr>" + Cell(parameter.fitted.name) + NumberCell(parameter.model) +
            NumberCell(parameter.fitted.value) + IntervalCell(parameter.fitted) +
            Cell(parameter.fitted.unit) + "<td class=\"number\">" +
            (std::isfinite(change) && change > 0 ? "+" : "") +
            (std::isfinite(change) ? ShortNumber(std::round(10 * change) / 10) + " %" : "-") + "</td><td" +
            (parameter.implausible ? " class=\"flag\">implausible" : ">") +
            (parameter.why.empty() ? ""
                                   : (parameter.implausible ? ": " : "") + page::TypesetHtml(parameter.why)) +
            "</td></tr>\n";
  }
  if (rows.empty()) return "";
  return "<h3>Other values of the model's own parameters</h3>\n" +
         Table({"parameter", "#as given", "#fitted", "#95 % interval", "unit", "#change", ""}, rows);
}

std::string Windows(const std::vector<Window>& windows) {
  constexpr size_t kShown = 6;
  std::string text;
  for (size_t i = 0; i < std::min(windows.size(), kShown); ++i) {
    text += (i > 0 ? "; " : "") + windows[i].run + ": " + ShortNumber(windows[i].from) + " to " +
            ShortNumber(windows[i].to) + " s";
  }
  if (windows.size() > kShown) text += "; " + std::to_string(windows.size() - kShown) + " more";
  return text;
}

std::string Places(const Diagnosis& diagnosis) {
  std::string rows;
  for (const Location& location : diagnosis.location) {
    rows += "<tr>" + Cell(location.balance) + PercentCell(location.share) + Cell(location.where) + "<td>" +
            page::EscapeMarkup(Windows(location.windows)) + "</td></tr>\n";
  }
  return rows.empty() ? "" : Table({"balance", "#share", "where", "when"}, rows);
}

std::string MissingTerms(const Diagnosis& diagnosis) {
  if (diagnosis.missing.empty()) return "";
  return "<p class=\"lead\">What the balance lacks, with 95 % intervals (<code>missing_terms</code> of "
         "report.json):</p>\n" +
         Curves(diagnosis.missing, "the missing term");
}

std::string GapCells(const BeforeAfter& gap) {
  return NumberCell(gap.before) + NumberCell(gap.refit_only) + NumberCell(gap.after);
}

// Whether the missing terms of an explanation are the effects that were found.
bool IsWhatWasFound(const WeightedSet& explanation, const Diagnosis& diagnosis) {
  std::set<std::string> terms, found;
  for (const std::string& change : explanation.changes) {
    const bool is_value = change.starts_with("value.") || change.starts_with("run.");
    if (!is_value) terms.insert(change.substr(0, change.find('(')));
  }
  for (const FoundEffect& effect : diagnosis.effects) found.insert(effect.id);
  const bool as_given = diagnosis.parameters.empty() && diagnosis.by_run.empty();
  if (terms.empty() && found.empty()) return explanation.changes.empty() == as_given;
  if (terms == found) return true;
  for (const Closure& closure : diagnosis.closures) found.insert(closure.id);
  return terms == found;
}

// What the weights say together. `open`: whether a significant gap is left, so that all of them may be wrong.
std::string WeightsInWords(size_t set_90, bool first_was_found, bool open) {
  if (open)
    return "A significant gap is left, so the truth may be none of these. Of what was tried, " +
           std::string(set_90 <= 1 ? "the first is" : "those that are marked are") +
           " the likeliest, nine times in ten.";
  std::string words = "By what the balances say and what held-out simulation makes of it, the truth is ";
  if (set_90 <= 1) {
    words += "the first of these nine times in ten: these runs tell it from all others.";
  } else {
    words += "among the first " + (set_90 == 2 ? "two" : std::to_string(set_90)) +
             " of these nine times in ten: these runs tell no more.";
  }
  if (first_was_found) return words;
  return words +
         " The likeliest of them is not what predicts held-out runs best, and that is what counts: see "
         "what was found.";
}

// Of exact sensors, a hundredth of what was missing may be left, which is more than their noise.
std::string NothingBut(const ComparedGap& gap) {
  return gap.gap.after < 2 ? "Nothing but noise: " : "Next to nothing: ";
}

}  // namespace

std::string WhatWasFound(const Diagnosis& diagnosis, bool si) {
  std::string out;
  for (const FoundEffect& effect : diagnosis.effects) out += Effect(diagnosis, effect, si);
  out += OwnParameters(diagnosis);
  if (!diagnosis.by_run.empty())
    out += "<p>" + page::TypesetHtml(Enumerated(diagnosis.by_run)) +
           ", with a value of its own for each run (see what differs from run to run).</p>\n";
  if (!out.empty()) return out;
  if (!diagnosis.unsure.empty())
    return "<p>No effect was added to the model. Other values of " +
           page::TypesetHtml(Enumerated(diagnosis.unsure)) +
           " stand in model.toml, which these runs do not show to differ from those given (see the "
           "remarks).</p>\n";
  return "<p>Nothing was added to the model, and none of its values was changed.</p>\n";
}

std::string HowSure(const Diagnosis& diagnosis) {
  std::string effects;
  for (const FoundEffect& effect : diagnosis.effects) {
    effects += "<tr>" + Cell(effect.id) + PercentCell(effect.weight) + PercentCell(effect.share) +
               Cell(effect.tied_with.empty() ? "nothing" : Joined(InWords(effect.tied_with))) + "</tr>\n";
  }
  if (effects.empty()) return "";
  return Table({"effect", "#weight", "#share of the gap", "cannot be told from"}, effects, "narrow") +
         "<p>The weight says how likely an effect is: the mean of what the balances say and of what held-out "
         "simulation "
         "makes of it. The share says how much it does: the part of the held-out squared gap that comes back "
         "without it. An effect may be "
         "certain and do little.</p>\n";
}

std::string WhatMayExplain(const Diagnosis& diagnosis) {
  constexpr double kWorthARow = 0.005;
  constexpr size_t kMostRows = 8;
  std::string rows;
  bool marked = false, first_was_found = false;
  for (size_t i = 0; i < diagnosis.explanations.size(); ++i) {
    const WeightedSet& one = diagnosis.explanations[i];
    const bool in_90 = i < diagnosis.set_90;
    if (!in_90 && (i >= kMostRows || one.weight < kWorthARow)) break;
    const bool found = !marked && IsWhatWasFound(one, diagnosis);
    marked = marked || found;
    first_was_found = first_was_found || (found && i == 0);
    rows += std::string(in_90 ? "<tr class=\"taken\">" : "<tr>") + Cell(InWords(one)) +
            PercentCell(one.weight) + Cell(in_90 ? "yes" : "") + Cell(found ? "what was found" : "") +
            "</tr>\n";
  }
  if (rows.empty()) return "";
  return "<p>" + WeightsInWords(diagnosis.set_90, first_was_found, IsOpen(diagnosis.verdict)) + "</p>\n" +
         Table({"explanation", "#weight", "one of these, nine times in ten", ""}, rows, "narrow") +
         "<p>Each weight is the mean of two: what the balances say before anything is simulated, and what "
         "the simulation of "
         "held-out runs makes of it. They add to 100 %, and "
         "compare what was tried, and nothing else.</p>\n";
}

// Which of two means is which: that of the verdict is not one of the table.
std::string TypicalInWords(const Diagnosis& diagnosis) {
  const ComparedGap& compared = diagnosis.compared;
  if (!(compared.seconds > 0) || diagnosis.horizons.empty()) return "";
  return " The " + std::string(compared.of_fitted ? "fitted" : "held-out") + " gap in the verdict, " +
         ShortNumber(compared.gap.before, 3) + " to " + ShortNumber(compared.gap.after, 3) + " over " +
         ShortNumber(compared.seconds, 2) +
         " s, is the typical one: the geometric mean of the windows' gaps, which a few windows that no model "
         "follows do not decide. The table has root mean squares, which they do.";
}

std::string HowMuchOfTheGap(const Diagnosis& diagnosis) {
  std::string rows;
  for (const HorizonGap& horizon : diagnosis.horizons) {
    rows += "<tr><td class=\"number\">" + ShortNumber(horizon.seconds, 2) + " s</td>" +
            GapCells(horizon.held_out) + GapCells(horizon.fit) + "</tr>\n";
  }
  rows += "<tr class=\"all\"><td class=\"number\">whole runs</td>" + GapCells(diagnosis.held_out) +
          GapCells(diagnosis.fit) + "</tr>\n";
  const std::string choices =
      diagnosis.choices.empty() ? "" : "<p>" + page::TypesetHtml(ChoiceRemark(diagnosis)) + ".</p>\n";
  return "<p>Root-mean-square differences between predictions and measurements, in standard deviations of "
         "the noise: 1 is the noise floor. Each prediction reaches that far from a start of its own. "
         "<i>Before</i>: "
         "the model as given; <i>refitted</i>: its own values refitted, nothing added; <i>after</i>: with "
         "what was "
         "found. Dashed: the fitted runs." +
         TypicalInWords(diagnosis) + "</p>\n" +
         (diagnosis.horizons.empty()
              ? ""
              : page::HtmlFigure(HorizonFigure(diagnosis), "the gap at each horizon")) +
         Table({"#predicted over", "#held out: before", "#refitted", "#after", "#fitted: before", "#refitted",
                "#after"},
               rows) +
         choices;
}

std::string WhatRemains(const Diagnosis& diagnosis) {
  const ComparedGap& gap = diagnosis.compared;
  if (!std::isfinite(gap.gap.after)) return Places(diagnosis) + MissingTerms(diagnosis);
  const std::string left =
      ShortNumber(gap.gap.after, 3) + " noise units" + (IsOpen(diagnosis.verdict) ? " remain" : "") +
      " on the " + (gap.of_fitted ? "fitted" : "held-out") + " runs" +
      (gap.seconds > 0 ? ", predicted over " + ShortNumber(gap.seconds, 2) + " s" : "") + ".";
  if (diagnosis.verdict == Verdict::kNothingMissing) return "<p>" + NothingBut(gap) + left + "</p>\n";
  const std::string places = Places(diagnosis);
  std::string where;
  if (!places.empty() && IsOpen(diagnosis.verdict))
    where = " This is where, with what was found in the model:";
  if (!places.empty() && !IsOpen(diagnosis.verdict)) where = " This is where the model as given disagrees:";
  if (places.empty() && IsOpen(diagnosis.verdict)) where = " No balance shows where.";
  return "<p>" + (IsOpen(diagnosis.verdict) ? "" : NothingBut(gap)) + left + where + "</p>\n" + places +
         MissingTerms(diagnosis);
}

std::string WhatToMeasureNext(const Diagnosis& diagnosis) {
  const NextExperiment& next = diagnosis.next;
  if (next.why.empty()) return "";
  std::string out = "<p>" + page::TypesetHtml(next.why) + "</p>\n";
  if (next.expected_separation > 0) {
    out += "<p>The refitted models are expected to differ by " + ShortNumber(next.expected_separation) +
           " noise units in it.</p>\n";
  }
  if (next.config.empty()) {
    out += "<p>No trial within what the rig has done tells them apart.</p>\n";
  } else {
    out += "<p>As <code>next.toml</code>:</p>\n<pre>" + Lines(next.config) + "</pre>\n";
  }
  return out;
}

}  // namespace hydro::diagnose
