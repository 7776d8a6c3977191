// Small charts for the report: axes with round numbers, lines, dots and error bars as SVG.
#pragma once

#include <string>
#include <vector>

namespace hydro::page {

struct ChartRange {
  double low = 0, high = 1;

  // Widened to hold the finite ones of `values`.
  void Include(const std::vector<double>& values);
  void Include(double value);
  // An eighteenth wider on each side, and never empty.
  ChartRange WithMargin() const;
  // One that holds nothing yet.
  static ChartRange Empty();
};

// Points with a style: a class of the page's style sheet. NaN: nothing is drawn there.
struct ChartSeries {
  std::string style;
  std::vector<double> x, y;
  std::vector<double> error;  // error bars of that half length; empty: none
};

struct Chart {
  std::string x_label, y_label;   // plain text with subscripts (page/plot.h); "": none
  ChartRange x, y;                // what lies outside is cut off
  std::vector<ChartRange> spans;  // of x: shaded over the whole height
  double band = 0;                // shaded from -band to band of y
  bool zero_line = false;
  std::vector<ChartSeries> lines, dots;  // drawn in this order
  double width = 400, height = 130;      // with labels
};

// An SVG <g> with its upper left corner at (left, top). Numbers at the x axis are left out without an
// x_label.
std::string DrawChart(const Chart& chart, double left, double top);

// Round numbers in the range, about `count` of them.
std::vector<double> RoundNumbers(const ChartRange& range, int count);

// "12.3": for SVG's coordinates.
std::string Pixels(double value);

}  // namespace hydro::page
