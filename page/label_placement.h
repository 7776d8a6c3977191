// Where a label in a panel hides least.
#pragma once

#include <vector>

namespace hydro::page {

// In pixels, y downwards.
struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

// What is drawn in a panel, as a coarse raster.
class LabelPlacement {
 public:
  explicit LabelPlacement(const Box& frame);

  // A stroke from one point to another; parts outside the frame do not count.
  void AddStroke(double x0, double y0, double x1, double y1);

  // The first of the candidates that hides least and lies within the frame; it then counts as taken.
  // `candidates` must not be empty.
  Box Place(const std::vector<Box>& candidates);

 private:
  double Cost(const Box& box) const;

  Box frame_;
  int columns_;
  int rows_;
  std::vector<int> cells_;  // how much is drawn there
};

}  // namespace hydro::page
