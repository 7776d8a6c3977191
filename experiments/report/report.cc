#include "experiments/report/report.h"

#include <algorithm>
#include <cmath>

#include "experiments/report/experiment_files.h"
#include "page/html_page.h"
#include "page/typeset.h"
#include "settings/command_line.h"

namespace hydro::experiments {
namespace {

std::string Paragraph(const std::string& heading, const std::string& text) {
  if (text.empty()) return "";
  return "<h3>" + page::EscapeMarkup(heading) + "</h3>\n<p>" + page::TypesetHtml(text) + "</p>\n";
}

std::string Shown(double value) { return std::isfinite(value) ? ShownNumber(value) : "–"; }

std::string ComparisonTable(const std::vector<Comparison>& comparisons, bool si) {
  if (comparisons.empty()) return "";
  std::string out =
      "<div class=\"table\"><table class=\"comparisons\">\n<thead><tr><th>quantity</th><th>the paper</th><th "
      "class=\"number\">independent</th><th class=\"number\">this "
      "run</th><th>unit</th><th>remark</th></tr></thead>\n<tbody>\n";
  for (const Comparison& row : si ? InSi(comparisons) : comparisons) {
    out += "<tr><td>" + page::TypesetHtml(row.quantity) + "</td><td>" +
           (row.paper.empty() ? "–" : page::TypesetHtml(row.paper)) + "</td><td class=\"number\">" +
           Shown(row.expected) + "</td><td class=\"number\">" + Shown(row.here) + "</td><td class=\"unit\">" +
           page::TypesetHtml(row.unit) + "</td><td class=\"remark\">" + page::TypesetHtml(row.remark) +
           "</td></tr>\n";
  }
  return out + "</tbody>\n</table></div>\n";
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
    out += "<div id=\"picture-" + page::EscapeMarkup(picture.name) + "\">\n" + picture.html + "</div>\n";
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
      "<section id=\"findings\">\n<h2>Where the paper contradicts itself or leaves something "
      "open</h2>\n<p>None of this is patched silently: a run shows each point, and the table says what the "
      "project does about it.</p>\n<div class=\"table\"><table>\n<thead><tr><th "
      "class=\"number\">no.</th><th>the paper</th><th>evidence from these runs</th><th>what the project "
      "does</th><th>where</th></tr></thead>\n<tbody>\n";
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
  return out + "</tbody>\n</table></div>\n</section>\n";
}

std::string Command(const ExperimentRequest& request) {
  std::string command = "hydro-experiment " + request.name;
  if (request.options.seed != ExperimentOptions{}.seed) {
    command += " --seed " + std::to_string(request.options.seed);
  }
  if (request.options.machines != ExperimentOptions{}.machines) {
    command += " --machines " + std::to_string(request.options.machines);
  }
  if (request.options.noise) command += " --noise";
  if (request.real_time) command += " --real-time";
  if (request.si) command += " --si";
  return command;
}

std::string Header(const std::string& title, const ExperimentRequest& request, const std::string& failed) {
  return "<header>\n<h1>" + page::EscapeMarkup(title) +
         "</h1>\n"
         "<p class=\"meta\">After <i>Modeling and Analysis of a High-Torque, Hydrostatic Actuator for "
         "Robotic "
         "Applications</i>; equation, figure and table numbers are the paper's. Made by <code>" +
         page::EscapeMarkup(Command(request)) + "</code>, hydro " +
         page::EscapeMarkup(settings::ProgramVersion()) +
         (request.real_time ? ", with separate processes in real time: numbers vary from run to run.</p>\n"
                            : ", on simulated time: the same command gives the same bytes.</p>\n") +
         (failed.empty() ? ""
                         : "<p class=\"failed\"><b>Some experiments failed:</b> " +
                               page::EscapeMarkup(failed) + ".</p>\n") +
         "<p>Each section shows one experiment or figure of the paper as this project's model, control laws "
         "and "
         "processes reproduce it. The tables compare three numbers: what the paper prints or its figure "
         "shows; what "
         "its own equations give by an independent method (a closed form, a stability criterion); and the "
         "result of "
         "this run.</p>\n</header>\n";
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
  constexpr char kTitle[] = "A hydrostatic actuator: the paper's experiments, reproduced";
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
  return page::HtmlPage(kTitle, Header(kTitle, request, failed) + "<nav>\n<ol>\n" + contents +
                                    "<li><a href=\"#findings\">Where the paper contradicts itself</a></li>\n"
                                    "</ol>\n</nav>\n<main>\n" +
                                    sections + FindingsTable(entries) + "</main>\n");
}

}  // namespace hydro::experiments
