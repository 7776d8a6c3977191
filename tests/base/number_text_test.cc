#include "base/number_text.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

namespace hydro {
namespace {

// Tests that rounded numbers are printf's of the C locale, from 1 to 7 significant digits, but for whole
// numbers below ten million.
TEST(NumberTextTest, Rounded) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> power(-12, 12), sign(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const double value = std::copysign(std::pow(10, power(random)), sign(random));
    const int digits = 1 + k % 7;
    char text[64];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    const double size = std::abs(value);
    if (size >= 1 && size < 1e7 && std::string(text).find('e') != std::string::npos)
      std::snprintf(text, sizeof text, "%.0f", value);
    EXPECT_EQ(ShortNumber(value, digits), text) << value;
  }
  EXPECT_EQ(ShortNumber(81000, 2), "81000");
  EXPECT_EQ(ShortNumber(-0.0), "0");
  EXPECT_EQ(ShortNumber(2.6e-5), "2.6e-05");
  EXPECT_EQ(ShortNumber(NAN), "-");
}

// Tests that a stamp is a date, to the microsecond, and that of a simulated clock, which begins at 0,
// seconds.
TEST(NumberTextTest, Stamps) {
  EXPECT_EQ(StampText(1'795'714'394'000'123), "2026-11-26 17:33:14.000123 UTC");
  EXPECT_EQ(StampText(1'709'251'199'999'999), "2024-02-29 23:59:59.999999 UTC");
  EXPECT_EQ(StampText(12'500'000), "12.5 s");
  EXPECT_EQ(StampText(2'105'999), "2.105999 s");
  EXPECT_EQ(StampText(-1'000'000), "-1 s");
  EXPECT_EQ(StampText(std::numeric_limits<int64_t>::max()), "9223372036854.775 s");
}

// Tests that a program that has set a locale with decimal commas, as one that embeds these libraries may,
// gets points all the same.
TEST(NumberTextTest, InAnyLocale) {
  std::string found;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "fr_FR.utf8"}) {
    if (found.empty() && std::setlocale(LC_ALL, name) != nullptr) found = name;
  }
  const std::string shown = ShortNumber(1.25), exact = ShortestNumber(1.25), file = NumberText(1.25);
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(shown, "1.25");
  EXPECT_EQ(exact, "1.25");
  EXPECT_EQ(file, "1.25");
  if (found.empty()) GTEST_SKIP() << "no locale with decimal commas is installed (Debian: locales-all)";
}

}  // namespace
}  // namespace hydro
