// Sections with curves and tables, and the elements of all sections.
#include <cmath>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/report/page_sections.h"
#include "diagnose/report/report_pictures.h"
#include "diagnose/say/sentence.h"
#include "page/figure_svg.h"
#include "page/typeset.h"

namespace hydro::diagnose {
namespace {

// The curve of a closure; for a surface, the cut at the last knot of its second variable. The ends of the
// band are those of 95 %.
MeasuredCurve CurveOf(const Closure& closure) {
  MeasuredCurve curve;
  curve.unit = closure.unit;
  curve.against = closure.against[0];
  curve.against_unit = closure.against_units[0];
  curve.at = closure.knots[0];
  const size_t cuts = closure.knots.size() == 2 ? closure.knots[1].size() : 1;
  for (size_t i = cuts - 1; i < closure.value.size(); i += cuts) {
    curve.measured.push_back(closure.value[i]);
    curve.error.push_back((closure.high[i] - closure.low[i]) / (2 * 1.96));
  }
  return curve;
}

// "An unknown curve over motor speed in pump torque [closure.pump_torque]"
std::string Label(const Closure& closure) {
  std::string words = ChangeInWords(closure.id + "(" + Joined(closure.against, " and ") + ")");
  words[0] = 'A';
  return words + " [" + closure.id + "]";
}

std::string GapText(const Closure& closure) {
  const double taken = 1 - std::pow(closure.after / closure.before, 2);
  return "<p>Added to the model with what was found, it predicts held-out runs over " +
         ShortNumber(closure.seconds, 2) + " s with " + ShortNumber(closure.after, 3) +
         " noise units instead of " + ShortNumber(closure.before, 3) + ": it takes " +
         ShortNumber(100 * taken, 2) +
         " % of the squared gap. It names no cause. Its values are in report.json.</p>\n";
}

}  // namespace

std::string ShortCell(double value) { return "<td class=\"number\">" + ShortNumber(value, 2) + "</td>"; }

std::string PercentCell(double part) {
  const std::string text = std::isfinite(part) ? ShortNumber(std::round(100 * part)) + " %" : "-";
  return "<td class=\"number\">" + text + "</td>";
}

std::string IntervalCell(const Estimated& estimated) {
  return "<td class=\"number\">" + ShortNumber(estimated.low) + " to " + ShortNumber(estimated.high) +
         (estimated.shown ? "" : ": not shown by these runs") + "</td>";
}

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

std::string Curves(const std::vector<MeasuredCurve>& curves, const std::string& what) {
  std::string figures;
  for (const MeasuredCurve& curve : curves) {
    figures += page::HtmlFigure(
        CurveFigure(curve), what.empty() ? WithBlanks(curve.element) + " as measured and as modelled" : what);
  }
  return figures.empty() ? "" : "<div class=\"plots\">\n" + figures + "</div>\n";
}

std::string MeasuredSection(const Diagnosis& diagnosis) {
  if (diagnosis.measured.empty()) return "";
  return "<p>What the measured motion itself shows, without any simulation: means of stretches of 16 ms with "
         "95 % intervals, and what the models have at the same instants.</p>\n" +
         Curves(diagnosis.measured, "");
}

std::string ClosureSection(const Diagnosis& diagnosis) {
  std::string out;
  for (const Closure& closure : diagnosis.closures) {
    const std::string cut = closure.knots.size() == 1 ? ""
                                                      : " at " + closure.against[1] + " = " +
                                                            ShortNumber(closure.knots[1].back(), 2) + " " +
                                                            closure.against_units[1];
    out += "<h3>" + page::TypesetHtml(Label(closure)) + "</h3>\n<p>It " +
           page::TypesetHtml(closure.resembles) +
           ".</p>\n<p class=\"lead\">With 95 % intervals at its knots" + page::TypesetHtml(cut) +
           ", as far as the picture reaches:</p>\n" +
           page::HtmlFigure(CurveFigure(CurveOf(closure), "value"), "the closure, with its 95 % band");
  }
  return out.empty() ? "" : out + GapText(diagnosis.closures.front());
}

std::string PerRunSection(const Diagnosis& diagnosis) {
  std::string out;
  for (const ValueByRun& value : diagnosis.per_run) {
    std::string rows;
    for (const Estimated& run : value.values) {
      rows +=
          "<tr>" + Cell(run.name) +
          (std::isnan(run.value) ? "<td class=\"number\">-</td><td class=\"number\">cannot be simulated</td>"
                                 : NumberCell(run.value) + IntervalCell(run)) +
          "</tr>\n";
    }
    out +=
        "<h3>" + page::TypesetHtml(value.name) + "</h3>\n<p>It differs by " +
        ShortNumber(100 * value.Spread(), 2) +
        " % (standard deviation). With a value of its own for each run, windows that were not fitted are "
        "predicted with a typical gap of " +
        ShortNumber(value.after, 3) + " instead of " + ShortNumber(value.before, 3) + " noise units.</p>\n" +
        Table(
            {"run", "#" + value.name + (value.unit.empty() ? "" : " (" + value.unit + ")"), "#95 % interval"},
            rows, "narrow");
  }
  return out;
}

}  // namespace hydro::diagnose
