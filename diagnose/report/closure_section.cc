#include "diagnose/report/closure_section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/report/html_parts.h"
#include "diagnose/report/picture_parts.h"
#include "model/effects/knots.h"
#include "page/figure_svg.h"
#include "page/plot.h"
#include "page/typeset.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kDrawn = 160;  // points of a curve

std::string Label(const std::string& name, const std::string& unit) {
  return WithBlanks(name) + (unit.empty() ? "" : " (" + unit + ")");
}

// The curve through values at knots, as the model has it.
Points Drawn(const std::vector<double>& knots, const std::vector<double>& values) {
  const model::Knots curve(knots);
  Points points;
  for (size_t i = 0; i <= kDrawn; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(kDrawn);
    const double x = knots.front() + part * (knots.back() - knots.front());
    const model::KnotWeights<double> w = curve.Around(x);
    double y = 0;
    for (size_t k = w.begin; k < w.end; ++k) {
      y += w.weight[k] * values[static_cast<size_t>(w.first + static_cast<std::ptrdiff_t>(k))];
    }
    points.x.push_back(x);
    points.y.push_back(y);
  }
  return points;
}

// Of a surface: one curve over the first variable for each knot of the second.
void AddCuts(const Closure& closure, page::Panel* panel) {
  const size_t columns = closure.knots[1].size();
  for (size_t k = 0; k < columns; ++k) {
    std::vector<double> values;
    for (size_t i = k; i < closure.value.size(); i += columns) values.push_back(closure.value[i]);
    const std::string label =
        closure.against[1] + " = " + ShortNumber(closure.knots[1][k], 2) + " " + closure.against_units[1];
    panel->curves.push_back(
        DrawnCurve(label, Drawn(closure.knots[0], values), static_cast<int>(k), page::Weight::kNormal));
  }
}

// Makes room for the band, as far as the curve can still be read: at the last knot, where few samples are, it may
// be many times as wide as the curve is high. The table has all of it.
void IncludeBand(const Closure& closure, page::Range* y) {
  const page::Range curve = *y;
  const double room = 1.5 * (curve.high - curve.low);
  for (const double low : closure.low) y->Include(std::max(low, curve.low - room));
  for (const double high : closure.high) y->Include(std::min(high, curve.high + room));
}

page::Figure Picture(const Closure& closure) {
  page::Panel panel;
  panel.x.label = Label(closure.against[0], closure.against_units[0]);
  panel.y.label = Label("value", closure.unit);  // the heading names the balance
  page::Range x, y;
  x.Include(closure.knots[0]);
  y.Include(0.0);
  y.Include(closure.value);
  if (closure.knots.size() == 2) {
    AddCuts(closure, &panel);
  } else {
    panel.curves.push_back(
        DrawnCurve("", Drawn(closure.knots[0], closure.value), kAfter, page::Weight::kNormal));
    page::Curve knots = page::Line("", closure.knots[0], closure.value, kAfter, page::Stroke::kPoints);
    knots.y_low = closure.low;
    knots.y_high = closure.high;
    IncludeBand(closure, &y);
    panel.curves.push_back(std::move(knots));
  }
  SetRange(panel.x, x.WithMargin());
  SetRange(panel.y, y.WithMargin());
  return {.caption = "", .panels = {panel}, .width = 560, .panel_height = 200};
}

std::string Values(const Closure& closure) {
  const bool surface = closure.knots.size() == 2;
  std::vector<std::string> columns = {"#" + Label(closure.against[0], closure.against_units[0])};
  if (surface) columns.push_back("#" + Label(closure.against[1], closure.against_units[1]));
  columns.insert(columns.end(), {"#" + Label("value", closure.unit), "#95 % band"});
  const size_t rows_of = surface ? closure.knots[1].size() : 1;
  std::string rows;
  for (size_t i = 0; i < closure.value.size(); ++i) {
    rows += "<tr>" + NumberCell(closure.knots[0][i / rows_of]) +
            (surface ? NumberCell(closure.knots[1][i % rows_of]) : "") + NumberCell(closure.value[i]) +
            "<td class=\"number\">" + ShortNumber(closure.low[i]) + " to " + ShortNumber(closure.high[i]) +
            "</td></tr>\n";
  }
  return Table(columns, rows, "narrow");
}

std::string GapText(const Closure& closure) {
  const double taken = 1 - std::pow(closure.after / closure.before, 2);
  return "<p>Added to the model" +
         std::string(closure.on_refit ? " with its own values refitted" : " with what was found") +
         ", it predicts held-out runs over " + ShortNumber(closure.seconds, 2) + " s with " +
         ShortNumber(closure.after, 3) + " noise units instead of " + ShortNumber(closure.before, 3) +
         ": it takes " + ShortNumber(100 * taken, 2) + " % of the squared gap. It names no cause.</p>\n";
}

}  // namespace

std::string ClosureSection(const Diagnosis& diagnosis) {
  std::string out;
  for (const Closure& closure : diagnosis.closures) {
    out += "<h3>" + page::EscapeMarkup(closure.id) + " against " +
           page::TypesetHtml(Enumerated(closure.against)) + "</h3>\n<p>It " +
           page::TypesetHtml(closure.resembles) + ".</p>\n" +
           (closure.knots.size() == 1
                ? "<p class=\"lead\">With 95 % intervals at its knots, as far as the picture "
                  "reaches:</p>\n"
                : "") +
           page::HtmlFigure(Picture(closure), "the closure, with its 95 % band") + Values(closure);
  }
  return out.empty() ? "" : out + GapText(diagnosis.closures.front());
}

}  // namespace hydro::diagnose
