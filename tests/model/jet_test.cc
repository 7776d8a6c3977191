// Dual numbers: their values are those of double to the last bit, their derivatives those of calculus.
#include "model/terms/jet.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace hydro::model {
namespace {

Jet Seeded(double value, int direction) {
  Jet jet(value);
  jet.SetDerivative(direction, 1);
  return jet;
}

void ExpectBits(const Jet& jet, double value, const char* what) {
  EXPECT_EQ(std::bit_cast<uint64_t>(jet.a), std::bit_cast<uint64_t>(value)) << what << ": " << value;
}

// Pairs of numbers of all sizes that the model meets, both signs, zeros among them.
std::vector<std::pair<double, double>> Pairs() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-12, 9), sign(-1, 1);
  const auto number = [&] { return std::copysign(std::pow(10, exponent(random)), sign(random)); };
  std::vector<std::pair<double, double>> pairs = {{0, 1}, {-0.0, -2}, {1, 1}, {0.1, -0.3}};
  for (int i = 0; i < 2000; ++i) {
    const double first = number();
    pairs.emplace_back(first, number());
  }
  return pairs;
}

// Tests that each operation between jets, and between a jet and a number, rounds as that of double does.
TEST(Jet, OperationsHaveTheBitsOfDouble) {
  for (const auto& [x, y] : Pairs()) {
    const Jet a = Seeded(x, 0), b = Seeded(y, 1);
    ExpectBits(+a, x, "+x");
    ExpectBits(-a, -x, "-x");
    ExpectBits(a + b, x + y, "x + y");
    ExpectBits(a - b, x - y, "x - y");
    ExpectBits(a * b, x * y, "x * y");
    ExpectBits(a / b, x / y, "x / y");
    ExpectBits(a + y, x + y, "x + number");
    ExpectBits(x + b, x + y, "number + y");
    ExpectBits(a - y, x - y, "x - number");
    ExpectBits(x - b, x - y, "number - y");
    ExpectBits(a * y, x * y, "x * number");
    ExpectBits(x * b, x * y, "number * y");
    ExpectBits(a / y, x / y, "x / number");
    ExpectBits(x / b, x / y, "number / y");
    Jet c = a;
    ExpectBits(c += b, x + y, "x += y");
    ExpectBits(c -= b, x + y - y, "x -= y");
    ExpectBits(c = a, x, "x = y");
    ExpectBits(c *= b, x * y, "x *= y");
    ExpectBits(c /= b, x * y / y, "x /= y");
    c = a;
    ExpectBits(c += y, x + y, "x += number");
    ExpectBits(c -= y, x + y - y, "x -= number");
    ExpectBits(c *= y, (x + y - y) * y, "x *= number");
  }
}

// Tests the same of functions.
TEST(Jet, FunctionsHaveTheBitsOfDouble) {
  for (const auto& [x, y] : Pairs()) {
    ExpectBits(abs(Seeded(x, 0)), std::abs(x) == 0 ? x : std::abs(x), "abs");
    ExpectBits(sqrt(Seeded(std::abs(x), 0)), std::sqrt(std::abs(x)), "sqrt");
    ExpectBits(exp(Seeded(std::fmod(x, 300), 0)), std::exp(std::fmod(x, 300)), "exp");
    ExpectBits(sin(Seeded(x, 0)), std::sin(x), "sin");
    ExpectBits(cos(Seeded(x, 0)), std::cos(x), "cos");
    const double exponent = std::fmod(y, 3);
    ExpectBits(pow(Seeded(std::abs(x), 0), exponent), std::pow(std::abs(x), exponent), "pow");
  }
}

// Tests that comparisons look at the values alone.
TEST(Jet, ComparesValues) {
  const Jet one = Seeded(1, 0), also_one = Seeded(1, 3), two(2);
  EXPECT_TRUE(one == also_one && one <= also_one && one >= also_one);
  EXPECT_FALSE(one < also_one || one > also_one || one == two);
  EXPECT_TRUE(one < two && two > one && one <= two && two >= one);
}

void ExpectSlopes(const Jet& jet, double by_x, double by_y, const char* what) {
  EXPECT_NEAR(jet.v[0], by_x, 1e-14 * std::abs(by_x)) << what;
  EXPECT_NEAR(jet.v[kJetWidth - 1], by_y, 1e-14 * std::abs(by_y)) << what;
  for (int i = 1; i + 1 < kJetWidth; ++i) EXPECT_EQ(jet.v[i], 0) << what;
}

// Tests derivatives against closed forms, along the first and the last direction.
TEST(Jet, DerivativesAreThoseOfCalculus) {
  for (const auto& [x, y] : {std::pair{0.7, -1.9}, {-250.0, 0.03}, {3e-4, 8.0}}) {
    const Jet a = Seeded(x, 0), b = Seeded(y, kJetWidth - 1);
    ExpectSlopes(-a, -1, 0, "-x");
    ExpectSlopes(a + b, 1, 1, "x + y");
    ExpectSlopes(a - b, 1, -1, "x - y");
    ExpectSlopes(a * b, y, x, "x * y");
    ExpectSlopes(a / b, 1 / y, -x / (y * y), "x / y");
    ExpectSlopes(a + 5.0, 1, 0, "x + number");
    ExpectSlopes(5.0 - a, -1, 0, "number - x");
    ExpectSlopes(a * 5.0, 5, 0, "x * number");
    ExpectSlopes(a / 5.0, 0.2, 0, "x / number");
    ExpectSlopes(5.0 / a, -5 / (x * x), 0, "number / x");
    Jet c = a;
    ExpectSlopes(c += b, 1, 1, "x += y");
    ExpectSlopes(c -= a, 0, 1, "x -= y");
    ExpectSlopes((c = a) *= b, y, x, "x *= y");
    ExpectSlopes((c = a) /= b, 1 / y, -x / (y * y), "x /= y");
    ExpectSlopes((c = a) *= a, 2 * x, 0, "x *= x");
    ExpectSlopes((c = a) /= 1.0 * a, 0, 0, "x /= x");
    ExpectSlopes(abs(a), x < 0 ? -1 : 1, 0, "abs");
    ExpectSlopes(exp(b), 0, std::exp(y), "exp");
    ExpectSlopes(sin(a), std::cos(x), 0, "sin");
    ExpectSlopes(cos(a), -std::sin(x), 0, "cos");
    ExpectSlopes(sqrt(abs(a)), (x < 0 ? -0.5 : 0.5) / std::sqrt(std::abs(x)), 0, "sqrt");
    ExpectSlopes(pow(abs(a), 2.5), (x < 0 ? -2.5 : 2.5) * std::pow(std::abs(x), 1.5), 0, "pow");
    // The chain rule through several: d/dx, d/dy of sin(x y) / (1 + x^2).
    const double below = 1 + x * x;
    const Jet chain = sin(a * b) / (1.0 + a * a);
    EXPECT_NEAR(chain.v[0], y * std::cos(x * y) / below - 2 * x * std::sin(x * y) / (below * below),
                1e-13 * (1 + std::abs(y)));
    EXPECT_NEAR(chain.v[kJetWidth - 1], x * std::cos(x * y) / below, 1e-13);
  }
}

// Tests that |x| at 0 has a slope, and a finite one: rates at rest are differentiated there.
TEST(Jet, AbsoluteValueAtZero) {
  EXPECT_EQ(abs(Seeded(0, 0)).a, 0);
  EXPECT_TRUE(std::isfinite(abs(Seeded(0, 0)).v[0]));
}

}  // namespace
}  // namespace hydro::model
