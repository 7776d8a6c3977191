#include "experiments/report/report.h"

#include <algorithm>
#include <cmath>

#include "experiments/report/comparison_text.h"
#include "page/typeset.h"
#include "settings/command_line.h"

namespace hydro::experiments {
namespace {

constexpr char kStyle[] = R"css(
:root { color-scheme: light; }
body { margin: 0 auto; padding: 2.5rem 1.5rem 4rem; max-width: 60rem; color: #1a1a1a; background: #ffffff;
  font: 1rem/1.5 Charter, "Bitstream Charter", Georgia, "Times New Roman", serif; }
h1, h2, h3, th, nav, .meta, .status { font-family: Helvetica, Arial, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .4rem; }
h2 { font-size: 1.2rem; margin: 3rem 0 .8rem; padding-top: .8rem; border-top: 1px solid #9a9a9a; }
h3 { font-size: .95rem; margin: 1.2rem 0 .3rem; color: #333333; }
p { margin: .3rem 0 .7rem; }
.meta { color: #555555; font-size: .85rem; }
.meta code { font-size: .85rem; }
nav ol { columns: 2; column-gap: 2rem; font-size: .88rem; line-height: 1.45; padding-left: 1.4rem; }
nav li { break-inside: avoid; }
a { color: #0b3c6f; text-decoration: none; }
a:hover { text-decoration: underline; }
figure { margin: 1rem 0 1.4rem; break-inside: avoid; }
figure svg { display: block; max-width: 100%; height: auto; margin: 0 auto; }
table { border-collapse: collapse; width: 100%; font-size: .86rem; line-height: 1.35; margin: .4rem 0 1rem; }
thead { display: table-header-group; }
th { text-align: left; font-size: .78rem; color: #333333; border-bottom: 1.5px solid #333333; padding: .3rem .6rem .3rem 0; }
td { vertical-align: top; border-bottom: 1px solid #dcdcdc; padding: .3rem .6rem .3rem 0; }
tr { break-inside: avoid; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.remark { color: #444444; width: 34%; }
td.unit { white-space: nowrap; }
.comparisons th:first-child { width: 25%; }
.failed { border-left: 4px solid #b3261e; padding: .4rem .8rem; background: #fbecea; }
.finding { border-left: 4px solid #dd6b00; padding: .1rem .8rem; margin: .6rem 0; }
sub, sup { line-height: 0; font-size: .72em; }
@media print {
  body { max-width: none; padding: 0; font-size: 10pt; }
  h2 { break-after: avoid; break-inside: avoid; margin-top: 1.6rem; }
  h3 { break-after: avoid; }
  a { color: inherit; }
  @page { size: A4; margin: 16mm 15mm; }
}
)css";

std::string Paragraph(const std::string& heading, const std::string& text) {
  if (text.empty()) return "";
  return "<h3>" + page::EscapeMarkup(heading) + "</h3>\n<p>" + page::TypesetHtml(text) + "</p>\n";
}

std::string Shown(double value) { return std::isfinite(value) ? ShownNumber(value) : "–"; }

std::string ComparisonTable(const std::vector<Comparison>& comparisons, bool si) {
  if (comparisons.empty()) return "";
  std::string out =
      "<table class=\"comparisons\">\n<thead><tr><th>quantity</th><th>the paper</th><th "
      "class=\"number\">independent</th><th class=\"number\">this "
      "run</th><th>unit</th><th>remark</th></tr></thead>\n<tbody>\n";
  for (const Comparison& row : si ? InSi(comparisons) : comparisons) {
    out += "<tr><td>" + page::TypesetHtml(row.quantity) + "</td><td>" +
           (row.paper.empty() ? "–" : page::TypesetHtml(row.paper)) + "</td><td class=\"number\">" +
           Shown(row.expected) + "</td><td class=\"number\">" + Shown(row.here) + "</td><td class=\"unit\">" +
           page::TypesetHtml(row.unit) + "</td><td class=\"remark\">" + page::TypesetHtml(row.remark) +
           "</td></tr>\n";
  }
  return out + "</tbody>\n</table>\n";
}

// Without what stands before the element: an XML declaration has no place in HTML.
std::string Inline(const std::string& svg) {
  const size_t begin = svg.find("<svg");
  return begin == std::string::npos ? "" : svg.substr(begin);
}

std::string Section(const ReportEntry& entry, bool si) {
  const Experiment& experiment = entry.experiment;
  std::string out = "<section id=\"" + page::EscapeMarkup(experiment.name) + "\">\n<h2>" +
                    page::TypesetHtml(experiment.title) + "</h2>\n";
  if (!entry.result) {
    return out + "<p class=\"failed\"><b>This experiment failed:</b> " + page::EscapeMarkup(entry.failure) +
           "</p>\n</section>\n";
  }
  for (const RenderedPicture& picture : entry.pictures) {
    out += "<figure id=\"picture-" + page::EscapeMarkup(picture.name) + "\">\n" + Inline(picture.svg) +
           "</figure>\n";
  }
  const ExperimentResult& result = *entry.result;
  out += Paragraph("Conditions", result.conditions);
  out += Paragraph("What the paper says", result.paper_says);
  if (!result.comparisons.empty()) out += "<h3>What we get</h3>\n" + ComparisonTable(result.comparisons, si);
  out += Paragraph("Why they differ, or do not", result.explanation);
  for (const Finding& finding : result.findings) {
    const std::string number = std::to_string(finding.number);
    out += "<div class=\"finding\"><p><a href=\"#findings\"><b>Finding " + number + ".</b></a> " +
           page::TypesetHtml(finding.evidence) + "</p></div>\n";
  }
  return out + "<p class=\"meta\">Data: " + page::EscapeMarkup(experiment.name) +
         ".csv, numbers: " + page::EscapeMarkup(experiment.name) + ".json</p>\n</section>\n";
}

std::string FindingsTable(const std::vector<ReportEntry>& entries) {
  std::string out =
      "<section id=\"findings\">\n<h2>Where the paper contradicts itself or leaves something open</h2>\n"
      "<p>Nothing of this is patched silently: each is shown by a run, with what the project does about "
      "it.</p>\n"
      "<table>\n<thead><tr><th class=\"number\">no.</th><th>the paper</th><th>evidence from these runs</th>"
      "<th>what the project does</th><th>where</th></tr></thead>\n<tbody>\n";
  const std::vector<int> missing = MissingFindings(entries);
  for (int number = 1; number <= kFindings; ++number) {
    const std::string first = "<tr><td class=\"number\">" + std::to_string(number) + "</td>";
    if (std::find(missing.begin(), missing.end(), number) != missing.end()) {
      out += first +
             "<td colspan=\"4\" class=\"failed\">no experiment gave evidence for it in this run</td></tr>\n";
    }
    for (const ReportEntry& entry : entries) {
      if (!entry.result) continue;
      for (const Finding& finding : entry.result->findings) {
        if (finding.number != number) continue;
        out += first + "<td>" + page::TypesetHtml(finding.paper) + "</td><td>" +
               page::TypesetHtml(finding.evidence) + "</td><td>" + page::TypesetHtml(finding.treatment) +
               "</td><td><a href=\"#" + page::EscapeMarkup(entry.experiment.name) + "\">" +
               page::EscapeMarkup(entry.experiment.name) + "</a></td></tr>\n";
      }
    }
  }
  return out + "</tbody>\n</table>\n</section>\n";
}

std::string Command(const ExperimentRequest& request) {
  std::string command = "hydro-experiment " + request.name;
  if (request.options.seed != ExperimentOptions{}.seed) {
    command += " --seed " + std::to_string(request.options.seed);
  }
  if (request.options.noise) command += " --noise";
  if (request.real_time) command += " --real-time";
  if (request.si) command += " --si";
  return command;
}

}  // namespace

std::vector<int> MissingFindings(const std::vector<ReportEntry>& entries) {
  std::vector<int> missing;
  for (int number = 1; number <= kFindings; ++number) {
    const bool there = std::any_of(entries.begin(), entries.end(), [number](const ReportEntry& entry) {
      return entry.result &&
             std::any_of(entry.result->findings.begin(), entry.result->findings.end(),
                         [number](const Finding& f) { return f.number == number && !f.evidence.empty(); });
    });
    if (!there) missing.push_back(number);
  }
  return missing;
}

std::string ReportHtml(const std::vector<ReportEntry>& entries, const ExperimentRequest& request) {
  std::string contents;
  std::string sections;
  std::string failed;
  for (const ReportEntry& entry : entries) {
    const std::string& name = entry.experiment.name;
    contents += "<li><a href=\"#" + page::EscapeMarkup(name) + "\">" +
                page::TypesetHtml(entry.experiment.title) + "</a>" + (entry.result ? "" : " (failed)") +
                "</li>\n";
    sections += Section(entry, request.si);
    if (!entry.result) failed += (failed.empty() ? "" : ", ") + name;
  }
  return std::string("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n") +
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<title>A hydrostatic actuator: the paper's experiments, reproduced</title>\n<style>" +
         kStyle +
         "</style>\n</head>\n<body>\n<header>\n"
         "<h1>A hydrostatic actuator: the paper's experiments, reproduced</h1>\n"
         "<p class=\"meta\">After <i>Modeling and Analysis of a High-Torque, Hydrostatic Actuator for "
         "Robotic "
         "Applications</i>; equation, figure and table numbers are the paper's. Made by <code>" +
         page::EscapeMarkup(Command(request)) + "</code>, hydro " +
         page::EscapeMarkup(settings::ProgramVersion()) +
         (request.real_time ? ", with separate processes in real time: numbers vary from run to run.</p>\n"
                            : ", on simulated time: the same command gives the same bytes.</p>\n") +
         (failed.empty() ? ""
                         : "<p class=\"failed\"><b>Not everything worked.</b> Failed: " +
                               page::EscapeMarkup(failed) + ".</p>\n") +
         "<p>Each section shows one experiment or figure of the paper as this project's model, control laws "
         "and "
         "processes give it. The tables set three numbers side by side: what the paper prints or its figure "
         "shows; what its own equations give by an independent way (a closed form, a stability criterion); "
         "and "
         "what came out of this run.</p>\n"
         "</header>\n<nav>\n<ol>\n" +
         contents +
         "<li><a href=\"#findings\">Where the paper contradicts itself</a></li>\n</ol>\n</nav>\n<main>\n" +
         sections + FindingsTable(entries) + "</main>\n</body>\n</html>\n";
}

}  // namespace hydro::experiments
