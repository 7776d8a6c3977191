// A field of coloured cells: one value for each pair of two others.
#pragma once

#include <string>
#include <vector>

namespace hydro::page {

struct HeatMap {
  std::string x_label, y_label, value_label;  // quantity and unit
  std::vector<std::string> x_names;           // of the columns, from the left
  std::vector<std::string> y_names;           // of the rows, from below
  std::vector<double> values;                 // row by row from below; NaN: unknown, the cell is left empty
};

// A drawing for Figure::drawing (page/plot.h). Each cell shows its value where there is room. The scale of
// colours stands beside the field; smaller values are darker (viridis, which keeps its order in grey and for
// colour-blind readers). Throws std::invalid_argument for sizes that do not match, and when there are no
// values.
std::string HeatMapDrawing(const HeatMap& map);

}  // namespace hydro::page
