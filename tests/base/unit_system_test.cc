#include "base/unit_system.h"

#include <gmock/gmock.h>

#include "base/units.h"

namespace hydro {
namespace {

using testing::Contains;
using testing::Not;

constexpr UnitSystem kMillimetres{"mm", "N", false};
constexpr UnitSystem kCylinder{"in", "lbf", true};

// Tests that the paper's units stay as they are written.
TEST(UnitSystemTest, ThePapers) {
  for (const char* unit : {"psi", "in-lbf-s", "in^3/(s psi)", "in^3/s/psi^.5", "rad/s", "name", ""}) {
    EXPECT_EQ(UnitSystem{}.UnitFor(unit), unit);
    EXPECT_EQ(UnitSystem{}.UnitFor(unit, -2), unit);
  }
}

// Tests every kind of unit in SI, in mm and N, and in a system whose pressure has no name.
TEST(UnitSystemTest, Others) {
  constexpr UnitSystem kCentimetres{"cm", "N", false};
  const struct {
    const char* paper;
    const char* si;
    const char* millimetres;
    const char* centimetres;
  } rows[] = {{"psi", "Pa", "MPa", "N/cm^2"},
              {"psi/s", "Pa/s", "MPa/s", "N/(cm^2 s)"},
              {"in-lbf/V", "N m/V", "N mm/V", "N cm/V"},
              {"in-lbf", "N m", "N mm", "N cm"},
              {"lbf-in-s^2", "N m s^2", "N mm s^2", "N cm s^2"},
              {"in-lbf-s", "N m s", "N mm s", "N cm s"},
              {"in-lbf/psi", "N m/Pa", "N mm/MPa", "cm^3"},
              {"in^3", "m^3", "mm^3", "cm^3"},
              {"in^3/rad", "m^3/rad", "mm^3/rad", "cm^3/rad"},
              {"in^3/(s psi)", "m^3/(s Pa)", "mm^3/(s MPa)", "cm^5/(N s)"},
              {"in^3/s/psi", "m^3/(s Pa)", "mm^3/(s MPa)", "cm^5/(N s)"},
              {"in^3/s/psi^.5", "m^3/(s Pa^.5)", "mm^3/(s MPa^.5)", "cm^4/(N^.5 s)"},
              {"psi/in^3", "Pa/m^3", "MPa/mm^3", "N/cm^5"},
              {"1/psi", "1/Pa", "1/MPa", "cm^2/N"},
              {"rad/s", "rad/s", "rad/s", "rad/s"},
              {"1/rev", "1/rev", "1/rev", "1/rev"},
              {"Hz", "Hz", "Hz", "Hz"},
              {"1", "1", "1", "1"},
              {"name", "name", "name", "name"}};
  for (const auto& row : rows) {
    EXPECT_EQ(kSiUnits.UnitFor(row.paper), row.si);
    EXPECT_EQ(kMillimetres.UnitFor(row.paper), row.millimetres);
    EXPECT_EQ(kCentimetres.UnitFor(row.paper), row.centimetres);
    if (const std::optional<Unit> paper = ParseUnit(row.paper)) {
      EXPECT_EQ(ParseUnit(row.si)->powers, paper->powers) << row.paper;
      EXPECT_EQ(ParseUnit(row.centimetres)->powers, paper->powers) << row.paper;
    }
  }
}

// Tests that the arm's quantities count in the arm's coordinate where that is a length.
TEST(UnitSystemTest, LinearArm) {
  EXPECT_EQ(kCylinder.UnitFor("rad", 1), "in");
  EXPECT_EQ(kCylinder.UnitFor("rad/s", 1), "in/s");
  EXPECT_EQ(kCylinder.UnitFor("rad/s", 0), "rad/s");
  EXPECT_EQ(kCylinder.UnitFor("in^3/rad", -1), "in^2");
  EXPECT_EQ(kCylinder.UnitFor("in-lbf/psi", -1), "lbf/psi");
  EXPECT_EQ(kCylinder.UnitFor("lbf-in-s^2", -2), "lbf-s^2/in");
  EXPECT_EQ(kCylinder.UnitFor("in-lbf", -1), "lbf");
  EXPECT_EQ(kCylinder.UnitFor("in-lbf/rad", -2), "lbf/in");
  EXPECT_EQ(kCylinder.UnitFor("in-lbf"), "in-lbf");
  EXPECT_EQ((UnitSystem{"m", "N", true}.UnitFor("lbf-in-s^2", -2)), "N s^2/m");
}

// Tests that models may name units of the right kind, and each once.
TEST(UnitSystemTest, Names) {
  EXPECT_THAT(LengthUnits(), Contains("mm"));
  EXPECT_THAT(LengthUnits(), Not(Contains("lbf")));
  EXPECT_THAT(ForceUnits(), Contains("kN"));
  EXPECT_THAT(ForceUnits(), Not(Contains("lb")));
}

}  // namespace
}  // namespace hydro
