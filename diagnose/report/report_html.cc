// report.html.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/page_sections.h"
#include "diagnose/report/report.h"
#include "diagnose/report/report_pictures.h"
#include "diagnose/say/sentence.h"
#include "page/figure_svg.h"
#include "page/html_page.h"
#include "page/typeset.h"
#include "settings/command_line.h"
#include "settings/model_file.h"

namespace hydro::diagnose {
namespace {

// A model need not have a name.
std::string TitleOf(const Diagnosis& diagnosis) {
  return diagnosis.model.name.empty() ? "Gap report" : "Gap report: " + diagnosis.model.name;
}

// A section; "" without content. On paper it stays whole where it fits on a page.
std::string Section(const std::string& heading, const std::string& content, const char* kind = "part") {
  return content.empty() ? ""
                         : std::string("<section class=\"") + kind + "\">\n<h2>" + heading + "</h2>\n" +
                               content + "</section>\n";
}

std::string Plural(size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

// The verdict's first sentence, and the text after it. The gap in brackets at the end of the sentence is
// stated below it.
std::pair<std::string, std::string> FirstSentence(const std::string& sentence) {
  size_t end = sentence.find(". ");
  while (end != std::string::npos &&
         (end + 2 >= sentence.size() || sentence[end + 2] < 'A' || sentence[end + 2] > 'Z'))
    end = sentence.find(". ", end + 2);
  std::string first = sentence.substr(0, end == std::string::npos ? end : end + 1);
  const std::string rest = end == std::string::npos ? "" : sentence.substr(end + 2);
  for (const char* gap : {" (held-out gap ", " (the held-out gap ", " (gap ", " (the gap "}) {
    const size_t at = first.find(gap);
    if (at != std::string::npos && first.ends_with(").")) first = first.substr(0, at) + ".";
  }
  return {first, rest};
}

// How far the model is off, before and after, in the gap that the sentence states.
std::string GapInWords(const Diagnosis& diagnosis) {
  const ComparedGap& compared = diagnosis.compared;
  const BeforeAfter& gap = compared.gap;
  if (!std::isfinite(gap.before) || !std::isfinite(gap.after) || gap.before == 0) return "";
  const std::string on = compared.of_fitted      ? "On the runs that it was fitted to"
                         : diagnosis.half_fitted ? "On runs of which it was fitted to half"
                                                 : "On runs that it was not fitted to";
  return on + (compared.seconds > 0 ? ", predicted over " + ShortNumber(compared.seconds, 2) + " s," : "") +
         " the model as given is off by " + ShortNumber(gap.before, 3) + " times the noise of the sensors" +
         (diagnosis.verdict == Verdict::kNothingMissing
              ? ""
              : ", with what was found by " + ShortNumber(gap.after, 3) + " times") +
         "; at 1 nothing but noise is left.";
}

std::string Head(const Diagnosis& diagnosis) {
  std::string meta = Plural(diagnosis.runs.size(), "run") + " (" + Joined(diagnosis.runs) + "), " +
                     std::to_string(diagnosis.samples) + " samples; ";
  meta += diagnosis.held_out_runs.empty()
              ? (diagnosis.half_fitted ? "half of each fitted, and the other half held out."
                                       : "each held out in turn.")
              : "held out, and not fitted: " + Joined(diagnosis.held_out_runs) + ".";
  std::string verdict = VerdictName(diagnosis.verdict);
  const bool open = IsOpen(diagnosis.verdict);
  std::ranges::replace(verdict, '_', ' ');
  const auto [first, rest] = FirstSentence(diagnosis.sentence);
  const std::string gap = GapInWords(diagnosis);
  return "<h1>" + page::TypesetHtml(first) + "</h1>\n<p class=\"verdict" + (open ? " unexplained" : "") +
         "\"><span class=\"badge\">" + verdict + "</span>\n" + page::TypesetHtml(rest) +
         (rest.empty() || gap.empty() ? "" : " ") + page::EscapeMarkup(gap) + "</p>\n<p class=\"meta\">" +
         page::EscapeMarkup(TitleOf(diagnosis)) + ". " + page::EscapeMarkup(meta) + "</p>\n";
}

std::string GapTable(const Diagnosis& diagnosis, bool si) {
  const auto cells = [](const BeforeAfter& gap, double factor) {
    return NumberCell(gap.before * factor) + NumberCell(gap.refit_only * factor) +
           NumberCell(gap.after * factor);
  };
  std::string rows = "<tr class=\"all\"><td>all signals</td><td class=\"unit\">noise</td>" + NumberCell(1) +
                     cells(diagnosis.fit, 1) + cells(diagnosis.held_out, 1) + "</tr>\n";
  for (const SignalGap& signal : diagnosis.signals) {
    const ShownUnit unit = UnitOf(signal.channel, diagnosis.model.units, si);
    rows += "<tr>" + Cell(ChannelName(signal.channel)) + "<td class=\"unit\">" + unit.unit + "</td>" +
            NumberCell(signal.noise * unit.factor) + cells(signal.fit, unit.factor) +
            cells(signal.held_out, unit.factor) + "</tr>\n";
  }
  return "<p>Root-mean-square residuals. <i>Before</i>: the model as given; <i>refitted</i>: its own "
         "parameters refitted, nothing added; <i>after</i>: with what was found. In noise units, 1 is the "
         "noise floor.</p>\n" +
         Table({"signal", "unit", "#noise", "#fitted: before", "#refitted", "#after", "#held out: before",
                "#refitted", "#after"},
               rows);
}

std::string Runs(const Diagnosis& diagnosis, bool si) {
  std::string out;
  for (const RunCurves& run : diagnosis.curves) {
    if (out.empty()) out = "<p>To the right the differences: measured less predicted.</p>\n";
    const std::optional<page::Figure> figure = RunFigure(diagnosis, run, si);
    if (!figure) continue;
    out += "<h3>" + page::EscapeMarkup(run.run) +
           (run.held_out && !diagnosis.half_fitted
                ? " <span class=\"meta\">held out: <i>after</i> is a model that was not fitted to it</span>"
                : "") +
           "</h3>\n" + page::HtmlFigure(*figure, "measured and simulated signals of " + run.run);
  }
  return out;
}

// Whether no simulation tried the candidate, because the balances did not propose it.
bool IsUntried(const Candidate& candidate) {
  return std::isnan(candidate.held_out) && candidate.weight == 0 &&
         candidate.rejected_because == kNotProposed;
}

std::string Ranking(const Diagnosis& diagnosis) {
  std::string rows;
  std::vector<std::string> untried;
  size_t rank = 0;
  for (const Candidate& candidate : diagnosis.candidates) {
    if (IsUntried(candidate)) {
      untried.push_back(candidate.id);
      continue;
    }
    const bool taken = candidate.rejected_because.empty();
    rows += std::string(taken ? "<tr class=\"taken\">" : "<tr>") + "<td class=\"number\">" +
            std::to_string(++rank) + "</td>" + Cell(candidate.id) + NumberCell(candidate.score) +
            NumberCell(candidate.held_out) + ShortCell(candidate.p_value) + ShortCell(candidate.weight) +
            "<td>" + (taken ? "taken" : page::TypesetHtml(candidate.rejected_because)) + "</td></tr>\n";
  }
  std::string out;
  if (!rows.empty()) {
    out =
        "<p>The score is what the balances say of a candidate beyond what they say of nothing, in nats, "
        "before "
        "anything is simulated; the weight compares all of them. Gaps are in noise units, of short "
        "predictions "
        "where these decide, else over whole runs. p is the probability that noise alone achieves as much, "
        "corrected for the number of candidates.</p>\n" +
        Table({"#", "candidate", "#score", "#held out", "#p", "#weight", "rejected because"}, rows);
  }
  if (!untried.empty()) {
    out += "<p>The balances of the runs gave no reason to simulate these alone: " +
           page::TypesetHtml(Joined(untried)) + ".</p>\n";
  }
  return out;
}

std::string Remarks(const Diagnosis& diagnosis) {
  std::string items;
  for (const Unjudged& one : diagnosis.unjudged)
    items += "<li>" + page::TypesetHtml(UnjudgedText(one)) + ".</li>\n";
  // The choice of the runs is described beside the gaps.
  const std::string choice = diagnosis.choices.empty() ? "" : ChoiceRemark(diagnosis);
  for (const std::string& remark : diagnosis.remarks) {
    if (remark != choice) items += "<li>" + page::TypesetHtml(remark) + "</li>\n";
  }
  return items.empty() ? "" : "<ul>\n" + items + "</ul>\n";
}

}  // namespace

std::string ReportHtml(const Diagnosis& given, bool si, const std::string& model_toml) {
  const Diagnosis diagnosis = si ? InSi(given) : given;
  return page::HtmlPage(
      TitleOf(diagnosis),
      Head(diagnosis) + Section("What was found", WhatWasFound(diagnosis, si)) +
          Section("What the balances measure of the machine", MeasuredSection(diagnosis)) +
          Section("How sure that is", HowSure(diagnosis)) +
          Section("What may explain the runs", WhatMayExplain(diagnosis)) +
          Section("How much of the gap it takes", HowMuchOfTheGap(diagnosis)) +
          Section("What remains, and where", WhatRemains(diagnosis)) +
          Section("What no known effect explains", ClosureSection(diagnosis)) +
          Section("What differs from run to run", PerRunSection(diagnosis)) +
          Section("What to measure next", WhatToMeasureNext(diagnosis)) +
          Section("Remarks", Remarks(diagnosis)) +
          // On paper the details begin on a page of their own, so that the answer can be printed alone.
          Section("The gap by signal", GapTable(diagnosis, si), "part details") +
          Section("Measurements, and the model before and after", Runs(diagnosis, si)) +
          Section("Every candidate, and why it was rejected", Ranking(diagnosis)) +
          Section("The model with what was found",
                  "<p>As <code>model.toml</code>:</p>\n<pre>" +
                      Lines(model_toml.empty() ? settings::FormatModel(diagnosis.model) : model_toml) +
                      "</pre>\n") +
          "<p class=\"meta\">hydro-diagnose " + page::EscapeMarkup(settings::ProgramVersion()) +
          "; the numbers are in report.json.</p>\n");
}

}  // namespace hydro::diagnose
