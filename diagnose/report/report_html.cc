#include "diagnose/report/report_html.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/data/run_data.h"
#include "diagnose/report/answer_sections.h"
#include "diagnose/report/closure_section.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/html_parts.h"
#include "diagnose/report/per_run_section.h"
#include "diagnose/report/report_json.h"
#include "diagnose/report/report_pictures.h"
#include "page/figure_svg.h"
#include "page/html_page.h"
#include "page/typeset.h"
#include "settings/command_line.h"
#include "settings/model_file.h"

namespace hydro::diagnose {
namespace {

std::string Plural(size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string Head(const Diagnosis& diagnosis) {
  std::string meta = Plural(diagnosis.runs.size(), "run") + " (" + Joined(diagnosis.runs) + "), " +
                     std::to_string(diagnosis.samples) + " samples; ";
  meta += diagnosis.held_out_runs.empty()
              ? "each held out in turn."
              : "held out, and not fitted: " + Joined(diagnosis.held_out_runs) + ".";
  std::string verdict = VerdictName(diagnosis.verdict);
  const bool open = IsOpen(diagnosis.verdict);
  std::replace(verdict.begin(), verdict.end(), '_', ' ');
  return "<h1>" + page::EscapeMarkup("Gap report: " + diagnosis.model.name) + "</h1>\n<p class=\"meta\">" +
         page::EscapeMarkup(meta) + "</p>\n<p class=\"verdict" + (open ? " unexplained" : "") +
         "\"><span class=\"badge\">" + verdict + "</span>\n" + page::TypesetHtml(diagnosis.sentence) +
         "</p>\n";
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
               rows) +
         page::HtmlFigure(GapFigure(diagnosis), "the gap before and after");
}

std::string Runs(const Diagnosis& diagnosis, bool si) {
  std::string out;
  for (const RunCurves& run : diagnosis.curves) {
    const std::optional<page::Figure> figure = RunFigure(diagnosis, run, si);
    if (!figure) continue;
    out += "<h3>" + page::EscapeMarkup(run.run) +
           (run.held_out
                ? " <span class=\"meta\">held out: <i>after</i> is a model that was not fitted to it</span>"
                : "") +
           "</h3>\n" + page::HtmlFigure(*figure, "measured and simulated signals of " + run.run);
  }
  return out;
}

std::string Dependence(const Diagnosis& diagnosis, bool si) {
  const std::optional<page::Figure> figure = DependenceFigure(diagnosis, si);
  return figure ? page::HtmlFigure(*figure, "residuals against what they may depend on") : "";
}

std::string Ranking(const Diagnosis& diagnosis) {
  std::string rows;
  size_t rank = 0;
  for (const Candidate& candidate : diagnosis.candidates) {
    const bool taken = candidate.rejected_because.empty();
    rows += std::string(taken ? "<tr class=\"taken\">" : "<tr>") + "<td class=\"number\">" +
            std::to_string(++rank) + "</td>" + Cell(candidate.id) + NumberCell(candidate.score) +
            NumberCell(candidate.fit) + NumberCell(candidate.held_out) + ShortCell(candidate.p_value) +
            ShortCell(candidate.weight) + "<td>" +
            (taken ? "taken" : page::TypesetHtml(candidate.rejected_because)) + "</td></tr>\n";
  }
  if (rows.empty()) return "";
  return "<p>Gaps are in noise units, with the candidate added and all parameters refitted. The score is the "
         "drop in the squared gap that the score test predicts before any refit. p is the probability that "
         "noise alone achieves as much, corrected for the number of candidates. <i>-</i>: not tried, because "
         "the score is too low.</p>\n" +
         Table({"#", "candidate", "#score", "#fitted", "#held out", "#p", "#weight", "rejected because"},
               rows);
}

std::string Remarks(const Diagnosis& diagnosis) {
  std::string items;
  for (const std::string& remark : diagnosis.remarks) items += "<li>" + page::TypesetHtml(remark) + "</li>\n";
  return items.empty() ? "" : "<ul>\n" + items + "</ul>\n";
}

}  // namespace

std::string ReportHtml(const Diagnosis& given, bool si) {
  const Diagnosis diagnosis = si ? InSi(given) : given;
  return page::HtmlPage("Gap report: " + diagnosis.model.name,
                        Head(diagnosis) + Section("What was found", WhatWasFound(diagnosis, si)) +
                            Section("How sure that is", HowSure(diagnosis)) +
                            Section("How much of the gap it takes", HowMuchOfTheGap(diagnosis)) +
                            Section("What remains, and where", WhatRemains(diagnosis)) +
                            Section("What no known effect explains", ClosureSection(diagnosis)) +
                            Section("What differs from run to run", PerRunSection(diagnosis)) +
                            Section("What to measure next", WhatToMeasureNext(diagnosis)) +
                            Section("Remarks on the recordings", Remarks(diagnosis)) +
                            Section("The gap by signal", GapTable(diagnosis, si)) +
                            Section("Measurements, and the model before and after", Runs(diagnosis, si)) +
                            Section("Residuals against what they may depend on", Dependence(diagnosis, si)) +
                            Section("Every candidate, and why it was rejected", Ranking(diagnosis)) +
                            Section("The model with what was found",
                                    "<p>As <code>model.toml</code>:</p>\n<pre>" +
                                        Lines(settings::FormatModel(diagnosis.model)) + "</pre>\n") +
                            "<p class=\"meta\">hydro-diagnose " +
                            page::EscapeMarkup(settings::ProgramVersion()) +
                            "; the numbers are in report.json.</p>\n");
}

}  // namespace hydro::diagnose
