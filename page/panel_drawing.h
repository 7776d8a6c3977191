// One panel of a figure: gnuplot draws axes, grid and curves; all texts but the tick labels are set here.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "page/curve_style.h"
#include "page/panel_geometry.h"
#include "page/plot.h"

namespace hydro::page {

inline constexpr char kFontFamily[] = "Helvetica, Arial, sans-serif";

struct TextStyle {
  double size = 12;  // pixels
  const char* colour = "#000000";
  const char* anchor = "start";
  bool bold = false;
  bool halo = false;     // a white rim, so that it can be read on lines
  bool upwards = false;  // turned by 90 degrees
};

// A <text> element; `text` as page/plot.h describes.
std::string SvgText(const std::string& text, double x, double y, const TextStyle& style);

class PanelDrawing {
 public:
  // `panel` must outlive this. The key is set between `left` and `right`.
  PanelDrawing(const Panel& panel, double left, double right);

  // What title and key need above the frame.
  double head_height() const;

  // Before what follows. Throws as FitPanel().
  void Fit(const Box& frame, const std::string& where);

  void WriteData(std::ostream& script, size_t number) const;
  void WritePlot(std::ostream& script, size_t number, double width, double height) const;
  // SVG elements; markers in the key are those of the picture `name`.
  std::string Texts(const std::string& name);

 private:
  struct KeyEntry {
    size_t curve = 0;
    double x = 0;
    int row = 0;
  };

  std::string Key(const std::string& name) const;
  std::string Labels() const;
  std::vector<size_t> Drawn(const Curve& curve) const;

  const Panel* panel_;
  double left_;
  std::vector<CurveStyle> styles_;
  std::vector<KeyEntry> key_;
  PanelGeometry geometry_;
};

}  // namespace hydro::page
