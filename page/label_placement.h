// Places a label in a panel where it hides least.
#pragma once

#include <vector>

namespace hydro::page {

// In pixels, with y downwards.
struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

// A coarse raster of what is drawn in a panel.
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

}  // namespace hydro::page
