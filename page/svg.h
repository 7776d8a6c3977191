// Pieces of SVG: elements, labels where there is room, drawings with placeholders. Their look (colours,
// fonts, light and dark) comes from chart.css, by class.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::page {

// In pixels, with y downwards.
struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

// Places a label in a panel where it hides least: a coarse raster of what is drawn there.
class LabelPlacement {
 public:
  explicit LabelPlacement(const Box& frame);

  // Adds a stroke from one point to another; parts outside the frame do not count.
  void AddStroke(double x0, double y0, double x1, double y1);

  // Returns the candidate within the frame that hides least (the first of equals) and marks it as taken.
  // `candidates` must not be empty.
  Box Place(const std::vector<Box>& candidates);

 private:
  double Cost(const Box& box) const;

  Box frame_;
  int columns_;
  int rows_;
  std::vector<int> cells_;  // how much is drawn in each cell
};

// A coordinate as text: "12.3".
std::string Pixels(double value);

struct TextStyle {
  const char* look = "";  // classes of chart.css
  const char* anchor = "start";
  bool upwards = false;  // turned by 90 degrees
};

// A <text> element; `text` is written as page/plot.h describes.
std::string SvgText(std::string_view text, double x, double y, const TextStyle& style = {});

// A <path> with the classes `look` and further attributes.
std::string SvgPath(std::string_view look, std::string_view data, std::string_view attributes = "");

std::string SvgRectangle(std::string_view look, const Box& box);

// Clips `content` to the box.
std::string SvgClipped(const Box& box, std::string_view content);

// `drawing` is a template: an .svg file with placeholders such as {{k_1}}. Returns it with each placeholder
// replaced by its text, escaped. Throws std::logic_error naming a placeholder without a text, or a text
// without a placeholder.
std::string FillDrawing(std::string_view drawing, const std::map<std::string, std::string>& texts);

}  // namespace hydro::page
