#include "tune/design/paper_units.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "tests/model/model_case.h"
#include "tests/model_in_units.h"

namespace hydro::design {
namespace {

struct Linear {
  model::LinearModel model;
  std::vector<double> scales;
};

Linear LinearOf(const model::ModelDescription& model) {
  const model::Equations equations(model, {});
  double state[model::kMaxStates];
  model::Mode mode;
  equations.Start(NAN, state, &mode);
  mode.pump = 1;
  return {model::Linearise(equations, 0, 0, mode, state), equations.scales()};
}

void ExpectAlike(const std::vector<double>& found, const std::vector<double>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-9 * std::abs(wanted[i])) << i;
}

// Tests that the model of a rig in any units becomes that of the same rig in the paper's, with an effect's
// states too, and that the paper's own stays as it is, bit by bit.
TEST(PaperUnits, ModelsAreThePapers) {
  for (const bool linear : {false, true}) {
    model::ModelDescription rig = hydro::testing::Table1Model({hydro::testing::Wave(500, 0.1, 0.05)});
    rig.units.linear_arm = linear;
    const Linear paper = LinearOf(rig);
    const model::LinearModel same = PaperUnits(rig.units).Model(paper.model, paper.scales);
    EXPECT_EQ(same.A, paper.model.A);
    EXPECT_EQ(same.C, paper.model.C);
    rig.effects.clear();
    const Linear plain = LinearOf(rig);
    for (const UnitSystem& system : hydro::testing::kSystems) {
      const UnitSystem units = hydro::testing::WithArm(system, linear);
      const Linear own = LinearOf(hydro::testing::InUnits(rig, units));
      const model::LinearModel found = PaperUnits(units).Model(own.model, own.scales);
      ExpectAlike(found.A, plain.model.A);
      ExpectAlike(found.B, plain.model.B);
      ExpectAlike(found.C, plain.model.C);
    }
  }
}

// Tests that gains become the paper's: 1 V/Pa is 6895 V/psi.
TEST(PaperUnits, LawsAreThePapers) {
  const pressure_ctrl::PressureLawSettings pressure = {.gains = {.k_p = 1e-5, .k_v = 5e4},
                                                       .arm_speed_ratio = 100};
  const pressure_ctrl::PressureLawSettings si = PaperUnits(kSiUnits).Law(pressure);
  EXPECT_DOUBLE_EQ(si.gains.k_p, 1e-5 * kPsi);
  EXPECT_DOUBLE_EQ(si.gains.k_v, 5e4 / kPsi);
  EXPECT_DOUBLE_EQ(si.arm_speed_ratio, 100) << "of an arm that turns";
  EXPECT_DOUBLE_EQ(PaperUnits({"m", "N", true}).Law(pressure).arm_speed_ratio, 100 * kInch)
      << "rad/m to rad/in";
  const position_ctrl::PositionLawSettings position = {.c1 = 1e6, .c2 = 2e5};
  EXPECT_DOUBLE_EQ(PaperUnits(kSiUnits).Law(position).c1, 1e6 / kPsi);
  EXPECT_DOUBLE_EQ(PaperUnits({"m", "N", true}).Law(position).c2, 2e5 / kPsi * kInch);
  EXPECT_EQ(PaperUnits({}).Law(position).c1, 1e6);
}

}  // namespace
}  // namespace hydro::design
