#include "diagnose/data/twin_pressures.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;

runs::MeasuredRun Recorded(bool bypass, double volts) {
  testing::NoisyRig rig;
  rig.model = {"Table 1", testing::Table1(), {}};
  rig.angle_measured = volts > 1;  // below, the motor does not turn
  return rig
      .Record("run", model::Shaft::kClamped, 0, 1, bypass,
              [volts](double t) { return std::sin(9 * t) > 0 ? volts : -volts; })
      .measured;
}

// Tests that an open bypass that is not stated is named with the line that mends it, and a stated one is not.
TEST(TwinPressures, OpenBypass) {
  runs::MeasuredRun run = Recorded(true, 3);
  EXPECT_EQ(TwinPressures(run), "");
  run.bypass = false;
  run.sidecar = "rig/byp.toml";
  EXPECT_THAT(TwinPressures(run), HasSubstr("This in byp.toml mends it: bypass = true"));
}

// Tests that pressures that differ, and those of a motor that does not turn, say nothing; and that one column for both is named.
TEST(TwinPressures, OthersAndOneColumn) {
  runs::MeasuredRun run = Recorded(false, 3);
  EXPECT_EQ(TwinPressures(run), "");
  EXPECT_EQ(TwinPressures(Recorded(false, 0.2)), "");
  run.p2.values = run.p1.values;
  EXPECT_THAT(TwinPressures(run), HasSubstr("the same numbers"));
  run.p2 = {};
  EXPECT_EQ(TwinPressures(run), "");
}

}  // namespace
}  // namespace hydro::diagnose
