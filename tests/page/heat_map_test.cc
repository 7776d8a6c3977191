#include "page/heat_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "page/figure_svg.h"

namespace hydro::page {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

HeatMap SmallMap() {
  return {"gain", "damping", "overshoot, %", {"1", "2"}, {"10", "20"}, {0, 5, kNone, 10}};
}

// Tests that each known value is a cell in its colour with its number, and that an unknown one is left empty.
TEST(HeatMapTest, DrawsEachValue) {
  const std::string drawing = HeatMapDrawing(SmallMap());
  EXPECT_THAT(drawing, HasSubstr("fill=\"#440154\""));  // the smallest, viridis at 0
  EXPECT_THAT(drawing, HasSubstr("fill=\"#21918c\""));  // the middle
  EXPECT_THAT(drawing, HasSubstr("fill=\"#fde725\""));  // the largest
  EXPECT_THAT(drawing, HasSubstr(">10</text>"));
  EXPECT_THAT(drawing, Not(HasSubstr("nan")));
  const std::string white = "style=\"fill: #ffffff\">0</text>", dark = "style=\"fill: #1a1a1a\">10</text>";
  EXPECT_THAT(drawing, HasSubstr(white));
  EXPECT_THAT(drawing, HasSubstr(dark));
}

// Tests that a larger x lies further right, and a larger y further up.
TEST(HeatMapTest, RowsRiseFromBelow) {
  const auto place = [](const std::string& name, const std::string& text) {
    const std::string drawing = HeatMapDrawing(SmallMap());
    const size_t end = drawing.find(">" + text + "</text>");
    const size_t begin = drawing.rfind(name + "=\"", end) + name.size() + 2;
    return std::stod(drawing.substr(begin));
  };
  EXPECT_LT(place("x", "0"), place("x", "5"));
  EXPECT_GT(place("y", "5"), place("y", "10"));
}

// Tests that it is a drawing that figures take, and that one value alone has a scale, too.
TEST(HeatMapTest, FitsIntoAFigure) {
  Figure figure;
  figure.drawing = HeatMapDrawing(SmallMap());
  EXPECT_THAT(FigureFile(figure, "map"), HasSubstr("overshoot, %"));
  EXPECT_THAT(HeatMapDrawing({"x", "y", "z", {"1"}, {"1"}, {3}}), HasSubstr(">3</text>"));
}

// Tests that sizes that do not fit, and maps without a value, are refused.
TEST(HeatMapTest, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(HeatMapDrawing({"x", "y", "z", {"1", "2"}, {"1"}, {3}}), std::invalid_argument);
  EXPECT_THROW(HeatMapDrawing({"x", "y", "z", {"1"}, {"1"}, {kNone}}), std::invalid_argument);
}

}  // namespace
}  // namespace hydro::page
