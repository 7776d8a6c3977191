// The page of hydro-tune's report.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <sstream>

#include "page/figure_svg.h"
#include "page/html_page.h"
#include "page/typeset.h"
#include "tune/search/report.h"

namespace hydro::tune {
namespace {

std::string ArmUnit(const TuningReport& report) {
  return report.judge->config().model.description.units.UnitFor("rad", 1);
}

page::Panel RatioPanel(const TuningReport& report) {
  page::Panel panel;
  panel.title = "Settling time over the shortest possible";
  panel.x = {.label = "step, " + ArmUnit(report)};
  panel.y = {.label = "ratio", .min = 0.9};
  panel.rules.push_back({.label = "bang-bang bound", .vertical = false, .value = 1});
  for (size_t i = 0; i < report.proposals.size(); ++i) {
    const Proposal& proposal = report.proposals[i];
    std::vector<double> ratio;
    for (const StepResult& step : proposal.steps)
      ratio.push_back(step.settled ? step.ratio : page::kAutomatic);
    panel.curves.push_back(page::Line(proposal.name, report.judge->steps(), ratio, static_cast<int>(i),
                                      page::Stroke::kLinePoints));
  }
  return panel;
}

page::Panel ResponsePanel(const TuningReport& report) {
  page::Panel panel;
  const StepJudge& judge = *report.judge;
  const double step = judge.goal_step();
  panel.title = fmt::format("A step of {:.3g} {}", step, ArmUnit(report));
  panel.x = {.label = "time, s"};
  panel.y = {.label = (ArmUnit(report) == "rad" ? "angle, " : "position, ") + ArmUnit(report)};
  for (size_t i = 0; i < report.proposals.size(); ++i) {
    StepRun run;
    judge.Try(report.proposals[i].tried.gains, judge.Nominal(step), &run);
    panel.curves.push_back(
        page::Line(report.proposals[i].name, run.response.time, run.response.angle, static_cast<int>(i)));
  }
  panel.bands.push_back({.label = "within 2 %", .vertical = false, .from = 0.98 * step, .to = 1.02 * step});
  return panel;
}

page::Panel TradeOffPanel(const TuningReport& report) {
  page::Panel panel;
  panel.title = "What a wider margin costs";
  panel.x = {.label = "gain margin of the position loop"};
  panel.y = {.label = "largest ratio", .min = 0.9, .max = 3};
  std::vector<double> margin;
  std::vector<double> ratio;
  for (const Tried& tried : report.tried) {
    if (tried.steps.ratio > 3) continue;
    margin.push_back(tried.check.position->worst.gain);
    ratio.push_back(tried.steps.ratio);
  }
  if (!margin.empty())
    panel.curves.push_back({.label = "gains tried",
                            .x = margin,
                            .y = ratio,
                            .stroke = page::Stroke::kPoints,
                            .weight = page::Weight::kFaint});
  std::vector<double> at;
  std::vector<double> model;
  std::vector<double> uncertain;
  for (const TradeOff& row : report.trade_offs) {
    at.push_back(row.tried.check.position->worst.gain);
    model.push_back(row.tried.steps.ratio);
    uncertain.push_back(std::min(3.0, row.tried.steps.uncertain_ratio));
  }
  panel.curves.push_back(page::Line("best", at, model, 1, page::Stroke::kLinePoints));
  panel.curves.push_back(
      page::Line("best, over the model's uncertainty", at, uncertain, 2, page::Stroke::kLinePoints));
  return panel;
}

page::Figure Picture(const TuningReport& report) {
  page::Figure figure;
  figure.caption = fmt::format("Gains for {}: steps on the nonlinear model{}, from mid-stroke.",
                               report.config, report.noise ? " with noisy sensors" : "");
  figure.panels = {RatioPanel(report), ResponsePanel(report)};
  if (!report.trade_offs.empty()) figure.panels.push_back(TradeOffPanel(report));
  figure.panel_height = 240;
  return figure;
}

// Line by line, because escaping turns line ends into blanks.
std::string Preformatted(const std::string& text) {
  std::string escaped;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) escaped += page::EscapeMarkup(line) + "\n";
  return escaped;
}

}  // namespace

std::string ReportPicture(const TuningReport& report) { return page::FigureFile(Picture(report), "tune"); }

std::string ReportPage(const TuningReport& report, bool si) {
  const std::string title = "hydro-tune: " + report.config;
  return page::HtmlPage(title,
                        "<h1>" + page::EscapeMarkup(title) + "</h1>\n" +
                            page::HtmlFigure(Picture(report), "tune") + "<pre>" +
                            Preformatted(ReportText(report, si)) + "</pre>\n",
                        true);
}

}  // namespace hydro::tune
