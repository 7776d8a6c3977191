// A number with its derivatives along kJetWidth directions (a dual number). ceres::Jet is as fast here, but
// its division rounds differently from that of plain numbers. With this class the values equal those of
// double to the last bit, so a response with derivatives takes the same steps and events as one without. It
// also saves about thirty files from including Eigen's headers.
#pragma once

#include <cmath>

namespace hydro::model {

inline constexpr int kJetWidth = 8;

// The derivatives. GCC handles a vector that is wider than the processor's registers number by number,
// through memory, in twice the time. There are therefore four narrow vectors, unless the file is compiled for
// AVX-512.
#if defined(__AVX512F__)
// NOLINTNEXTLINE(modernize-use-using): the attribute is of GCC's and Clang's C++
using JetVector [[gnu::vector_size(kJetWidth * sizeof(double)), gnu::aligned(16)]] = double;
#else
struct JetVector {
  // NOLINTNEXTLINE(modernize-use-using): the attribute is of GCC's and Clang's C++
  using Piece [[gnu::vector_size(2 * sizeof(double))]] = double;

  double operator[](int direction) const { return piece[direction / 2][direction % 2]; }

  Piece piece[4];
};
static_assert(sizeof(JetVector) == kJetWidth * sizeof(double));

// A vector made of the pieces of(0) to of(3).
template <class Of>
[[gnu::always_inline]] inline JetVector Pieces(const Of& of) {
  return {{of(0), of(1), of(2), of(3)}};
}
[[gnu::always_inline]] inline JetVector operator-(const JetVector& x) {
  return Pieces([&](int i) { return -x.piece[i]; });
}
[[gnu::always_inline]] inline JetVector operator+(const JetVector& x, const JetVector& y) {
  return Pieces([&](int i) { return x.piece[i] + y.piece[i]; });
}
[[gnu::always_inline]] inline JetVector operator-(const JetVector& x, const JetVector& y) {
  return Pieces([&](int i) { return x.piece[i] - y.piece[i]; });
}
[[gnu::always_inline]] inline JetVector operator*(const JetVector& x, double y) {
  return Pieces([&](int i) { return x.piece[i] * y; });
}
[[gnu::always_inline]] inline JetVector operator*(double x, const JetVector& y) { return y * x; }
[[gnu::always_inline]] inline JetVector operator/(const JetVector& x, double y) {
  return Pieces([&](int i) { return x.piece[i] / y; });
}
inline JetVector& operator+=(JetVector& x, const JetVector& y) { return x = x + y; }
inline JetVector& operator-=(JetVector& x, const JetVector& y) { return x = x - y; }
inline JetVector& operator*=(JetVector& x, double y) { return x = x * y; }
#endif

struct Jet {
  Jet() : a(0), v{} {}
  explicit Jet(double value) : a(value), v{} {}
  Jet(double value, const JetVector& derivatives) : a(value), v(derivatives) {}

  Jet& operator+=(const Jet& y) {
    a += y.a;
    v += y.v;
    return *this;
  }
  Jet& operator-=(const Jet& y) {
    a -= y.a;
    v -= y.v;
    return *this;
  }
  Jet& operator*=(const Jet& y) {
    v = v * y.a + a * y.v;
    a *= y.a;
    return *this;
  }
  Jet& operator/=(const Jet& y) {
    a /= y.a;
    v = (v - a * y.v) / y.a;
    return *this;
  }
  Jet& operator+=(double y) {
    a += y;
    return *this;
  }
  Jet& operator-=(double y) {
    a -= y;
    return *this;
  }
  Jet& operator*=(double y) {
    a *= y;
    v *= y;
    return *this;
  }

  void SetDerivative(int direction, double derivative) {
#if defined(__AVX512F__)
    v[direction] = derivative;
#else
    v.piece[direction / 2][direction % 2] = derivative;
#endif
  }

  double a;     // the value
  JetVector v;  // d/d each direction
};

inline Jet operator+(const Jet& x) { return x; }
inline Jet operator-(const Jet& x) { return {-x.a, -x.v}; }
inline Jet operator+(const Jet& x, const Jet& y) { return {x.a + y.a, x.v + y.v}; }
inline Jet operator-(const Jet& x, const Jet& y) { return {x.a - y.a, x.v - y.v}; }
inline Jet operator*(const Jet& x, const Jet& y) { return {x.a * y.a, x.v * y.a + x.a * y.v}; }
inline Jet operator/(const Jet& x, const Jet& y) {
  const double a = x.a / y.a;
  return {a, (x.v - a * y.v) * (1 / y.a)};
}
inline Jet operator+(const Jet& x, double y) { return {x.a + y, x.v}; }
inline Jet operator+(double x, const Jet& y) { return {x + y.a, y.v}; }
inline Jet operator-(const Jet& x, double y) { return {x.a - y, x.v}; }
inline Jet operator-(double x, const Jet& y) { return {x - y.a, -y.v}; }
inline Jet operator*(const Jet& x, double y) { return {x.a * y, x.v * y}; }
inline Jet operator*(double x, const Jet& y) { return {x * y.a, x * y.v}; }
inline Jet operator/(const Jet& x, double y) { return {x.a / y, x.v * (1 / y)}; }
inline Jet operator/(double x, const Jet& y) {
  const double a = x / y.a;
  return {a, (-a / y.a) * y.v};
}

inline bool operator<(const Jet& x, const Jet& y) { return x.a < y.a; }
inline bool operator>(const Jet& x, const Jet& y) { return x.a > y.a; }
inline bool operator==(const Jet& x, const Jet& y) { return x.a == y.a; }
inline bool operator<=(const Jet& x, const Jet& y) { return x.a <= y.a; }
inline bool operator>=(const Jet& x, const Jet& y) { return x.a >= y.a; }

inline Jet abs(const Jet& x) { return x.a < 0 ? -x : x; }
inline Jet sqrt(const Jet& x) {
  const double root = std::sqrt(x.a);
  return {root, (0.5 / root) * x.v};
}
inline Jet exp(const Jet& x) {
  const double power = std::exp(x.a);
  return {power, power * x.v};
}
inline Jet log(const Jet& x) { return {std::log(x.a), (1 / x.a) * x.v}; }
inline Jet sin(const Jet& x) { return {std::sin(x.a), std::cos(x.a) * x.v}; }
inline Jet cos(const Jet& x) { return {std::cos(x.a), -std::sin(x.a) * x.v}; }
inline Jet pow(const Jet& x, double exponent) {
  return {std::pow(x.a, exponent), (exponent * std::pow(x.a, exponent - 1)) * x.v};
}

}  // namespace hydro::model
