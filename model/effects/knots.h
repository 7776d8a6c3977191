// Curves and surfaces through values at knots, for closures. Between two knots a curve is a cubic whose slope
// at each knot is that of the straight line between the knot's neighbours. Beyond the first and the last knot
// it continues straight. Its slope therefore has no jump, as an integrator with exact switch times requires.
// It is linear in its values, which suits a fit, it changes only near a value that changes, and it costs a
// few multiplications.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace hydro::model {

// The weights of the four knots around a place: value = sum of weight[i] * values[first + i], for i in
// [begin, end).
template <class T>
struct KnotWeights {
  std::array<T, 4> weight{};
  size_t begin = 0, end = 0;
  std::ptrdiff_t first = 0;  // -1 in the first interval, which has no knot before it
};

class Knots {
 public:
  // At least two, increasing.
  explicit Knots(std::vector<double> at) : at_(std::move(at)) {}

  size_t size() const { return at_.size(); }

  template <class T>
  KnotWeights<T> Around(const T& x) const {
    const size_t last = at_.size() - 1;
    const auto above = std::upper_bound(at_.begin() + 1, at_.begin() + static_cast<std::ptrdiff_t>(last), x,
                                        [](const T& value, double knot) { return value < T(knot); });
    const auto i = static_cast<size_t>(above - at_.begin()) - 1;
    const double h = at_[i + 1] - at_[i];
    const T t = (x - at_[i]) / h;
    KnotWeights<T> w;
    w.first = static_cast<std::ptrdiff_t>(i) - 1;
    w.weight[1] = 1.0 - t;
    w.weight[2] = t;
    w.begin = 1;
    w.end = 3;
    if (x < T(at_.front()) || x > T(at_.back())) return w;
    // The cubic is the straight line plus a bend, given by how far the slope at each end differs from the
    // line's.
    const T rest = 1.0 - t;
    const T from_left = t * rest * rest, from_right = -(t * t * rest);
    if (i > 0) {
      Bend(from_left, h / (at_[i + 1] - at_[i - 1]), 0, 2, &w);
      w.begin = 0;
    }
    if (i + 1 < last) {
      Bend(from_right, h / (at_[i + 2] - at_[i]), 1, 3, &w);
      w.end = 4;
    }
    return w;
  }

 private:
  // Adds `by` times the slope at a knot less that of the interval, both multiplied by the interval's length.
  // The knot's slope times that length is `part` times the difference of the values from `left` to `right`.
  template <class T>
  static void Bend(const T& by, double part, size_t left, size_t right, KnotWeights<T>* w) {
    const T turned = by * part;
    w->weight[left] -= turned;
    w->weight[right] += turned;
    w->weight[1] += by;
    w->weight[2] -= by;
  }

  std::vector<double> at_;
};

}  // namespace hydro::model
