#include "diagnose/report/report_pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/data/run_data.h"
#include "diagnose/report/picture_parts.h"

namespace hydro::diagnose {
namespace {

struct GapRow {
  std::string name;
  BeforeAfter gap;
};

std::vector<GapRow> GapRows(const Diagnosis& diagnosis) {
  std::vector<GapRow> rows = {{"all signals, held out", diagnosis.held_out},
                              {"all signals, fitted", diagnosis.fit}};
  for (const SignalGap& signal : diagnosis.signals) {
    if (!(signal.noise > 0)) continue;
    const BeforeAfter& gap = signal.held_out;
    rows.push_back({WithBlanks(ChannelName(signal.channel)) + ", held out",
                    {gap.before / signal.noise, gap.refit_only / signal.noise, gap.after / signal.noise}});
  }
  return rows;
}

}  // namespace

page::Figure GapFigure(const Diagnosis& diagnosis) {
  const std::vector<GapRow> rows = GapRows(diagnosis);
  constexpr double kRow = 25;
  page::Panel panel;
  panel.x = {
      .label = "root-mean-square residual in noise standard deviations", .logarithmic = true, .min = 0.5};
  panel.y.min = 0.4 - static_cast<double>(rows.size());
  panel.y.max = 0.6;
  // The line from before to after.
  page::Curve way = page::Line("", {}, {}, kRefit);
  page::Curve before = page::Line(kBeforeLabel, {}, {}, kBefore, page::Stroke::kPoints);
  page::Curve refit = page::Line("its own parameters refitted", {}, {}, kRefit, page::Stroke::kPoints);
  page::Curve after = page::Line(kAfterLabel, {}, {}, kAfter, page::Stroke::kPoints);
  double highest = 10;
  for (size_t i = 0; i < rows.size(); ++i) {
    const double y = -static_cast<double>(i);
    panel.y.ticks.push_back({y, rows[i].name});
    const BeforeAfter& gap = rows[i].gap;
    // Values below the axis are shown at its end.
    const auto shown = [](double value) { return std::isfinite(value) ? std::max(value, 0.5) : value; };
    for (auto [curve, value] :
         {std::pair{&before, gap.before}, {&refit, gap.refit_only}, {&after, gap.after}}) {
      curve->x.push_back(shown(value));
      curve->y.push_back(y);
      if (std::isfinite(value)) highest = std::max(highest, value);
    }
    way.x.insert(way.x.end(), {shown(gap.before), shown(gap.after), std::nan("")});
    way.y.insert(way.y.end(), {y, y, std::nan("")});
  }
  way.weight = page::Weight::kFaint;
  for (page::Curve* curve : {&before, &refit, &after}) curve->weight = page::Weight::kStrong;
  panel.x.max = 1.15 * highest;
  panel.rules = {{"noise floor", true, 1}};
  panel.curves = {way, before, refit, after};
  return {.caption = "",
          .panels = {panel},
          .width = 760,
          .panel_height = kRow * static_cast<double>(rows.size()) + 5};
}

page::Figure MissingTermFigure(const MissingTerm& term) {
  page::Panel panel;
  panel.x.label =
      WithBlanks(term.against) + (term.against_unit.empty() ? "" : " (" + term.against_unit + ")");
  panel.y.label = "missing in " + WithBlanks(term.balance) + " (" + term.unit + ")";
  page::Curve found = page::Line("", term.at, term.mean, kAfter, page::Stroke::kLinePoints);
  page::Range x, y;
  x.Include(term.at);
  y.Include(0.0);
  for (size_t i = 0; i < term.mean.size(); ++i) {
    const double error = i < term.error.size() ? 1.96 * term.error[i] : 0;
    found.y_low.push_back(term.mean[i] - error);
    found.y_high.push_back(term.mean[i] + error);
  }
  y.Include(found.y_low);
  y.Include(found.y_high);
  SetRange(panel.x, x.WithMargin());
  SetRange(panel.y, y.WithMargin());
  panel.curves = {found};
  return {.caption = "", .panels = {panel}, .width = 480, .panel_height = 180};
}

}  // namespace hydro::diagnose
