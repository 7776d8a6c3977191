#include "diagnose/report/report_html.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/data/run_data.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/report_json.h"
#include "diagnose/report/report_pictures.h"
#include "page/figure_svg.h"
#include "page/html_page.h"
#include "page/typeset.h"
#include "settings/command_line.h"
#include "settings/model_file.h"

namespace hydro::diagnose {
namespace {

std::string Cell(const std::string& text) { return "<td>" + page::TypesetHtml(text) + "</td>"; }
std::string NumberCell(double value) { return "<td class=\"number\">" + ShortNumber(value) + "</td>"; }

std::string Probability(double p) { return "<td class=\"number\">" + ShortNumber(p, 2) + "</td>"; }

// Columns whose names begin with '#' hold numbers.
std::string Table(const std::vector<std::string>& columns, const std::string& rows,
                  const std::string& style = "") {
  std::string out =
      "<div class=\"table\"><table" + (style.empty() ? "" : " class=\"" + style + "\"") + ">\n<thead><tr>";
  for (const std::string& column : columns) {
    const bool number = column.starts_with('#');
    out += (number ? "<th class=\"number\">" : "<th>") +
           page::TypesetHtml(number ? column.substr(1) : column) + "</th>";
  }
  return out + "</tr></thead>\n<tbody>\n" + rows + "</tbody>\n</table></div>\n";
}

std::string Section(const std::string& heading, const std::string& content) {
  return content.empty() ? "" : "<h2>" + heading + "</h2>\n" + content;
}

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

std::string Interval(const Estimated& estimated) {
  return "<td class=\"number\">" + ShortNumber(estimated.low) + " to " + ShortNumber(estimated.high) +
         "</td>";
}

std::string Effects(const Diagnosis& diagnosis) {
  std::string out;
  for (const FoundEffect& effect : diagnosis.effects) {
    out += "<h3>" + page::EscapeMarkup(effect.id) + ": " + page::TypesetHtml(effect.summary) +
           "</h3>\n<p class=\"equation\">" + page::TypesetHtml(effect.equation) + "</p>\n";
    std::string rows;
    for (const Estimated& parameter : effect.parameters) {
      rows += "<tr>" + Cell(parameter.name) + NumberCell(parameter.value) + Interval(parameter) +
              Cell(parameter.unit) + "</tr>\n";
    }
    if (!rows.empty()) out += Table({"parameter", "#value", "#95 % interval", "unit"}, rows, "narrow");
    if (!effect.names.empty()) out += "<p>" + page::EscapeMarkup(Joined(effect.names)) + "</p>\n";
    if (!effect.tied_with.empty()) {
      out += "<p class=\"flag\">These data cannot distinguish it from " +
             page::EscapeMarkup(Joined(effect.tied_with)) + ".</p>\n";
    }
  }
  return out;
}

std::string OwnParameters(const Diagnosis& diagnosis) {
  std::string rows;
  for (const ChangedParameter& parameter : diagnosis.parameters) {
    const double change = 100 * (parameter.fitted.value / parameter.model - 1);
    rows += "<tr>" + Cell(parameter.fitted.name) + NumberCell(parameter.model) +
            NumberCell(parameter.fitted.value) + Interval(parameter.fitted) + Cell(parameter.fitted.unit) +
            "<td class=\"number\">" + (std::isfinite(change) && change > 0 ? "+" : "") +
            (std::isfinite(change) ? ShortNumber(std::round(10 * change) / 10) + " %" : "-") + "</td><td" +
            (parameter.implausible ? " class=\"flag\">implausible" : ">") +
            (parameter.why.empty() ? ""
                                   : (parameter.implausible ? ": " : "") + page::TypesetHtml(parameter.why)) +
            "</td></tr>\n";
  }
  if (rows.empty()) return "";
  return Table({"parameter", "#as given", "#fitted", "#95 % interval", "unit", "#change", ""}, rows);
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

std::string Where(const Diagnosis& diagnosis) {
  std::string rows;
  for (const Location& location : diagnosis.location) {
    rows += "<tr>" + Cell(location.balance) + "<td class=\"number\">" +
            ShortNumber(std::round(100 * location.share)) + " %</td>" + Cell(location.where) + "<td>" +
            page::EscapeMarkup(Windows(location.windows)) + "</td></tr>\n";
  }
  std::string out;
  if (!rows.empty()) out = Table({"balance", "#share", "where", "when"}, rows);
  for (const MissingTerm& term : diagnosis.missing) {
    std::string bins;
    for (size_t i = 0; i < std::min({term.at.size(), term.mean.size(), term.error.size()}); ++i) {
      bins +=
          "<tr>" + NumberCell(term.at[i]) + NumberCell(term.mean[i]) + NumberCell(term.error[i]) + "</tr>\n";
    }
    const std::string unit = term.against_unit.empty() ? "" : " (" + term.against_unit + ")";
    out += "<p class=\"lead\">What the balance lacks, with its 95 % interval:</p>\n<div class=\"beside\">\n" +
           page::HtmlFigure(MissingTermFigure(term), "the missing term") +
           Table({"#" + term.against + unit, "#mean (" + term.unit + ")", "#standard error"}, bins,
                 "narrow small") +
           "</div>\n";
  }
  return out;
}

// Escaped text that keeps its line breaks.
std::string Lines(const std::string& text) {
  std::string out, line;
  for (const char c : text) {
    if (c == '\n') {
      out += page::EscapeMarkup(line) + "\n";
      line.clear();
    } else {
      line += c;
    }
  }
  return out + page::EscapeMarkup(line);
}

std::string Next(const Diagnosis& diagnosis) {
  const NextExperiment& next = diagnosis.next;
  if (next.why.empty()) return "";
  std::string out = "<p>" + page::TypesetHtml(next.why) + "</p>\n";
  if (next.expected_separation > 0) {
    out += "<p>The refitted models are expected to differ by " + ShortNumber(next.expected_separation) +
           " noise units in it.</p>\n";
  }
  if (!next.config.empty()) {
    out += "<p>As <code>next.toml</code>:</p>\n<pre>" + Lines(next.config) + "</pre>\n";
  }
  return out;
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
            NumberCell(candidate.fit) + NumberCell(candidate.held_out) + Probability(candidate.p_value) +
            Probability(candidate.weight) + "<td>" +
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
                        Head(diagnosis) + Section("The gap", GapTable(diagnosis, si)) +
                            Section("What was found", Effects(diagnosis)) +
                            Section("The model's own parameters", OwnParameters(diagnosis)) +
                            Section("Remarks", Remarks(diagnosis)) +
                            Section("Where model and data disagree", Where(diagnosis)) +
                            Section("The next experiment", Next(diagnosis)) +
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
