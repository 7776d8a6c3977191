// Small plots as SVG elements, for a page with the style of timing_page.cc.
#pragma once

#include <string>
#include <vector>

#include "timing/report/timing_record.h"

namespace hydro::timing {

// Text for HTML and SVG.
std::string EscapeHtml(const std::string& text);

// Counts over values, both logarithmic, with the percentiles marked. Values are multiplied by `scale` first.
std::string HistogramSvg(const TimingHistogram& histogram, double scale, const std::string& x_label);

// Values over time, one line each; the scale is logarithmic where all that is drawn is above 0 and spans more
// than a factor of 30.
struct TimeLine {
  std::string name;
  std::vector<double> values;  // as many as there are times; drawn in order
};
std::string TimeSvg(const std::vector<double>& times_s, const std::vector<TimeLine>& lines,
                    const std::string& y_label);

}  // namespace hydro::timing
