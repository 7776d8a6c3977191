#include "base/units.h"

#include <gtest/gtest.h>

namespace hydro {
namespace {

// Tests the displayed units against handbook values, and that both unit systems measure the same.
TEST(UnitsTest, ShownInSi) {
  const struct {
    const char* from;
    const char* to;
    double factor;
  } rows[] = {{"psi", "kPa", 6.894757293},
              {"in", "mm", 25.4},
              {"in/s", "m/s", 0.0254},
              {"in^2", "cm^2", 6.4516},
              {"in^3", "cm^3", 16.387064},
              {"in^3/rad", "cm^3/rad", 16.387064},
              {"in^3/(s psi)", "cm^3/(s MPa)", 2376.742},
              {"in^3/s/psi", "cm^3/s/MPa", 2376.742},
              {"in^3/s/psi^.5", "cm^3/s/MPa^.5", 197.3521},
              {"lbf", "N", 4.448221615},
              {"in-lbf", "N m", 0.1129848290},
              {"in-lb", "N m", 0.1129848290},
              {"ft-lbf", "N m", 1.355817948},
              {"in-lbf-s^2", "kg m^2", 0.1129848290},
              {"lbf-in-s^2", "kg m^2", 0.1129848290},
              {"in-lbf/psi", "N m/MPa", 16.387064},
              {"V/psi", "V/MPa", 145.0377377},
              {"psi s/rad", "kPa s/rad", 6.894757293},
              {"psi/in^3", "kPa/cm^3", 0.4207439},
              {"1/psi", "1/MPa", 145.0377377}};
  for (const auto& row : rows) {
    const std::optional<SiUnit> shown = FindSiUnit(row.from, 0);
    ASSERT_TRUE(shown.has_value()) << row.from;
    EXPECT_EQ(shown->to, row.to);
    EXPECT_NEAR(shown->factor / row.factor, 1, 1e-6) << row.from;
    EXPECT_EQ(ParseUnit(row.from)->powers, ParseUnit(row.to)->powers) << row.from;
  }
  EXPECT_EQ(FindSiUnit("psi", -200)->to, "MPa");
  EXPECT_FALSE(FindSiUnit("rad/s", 1).has_value());
  EXPECT_FALSE(FindSiUnit("furlong", 1).has_value());
}

// Tests compound units, and that nothing else is mistaken for one.
TEST(UnitsTest, ParsesCompoundUnits) {
  const std::optional<Unit> stiffness = ParseUnit("psi/(in^3 s^2)");
  ASSERT_TRUE(stiffness.has_value());
  EXPECT_DOUBLE_EQ(stiffness->size, kPsi / (kInch * kInch * kInch));
  EXPECT_EQ(stiffness->powers, (std::array<double, 4>{-4, 1, -4, 0}));
  EXPECT_DOUBLE_EQ(ParseUnit("rpm")->size, kRpm);
  for (const char* text :
       {"", "psi/", "psi//s", "(psi", "psi)", "psi^", "psi^x", "furlong", "psi*s", "2 psi"}) {
    EXPECT_FALSE(ParseUnit(text).has_value()) << text;
  }
  EXPECT_FALSE(ParseUnit(std::string(100'000, '(')).has_value());
}

}  // namespace
}  // namespace hydro
