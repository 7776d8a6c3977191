// Numbers that no rig has.
#include "diagnose/verdict/plausible.h"

#include <gmock/gmock.h>

#include "tests/table1.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

diagnose::ChangedParameter Moved(double given, double value, double low, double high) {
  diagnose::ChangedParameter changed;
  changed.fitted = {"p_3", value, low, high, "psi"};
  changed.model = given;
  return changed;
}

diagnose::FoundEffect With(const std::string& id, const std::string& name, double value) {
  diagnose::FoundEffect found;
  found.id = id;
  found.parameters = {{name, value, value, value, ""}};
  return found;
}

// Tests that a move by more than a factor of two is remarked on, down as well as up, and nothing of what was 0.
TEST(Plausible, RemarksOnAFactorOfTwo) {
  EXPECT_EQ(diagnose::WhyRemarkable(Moved(100, 190, 180, 200)), "");
  EXPECT_EQ(diagnose::WhyRemarkable(Moved(100, 300, 290, 310)), "moves by a factor of 3");
  EXPECT_EQ(diagnose::WhyRemarkable(Moved(100, 25, 20, 30)), "moves by a factor of 0.25");
  EXPECT_EQ(diagnose::WhyRemarkable(Moved(0, 25, 20, 30)), "");
}

// Tests that a parameter is implausible by decades if it moves by a factor of ten and its interval says so.
TEST(Plausible, DecadesOfAParameter) {
  const auto lines = [](const diagnose::ChangedParameter& changed) {
    return diagnose::Implausible({changed}, {}, Table1());
  };
  EXPECT_THAT(lines(Moved(100, 2000, 1900, 2100)), ElementsAre("p_3 = 2000 instead of 100"));
  EXPECT_THAT(lines(Moved(100, 5, 4, 6)), ElementsAre(HasSubstr("p_3 = 5")));
  EXPECT_THAT(lines(Moved(100, -20, -21, -19)), ElementsAre(HasSubstr("p_3 = -20")));
  EXPECT_THAT(lines(Moved(100, 600, 500, 700)), IsEmpty());
  EXPECT_THAT(lines(Moved(100, 1500, 0, 4000)), IsEmpty()) << "the runs say nothing of it";
}

// Tests the limits of effects: by name, by the model's torque and bulk modulus, and of times.
TEST(Plausible, LimitsOfEffects) {
  const auto lines = [](const diagnose::FoundEffect& found) {
    return diagnose::Implausible({}, {found}, Table1());
  };
  EXPECT_THAT(lines(With("pump.stribeck", "static_excess", 2)), IsEmpty());
  EXPECT_THAT(lines(With("pump.stribeck", "static_excess", 40)),
              ElementsAre("pump.stribeck.static_excess = 40, above 10"));
  EXPECT_THAT(lines(With("pump.friction_asymmetry", "coulomb", -0.5 * Table1().T_pmax)), IsEmpty());
  EXPECT_THAT(lines(With("pump.friction_asymmetry", "coulomb", -2 * Table1().T_pmax)),
              ElementsAre(HasSubstr("coulomb")));
  EXPECT_THAT(lines(With("amp.lag", "tau", 0.02)), IsEmpty());
  EXPECT_THAT(lines(With("amp.lag", "tau", 3)), ElementsAre(HasSubstr("tau = 3")));
  EXPECT_THAT(lines(With("valve.relief", "set", Table1().beta)), ElementsAre(HasSubstr("set")));
  EXPECT_THAT(lines(With("arm.flexure", "stiffness", 1e9)), IsEmpty()) << "has no limit";
}

}  // namespace
}  // namespace hydro::testing
