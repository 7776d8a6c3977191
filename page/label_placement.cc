#include "page/label_placement.h"

#include <algorithm>
#include <cmath>

namespace hydro::page {
namespace {

constexpr double kCell = 3;        // pixels
constexpr int kLabelWeight = 50;   // covering a label is worse than covering a curve
constexpr double kOutside = 1000;  // leaving the frame is worst

}  // namespace

LabelPlacement::LabelPlacement(const Box& frame)
    : frame_(frame),
      columns_(std::max(1, static_cast<int>((frame.right - frame.left) / kCell) + 1)),
      rows_(std::max(1, static_cast<int>((frame.bottom - frame.top) / kCell) + 1)),
      cells_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_)) {}

void LabelPlacement::AddStroke(double x0, double y0, double x1, double y1) {
  const double length = std::hypot(x1 - x0, y1 - y0);
  if (!std::isfinite(length)) return;
  // Follow a line far beyond the frame only for a limited distance.
  const int steps = std::clamp(static_cast<int>(std::min(length / kCell, 2000.0)) + 1, 1, 2000);
  for (int i = 0; i <= steps; ++i) {
    const double column = (x0 + (x1 - x0) * i / steps - frame_.left) / kCell;
    const double row = (y0 + (y1 - y0) * i / steps - frame_.top) / kCell;
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
    cells_[static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)] = 1;
  }
}

double LabelPlacement::Cost(const Box& box) const {
  double cost = 0;
  if (box.left < frame_.left || box.right > frame_.right || box.top < frame_.top ||
      box.bottom > frame_.bottom) {
    cost += kOutside;
  }
  const auto index = [](double pixels, double origin, int count) {
    return std::clamp(static_cast<int>(std::clamp((pixels - origin) / kCell, -1e6, 1e6)), 0, count - 1);
  };
  for (int row = index(box.top, frame_.top, rows_); row <= index(box.bottom, frame_.top, rows_); ++row) {
    for (int column = index(box.left, frame_.left, columns_);
         column <= index(box.right, frame_.left, columns_); ++column) {
      cost += cells_[static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)];
    }
  }
  return cost;
}

Box LabelPlacement::Place(const std::vector<Box>& candidates) {
  const Box best = *std::min_element(candidates.begin(), candidates.end(),
                                     [this](const Box& a, const Box& b) { return Cost(a) < Cost(b); });
  for (double y = best.top; y <= best.bottom; y += kCell) {
    for (double x = best.left; x <= best.right; x += kCell) {
      const double column = (x - frame_.left) / kCell;
      const double row = (y - frame_.top) / kCell;
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      cells_[static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)] =
          kLabelWeight;
    }
  }
  return best;
}

}  // namespace hydro::page
