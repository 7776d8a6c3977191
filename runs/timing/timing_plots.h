// The plots of the timing page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "page/plot.h"
#include "runs/timing/timing_record.h"

namespace hydro::timing {

// Counts over values on logarithmic axes, with the percentiles marked. Values are first multiplied by
// `scale`. Empty when there are no values.
std::optional<page::Figure> HistogramFigure(const TimingHistogram& histogram, double scale,
                                            const std::string& x_label, const std::string& caption);

struct TimeLine {
  std::string name;
  std::vector<double> values;  // as many as times
};

// Values over time, one curve for each line. The scale is logarithmic when all values are above 0 and span
// more than a factor of 30. Empty when there are no values.
std::optional<page::Figure> TimeFigure(const std::vector<double>& times_s, const std::vector<TimeLine>& lines,
                                       const std::string& y_label, const std::string& caption);

}  // namespace hydro::timing
