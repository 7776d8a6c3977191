// One panel of a figure as SVG: axes, grid, curves, key and labels.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "page/curves.h"
#include "page/panel_geometry.h"
#include "page/plot.h"

namespace hydro::page {

class PanelDrawing {
 public:
  // `panel` must outlive this object; `where` is for messages. Throws as FitPanel() does.
  PanelDrawing(const Panel& panel, const std::string& where);

  // The room that ticks and labels need to the left of a frame of that height, and below it.
  double LeftMargin(double frame_height) const;
  double FootHeight() const;
  // The room that title and key need above the frame, with a key of that width.
  double HeadHeight(double key_width);

  // The panel's SVG elements. Call HeadHeight() first. `left_margin` must be at least LeftMargin(), and may
  // be larger so that the labels of panels below each other line up.
  std::string Draw(const Box& frame, double left_margin);

 private:
  struct KeyEntry {
    std::string label;
    const CurveStyle* style;  // null for a band
    bool bars;
    double x;
    int row;
  };

  std::string Bands() const;
  std::string Axes() const;
  std::string Rules() const;
  std::string CurveElements(size_t number) const;
  std::string Key() const;
  std::string Labels() const;
  std::string NoteElements(const Note& note, class LabelPlacement& placement) const;
  std::string RuleLabel(const Rule& rule, class LabelPlacement& placement) const;
  std::string LineData(const Curve& curve) const;
  std::vector<size_t> Drawn(const Curve& curve) const;

  const Panel* panel_;
  std::string where_;
  std::vector<CurveStyle> styles_;
  std::vector<KeyEntry> key_;
  double head_height_ = 0;
  PanelGeometry geometry_;
};

}  // namespace hydro::page
