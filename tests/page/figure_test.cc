#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "page/curves.h"
#include "page/figure_svg.h"
#include "page/html_page.h"
#include "page/panel_geometry.h"
#include "page/svg.h"
#include "page/typeset.h"

namespace hydro::page {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

size_t Count(const std::string& text, const std::string& what) {
  size_t count = 0;
  for (size_t i = 0; (i = text.find(what, i)) != std::string::npos; i += what.size()) ++count;
  return count;
}

// Whether tags are closed in the order in which they were opened: otherwise a browser refuses an SVG.
bool IsBalanced(const std::string& xml) {
  std::vector<std::string> open;
  for (size_t i = 0; (i = xml.find('<', i)) != std::string::npos;) {
    const size_t end = xml.find('>', i);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(i + 1, end - i - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n\t/", tag.starts_with('/') ? 1 : 0));
    if (tag.starts_with('/')) {
      if (open.empty() || "/" + open.back() != name) return false;
      open.pop_back();
    } else if (!tag.starts_with('?') && !tag.starts_with('!') && !tag.ends_with('/')) {
      open.push_back(name);
    }
    i = end;
  }
  return open.empty();
}

Figure SmallFigure() {
  Curve curve;
  curve.label = "p_2 <b> & \"more\"";
  curve.x = {0, 1, 2, 3};
  curve.y = {0, 2, NAN, 1};
  Curve points = curve;
  points.label = "measured";
  points.stroke = Stroke::kPoints;
  points.y = {1, 1, 1, 1};
  points.y_low = {0.5, 0.5, 0.5, 0.5};
  points.y_high = {1.5, 1.5, 1.5, 1.5};
  Panel panel;
  panel.title = "a title";
  panel.x.label = "time, s";
  panel.y.label = "pressure, psi";
  panel.curves = {curve, points};
  panel.notes = {{"the peak", 1, 2}};
  panel.rules = {{"a limit", false, 1.7}};
  Figure figure;
  figure.caption = "A caption at α = 0.";
  figure.panels = {panel, panel};
  return figure;
}

void ExpectRefused(const Figure& figure, const std::string& why) {
  try {
    FigureFile(figure, "x");
    FAIL() << why;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(why));
  }
}

// Tests that a figure becomes a well-formed SVG document with all its texts, escaped, and without ids, which
// could clash between two pictures on a page.
TEST(FigureSvg, SvgHoldsTheFigure) {
  const std::string svg = FigureFile(SmallFigure(), "fig3-noise");
  EXPECT_TRUE(IsBalanced(svg));
  EXPECT_THAT(svg, HasSubstr("<svg"));
  EXPECT_THAT(svg, HasSubstr("xmlns=\"http://www.w3.org/2000/svg\""));
  for (const char* text :
       {"a title", "time, s", "pressure, psi", "the peak", "a limit", "A caption at α = 0.",
        "&lt;b&gt; &amp; &quot;more&quot;", ">2</tspan>", "measured"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_EQ(Count(svg, "a title"), 2u);  // two panels
  EXPECT_EQ(Count(svg, " id="), 0u);
}

// Tests that identical figures give identical bytes.
TEST(FigureSvg, IsDeterministic) {
  const std::string svg = FigureFile(SmallFigure(), "a");
  EXPECT_EQ(svg, FigureFile(SmallFigure(), "a"));
}

// Tests that logarithmic axes show positive values only, and that even a short one has labelled ticks.
TEST(FigureSvg, LogarithmicAxis) {
  Figure figure = SmallFigure();
  figure.panels.resize(1);
  figure.panels[0].x.logarithmic = true;
  figure.panels[0].x.min = 3;
  figure.panels[0].x.max = 9;
  figure.panels[0].curves.resize(1);
  figure.panels[0].curves[0].x = {-1, 0, 4, 8};
  figure.panels[0].curves[0].y = {1, 1, 1.5, 2};
  figure.panels[0].notes.clear();
  const std::string svg = FigureFile(figure, "x");
  EXPECT_TRUE(IsBalanced(svg));
  for (const char* tick : {">4<", ">5<", ">8<"}) EXPECT_THAT(svg, HasSubstr(tick));
}

// Tests that figures that cannot be drawn are refused with the panel's number and what is wrong.
TEST(FigureSvg, BadFiguresAreRefused) {
  ExpectRefused({}, "without panels");
  Figure figure = SmallFigure();
  figure.panels[1].curves[0].y.pop_back();
  ExpectRefused(figure, "x, panel 2: the vectors of curve 'p_2 <b> & \"more\"' are of unequal length");
  figure = SmallFigure();
  figure.panels[0].curves[1].y_low.pop_back();
  ExpectRefused(figure, "unequal length");
  figure = SmallFigure();
  figure.panels[1].curves.clear();
  ExpectRefused(figure, "panel 2: no curve");
  figure = SmallFigure();
  figure.panels[0].y.min = 1;
  figure.panels[0].y.max = 1;
  ExpectRefused(figure, "has no range");
  figure = SmallFigure();
  figure.panels[0].notes.clear();
  figure.panels[0].rules.clear();
  for (Curve& curve : figure.panels[0].curves) {
    curve = {"", {0, 1}, {NAN, NAN}, Stroke::kLine, -1, {}, {}};
  }
  ExpectRefused(figure, "nothing to show");
  figure = SmallFigure();
  figure.drawing = "<p>no svg</p>";
  ExpectRefused(figure, "viewBox");
}

// Tests that a drawing is used as it is, with its caption below it.
TEST(FigureSvg, DrawingGetsItsCaption) {
  Figure figure;
  figure.caption = "What is drawn";
  figure.drawing = "<svg viewBox=\"0 0 200 100\"><circle r=\"3\"/></svg>";
  const std::string svg = FigureFile(figure, "x");
  EXPECT_TRUE(IsBalanced(svg));
  EXPECT_THAT(svg, HasSubstr(figure.drawing));
  EXPECT_THAT(svg, HasSubstr("What is drawn"));
  EXPECT_THAT(svg, HasSubstr("width=\"200\""));
}

// Tests that everything that the axes of a panel can hold is drawn: bars, bands, names at ticks, and points
// with error bars.
TEST(FigureSvg, BarsBandsAndNames) {
  Panel panel;
  panel.x = {.label = "period, us", .logarithmic = true};
  panel.y = {.label = "", .min = 0, .max = 3, .ticks = {{1, "plant"}, {2, "logger"}}};
  panel.curves = {{"count", {1, 10, 100}, {2, NAN, 1}, Stroke::kBars}};
  panel.bands = {{"noise", false, 0.5, 1}, {"", true, 2, 3}, {"", true, 500, 600}};
  const std::string svg = FigureElement({.caption = "", .panels = {panel}}, "x");
  EXPECT_TRUE(IsBalanced(svg));
  for (const char* part :
       {"class=\"bars c0\"", "class=\"band\"", ">plant<", ">logger<", ">noise<", ">100<"}) {
    EXPECT_THAT(svg, HasSubstr(part));
  }
  EXPECT_EQ(Count(svg, "class=\"span\""), 1u);  // the other is outside
  EXPECT_EQ(Count(svg, "z\""), 1u);             // one bar: the second ends at NaN, the third nowhere
}

// Tests that panels side by side share their rows' heights, and that a key may extend over a panel without
// one.
TEST(FigureSvg, Columns) {
  Panel left;
  left.curves = {Line("measured", {0, 1}, {0, 1}, 0),
                 Line("model as given, which takes room", {0, 1}, {1, 0}, 1)};
  left.width = 0.3;
  Panel right = left;
  for (Curve& curve : right.curves) curve.label.clear();
  const std::string svg = FigureElement(
      {.caption = "", .panels = {left, right}, .columns = 2, .width = 400, .panel_height = 80}, "x");
  EXPECT_TRUE(IsBalanced(svg));
  EXPECT_EQ(Count(svg, "<rect class=\"frame\""), 2u);
  right.curves[0].label = "another";  // now the key of the left panel has two rows
  const std::string taller = FigureElement(
      {.caption = "", .panels = {left, right}, .columns = 2, .width = 400, .panel_height = 80}, "x");
  EXPECT_LT(svg.substr(0, svg.find("role")), taller.substr(0, taller.find("role")));
  EXPECT_THROW(FigureElement({.caption = "", .panels = {left}, .columns = 0}, "x"), std::invalid_argument);
}

// Tests that coordinates stay within reason whatever the data.
TEST(FigureSvg, RunawayValues) {
  Panel panel;
  panel.y.min = -1;
  panel.y.max = 1;
  panel.curves = {Line("", {0, 1, 2, 3}, {0, 1e300, -1e30, INFINITY}, 0)};
  const std::string svg = FigureElement({.caption = "", .panels = {panel}}, "x");
  for (const char* bad : {"inf", "nan", "e+", "00000"}) EXPECT_THAT(svg, Not(HasSubstr(bad)));
}

// Tests that an axis has round numbers within its range, with room between them.
TEST(Ticks, RoundNumbers) {
  const auto texts = [](const AxisRange& range, double pixels) {
    std::string all;
    for (const Tick& tick : Ticks(range, pixels, 30)) {
      EXPECT_TRUE(range.Holds(tick.value)) << tick.value;
      all += tick.text.empty() ? "" : tick.text + " ";
    }
    return all;
  };
  EXPECT_EQ(texts({-0.4, 10.2, false}, 150), "0 5 10 ");
  EXPECT_EQ(texts({0, 1, false}, 150), "0 0.2 0.4 0.6 0.8 1 ");
  EXPECT_EQ(texts({1, 1000, true}, 120), "1 10 100 1000 ");
  EXPECT_EQ(texts({1, 1000, true}, 60), "1 100 ");
  EXPECT_EQ(texts({3, 3.5, true}, 90), "3 3.2 3.4 ");
  EXPECT_EQ(texts({-270, 240, false}, 72), "−200 0 200 ");  // never a single number
}

// Tests how numbers are written.
TEST(Ticks, Numbers) {
  EXPECT_EQ(TickNumber(0), "0");
  EXPECT_EQ(TickNumber(-2.5), "−2.5");
  EXPECT_EQ(TickNumber(0.1 + 0.2), "0.3");
  EXPECT_EQ(TickNumber(2e-5), "2×10^{−5}");
  EXPECT_EQ(TickNumber(1e7), "10^{7}");
  EXPECT_EQ(Pixels(12.345), "12.3");
  EXPECT_EQ(Pixels(-0.01), "0");
}

// Tests that a page is complete and loads nothing from elsewhere, and that one sheet covers screens, dark
// ones, and paper.
TEST(HtmlPage, IsSelfContained) {
  const std::string page = HtmlPage("a < b", HtmlFigure(SmallFigure(), "x"));
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_THAT(page, HasSubstr("<title>a &lt; b</title>"));
  EXPECT_THAT(page, HasSubstr("<figcaption>A caption at α = 0.</figcaption>"));
  for (const char* media : {"prefers-color-scheme: dark", "@media print", "max-width: 45rem"}) {
    EXPECT_THAT(page, HasSubstr(media));
  }
  for (const char* outside : {"http:", "https:", "src=", "<script", "<link", "@import", "url("}) {
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  }
}

// Tests that a drawing's places match the texts given for them.
TEST(DrawingTemplate, FillsAllPlaces) {
  EXPECT_EQ(FillDrawing("<text>k = {{k}}, {{k}} {{n}}</text>", {{"k", "4"}, {"n", "<3"}}),
            "<text>k = 4, 4 &lt;3</text>");
  EXPECT_THROW(FillDrawing("{{k}}", {}), std::logic_error);
  EXPECT_THROW(FillDrawing("{{k}}", {{"k", "4"}, {"n", "3"}}), std::logic_error);
}

// Tests that thinning a long curve keeps the extremes of each pixel column, its ends and its gaps, and makes
// it short.
TEST(Thinning, KeepsExtremesEndsAndGaps) {
  constexpr int kPoints = 100000;
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < kPoints; ++i) {
    x.push_back(i);
    y.push_back(std::sin(0.37 * i));
  }
  y[40123] = 50;
  y[70077] = -50;
  for (int i = 60000; i < 60500; ++i) y[static_cast<size_t>(i)] = NAN;
  const auto column = [](double value) { return value / kPoints * 700; };
  const std::vector<size_t> kept = ThinLine(x, y, column);
  EXPECT_LE(kept.size(), 4u * 701 + 2);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(kept.front(), 0u);
  EXPECT_EQ(kept.back(), static_cast<size_t>(kPoints - 1));
  for (const size_t i : {40123u, 70077u}) EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), i)) << i;
  EXPECT_EQ(std::count_if(kept.begin(), kept.end(), [&](size_t i) { return std::isnan(y[i]); }), 1);
  // Every column's lowest and highest value are there.
  for (int c = 0; c < 700; ++c) {
    double lowest = INFINITY;
    double highest = -INFINITY;
    double kept_lowest = INFINITY;
    double kept_highest = -INFINITY;
    for (size_t i = 0; i < x.size(); ++i) {
      if (std::floor(column(x[i])) != c || std::isnan(y[i])) continue;
      lowest = std::min(lowest, y[i]);
      highest = std::max(highest, y[i]);
    }
    for (const size_t i : kept) {
      if (std::floor(column(x[i])) != c || std::isnan(y[i])) continue;
      kept_lowest = std::min(kept_lowest, y[i]);
      kept_highest = std::max(kept_highest, y[i]);
    }
    ASSERT_EQ(kept_lowest, lowest) << "column " << c;
    ASSERT_EQ(kept_highest, highest) << "column " << c;
  }
}

// Tests that a short curve is drawn as it is, and that points in one pixel are drawn once.
TEST(Thinning, ShortCurvesAndPoints) {
  const std::vector<double> x = {0, 1, 1, 2, 3};
  const std::vector<double> y = {0, 1, 1, NAN, 3};
  const auto pixels = [](double value) { return 10 * value; };
  EXPECT_THAT(ThinLine(x, y, pixels), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(ThinPoints(x, y, pixels, pixels), ElementsAre(0, 1, 4));
}

// Tests that equal scales give one unit the same length on both axes, and that nothing is cut off.
TEST(PanelGeometry, EqualScales) {
  Panel panel;
  panel.equal_scales = true;
  panel.x = {"", false, -100, 50};
  panel.curves = {{"", {-100, 50}, {-120, 120}, Stroke::kPoints, -1, {}, {}}};
  const PanelGeometry geometry = FitPanel(panel, {80, 10, 830, 370}, "x");
  const double x_unit = geometry.Column(1) - geometry.Column(0);
  const double y_unit = geometry.Row(0) - geometry.Row(1);
  EXPECT_NEAR(x_unit, y_unit, 1e-9);
  EXPECT_LE(geometry.x.min, -100);
  EXPECT_GE(geometry.x.max, 50);
  EXPECT_LE(geometry.y.min, -120);
}

// Tests that a label goes where nothing is drawn, and the next one not on top of it.
TEST(LabelPlacement, AvoidsCurvesAndLabels) {
  LabelPlacement placement({0, 0, 100, 100});
  placement.AddStroke(0, 10, 100, 10);
  const Box on_curve{10, 5, 40, 15};
  const Box free{10, 40, 40, 50};
  const Box also_free{50, 40, 80, 50};
  const Box outside{90, 40, 120, 50};
  EXPECT_EQ(placement.Place({outside, on_curve, free, also_free}).top, free.top);
  EXPECT_EQ(placement.Place({outside, on_curve, free, also_free}).left, also_free.left);
}

// Tests the convention for subscripts and superscripts, and that names of columns and keys stay as they are.
TEST(Typeset, SubscriptsAndSuperscripts) {
  EXPECT_EQ(TypesetHtml("p_2 - p_1"), "p<sub>2</sub> - p<sub>1</sub>");
  EXPECT_EQ(TypesetHtml("T_pmax in^3/rad s^-1"), "T<sub>pmax</sub> in<sup>3</sup>/rad s<sup>-1</sup>");
  EXPECT_EQ(TypesetHtml("Δp_ref, e^{-t/τ} x_{max 2}"),
            "Δp<sub>ref</sub>, e<sup>-t/τ</sup> x<sub>max 2</sub>");
  EXPECT_EQ(TypesetHtml("p1_psi static_excess _x a_ {y}"), "p1_psi static_excess _x a_ {y}");
  EXPECT_EQ(TypesetHtml("a < b & c"), "a &lt; b &amp; c");
  EXPECT_EQ(TypesetSvg("p_2x"), "p<tspan dy=\"0.3em\" font-size=\"75%\">2x</tspan>");
  EXPECT_THAT(TypesetSvg("p_2 = 1"), HasSubstr("<tspan dy=\"-0.225em\"> = 1</tspan>"));
}

// Tests that text is wrapped at blanks, and that nothing is lost.
TEST(Typeset, Wraps) {
  EXPECT_THAT(WrapText("aaa bbb  ccc\nddd", TextWidth("aaa bbb") + 0.1), ElementsAre("aaa bbb", "ccc ddd"));
  EXPECT_THAT(WrapText("averylongword b", 1), ElementsAre("averylongword", "b"));
  EXPECT_TRUE(WrapText("  ", 10).empty());
}

}  // namespace
}  // namespace hydro::page
