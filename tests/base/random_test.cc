// Random numbers.
#include "base/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydro {
namespace {

// Tests the sequence against the numbers that the authors' program prints for seed 1234567, and that a number
// of it needs none of those before.
TEST(RandomTest, IsSplitMix64) {
  const uint64_t published[] = {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                4593380528125082431u, 16408922859458223821u};
  Random random(1234567);
  uint64_t state = 1234567;
  for (const uint64_t number : published) {
    EXPECT_EQ(random.Next(), number);
    EXPECT_EQ(Scatter(state), number);
    state += 0x9e3779b97f4a7c15u;
  }
}

// Tests names' hashes against the published ones of FNV-1a.
TEST(RandomTest, HashesNames) {
  EXPECT_EQ(NameKey(""), 0xcbf29ce484222325u);
  EXPECT_EQ(NameKey("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(NameKey("foobar"), 0x85944171f73967e8u);
}

// Tests that a number depends on its key alone, and that neighbouring keys have unrelated ones.
TEST(RandomTest, IsNormalByKey) {
  const int n = 100000;
  double sum = 0, squares = 0, neighbours = 0;
  for (uint64_t key = 0; key < n; ++key) {
    const double x = StandardNormal(key);
    sum += x;
    squares += x * x;
    neighbours += x * StandardNormal(key + 1);
  }
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(neighbours / n, 0, 5 / std::sqrt(n));
  EXPECT_EQ(StandardNormal(7), StandardNormal(7));
}

}  // namespace
}  // namespace hydro
