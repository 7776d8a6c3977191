// The plots of the timing page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "page/plot.h"
#include "timing/report/timing_record.h"

namespace hydro::timing {

// Counts over values, both logarithmic, with the percentiles marked. Values are multiplied by `scale` first. Nothing
// without values.
std::optional<page::Figure> HistogramFigure(const TimingHistogram& histogram, double scale,
                                            const std::string& x_label, const std::string& caption);

struct TimeLine {
  std::string name;
  std::vector<double> values;  // as many as there are times
};

// Values over time, one line each; the scale is logarithmic where all values are above 0 and span more than a factor of
// 30. Nothing without values.
std::optional<page::Figure> TimeFigure(const std::vector<double>& times_s, const std::vector<TimeLine>& lines,
                                       const std::string& y_label, const std::string& caption);

}  // namespace hydro::timing
