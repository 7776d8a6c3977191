#include "base/units.h"

#include <gtest/gtest.h>

#include "base/unit_system.h"

namespace hydro {
namespace {

// Tests that of a unit that is spelled in another way ours is named, one of the quantity that is wanted; and
// nothing of a unit of another quantity, or a word that is none.
TEST(UnitsTest, OtherSpellings) {
  const struct {
    const char* theirs;
    const char* wanted;
    const char* ours;
  } rows[] = {{"Nm", "in-lbf", "N m"},
              {"NM", "in-lbf", "N m"},
              {"N*m", "in-lbf", "N m"},
              {"N·m", "in-lbf", "N m"},
              {"kNm", "N m", "kN m"},
              {"Nmm", "N m", "N mm"},
              {"inlbf", "N m", "in lbf"},
              {"Nm/rad", "in-lbf/rad", "N m/rad"},
              {"mpa/rad", "psi/rad", "MPa/rad"},
              {"MPA", "psi", "MPa"},
              {"Bar", "psi", "bar"},
              {"KHZ", "Hz", "kHz"},
              {"V/PSI", "V/psi", "V/psi"},
              {"degrees", "rad", "deg"},
              {"°/s", "rad/s", "deg/s"},
              {"Rpm", "rad/s", "rpm"},
              {"rad/s²", "rad/s^2", "rad/s^2"},
              {"µs", "s", "us"},
              {"msec", "s", "ms"},
              {"Nm", "psi", ""},
              {"furlong", "in", ""},
              {"", "in", ""},
              {"((((((((((", "in", ""}};
  for (const auto& row : rows) EXPECT_EQ(UnitMeant(row.theirs, row.wanted), row.ours) << row.theirs;
  EXPECT_DOUBLE_EQ(ParseUnit("kHz")->size, 1000);
}

// Tests the displayed units against handbook values, and that both unit systems measure the same.
TEST(UnitsTest, ShownInSi) {
  const struct {
    const char* from;
    const char* to;
    double factor;
  } rows[] = {{"psi", "kPa", 6.894757293},
              {"in", "m", 0.0254},
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
  EXPECT_FALSE(FindSiUnit("N m", 1).has_value());
  EXPECT_FALSE(FindSiUnit("m", 0.03).has_value()) << "a length is in m, whatever its size";
  EXPECT_EQ(FindSiUnit("mm", 30)->to, "m");
  EXPECT_FALSE(FindSiUnit("kPa", 1).has_value());
  EXPECT_FALSE(FindSiUnit("furlong", 1).has_value());
}

// Tests that other systems' units are shown in the same SI units, and pressures by their size in Pa.
TEST(UnitsTest, OtherSystemsInSi) {
  const struct {
    const char* from;
    double size;
    const char* to;
    double factor;
  } rows[] = {{"Pa", 1723242, "MPa", 1e-6},
              {"Pa", 7e5, "kPa", 1e-3},
              {"MPa", 0.5, "kPa", 1e3},
              {"bar", 3, "kPa", 100},
              {"m^3/(s Pa)", 1, "cm^3/(s MPa)", 1e12},
              {"N mm", 1, "N m", 1e-3},
              {"m^3", 1, "cm^3", 1e6},
              {"N m s^2", 1, "kg m^2", 1},
              {"m^3/(s Pa^.5)", 1, "cm^3/s/MPa^.5", 1e9}};
  for (const auto& row : rows) {
    const std::optional<SiUnit> shown = FindSiUnit(row.from, row.size);
    ASSERT_TRUE(shown.has_value()) << row.from;
    EXPECT_EQ(shown->to, row.to);
    EXPECT_NEAR(shown->factor / row.factor, 1, 1e-12) << row.from;
  }
}

// Tests that angles and turns are told from plain numbers: 1 Hz is no motor speed of 1 rad/s.
TEST(UnitsTest, Angles) {
  EXPECT_NE(ParseUnit("Hz")->powers, ParseUnit("rad/s")->powers);
  EXPECT_EQ(ParseUnit("rpm")->powers, ParseUnit("deg/s")->powers);
  EXPECT_NEAR(ParseUnit("rev/min")->size, kRpm, 1e-15);
  EXPECT_NEAR(ParseUnit("bar")->size / kPsi, 14.503773773, 1e-8);
}

// Tests compound units, and that nothing else is mistaken for one.
TEST(UnitsTest, ParsesCompoundUnits) {
  const std::optional<Unit> stiffness = ParseUnit("psi/(in^3 s^2)");
  ASSERT_TRUE(stiffness.has_value());
  EXPECT_DOUBLE_EQ(stiffness->size, kPsi / (kInch * kInch * kInch));
  EXPECT_EQ(stiffness->powers, (std::array<double, 7>{-4, 1, -4, 0, 0}));
  EXPECT_DOUBLE_EQ(ParseUnit("rpm")->size, kRpm);
  for (const char* text :
       {"", "psi/", "psi//s", "(psi", "psi)", "psi^", "psi^x", "furlong", "psi*s", "2 psi"}) {
    EXPECT_FALSE(ParseUnit(text).has_value()) << text;
  }
  EXPECT_FALSE(ParseUnit(std::string(100'000, '(')).has_value());
}

}  // namespace
}  // namespace hydro
