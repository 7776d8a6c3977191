#include "diagnose/locate/pressure_offsets.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

// A run that rests at its lowest pressures half of the time, and is 400 psi above them for the rest.
RunData Resting(double p1, double p2, bool rests = true) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  RunData run;
  SignalData one, two;
  one.channel = model::Channel::kP1;
  two.channel = model::Channel::kP2;
  one.noise = two.noise = 1.5;
  for (size_t k = 0; k < 1000; ++k) {
    const double above = k % 100 < 50 ? 0.0 : 400.0;
    run.stimulus.time.push_back(1e-3 * static_cast<double>(k));
    one.values.push_back(p1 + (rests ? above : 0.4 * static_cast<double>(k)) + 1.5 * normal(random));
    two.values.push_back(p2 + (rests ? 400 - above : 0.4 * static_cast<double>(k)) + 1.5 * normal(random));
  }
  run.signals = {one, two};
  return run;
}

model::ModelDescription Model() { return {"Table 1", testing::Table1(), {}}; }

// Tests that transducers that disagree at rest get as offsets their readings relative to the charge pressure.
TEST(PressureOffsets, FoundAtRest) {
  const double p_3 = testing::Table1().p_3;
  const RunData run = Resting(p_3 + 12, p_3 - 5);
  const PressureOffsets offsets = RestOffsets(Model(), {&run});
  EXPECT_NEAR(offsets.p1, 12, 2);
  EXPECT_NEAR(offsets.p2, -5, 2);
}

// Tests that no offset is found where both read the same (the charge pressure may be wrong) or nothing rests.
TEST(PressureOffsets, NoneWithoutADifferenceOrARest) {
  const double p_3 = testing::Table1().p_3;
  const RunData same = Resting(p_3 + 12, p_3 + 12);
  EXPECT_EQ(RestOffsets(Model(), {&same}).p1, 0);
  EXPECT_EQ(RestOffsets(Model(), {&same}).p2, 0);
  const RunData moving = Resting(p_3 + 12, p_3 - 5, false);
  EXPECT_EQ(RestOffsets(Model(), {&moving}).p1, 0);
  EXPECT_EQ(RestOffsets(Model(), {&moving}).p2, 0);
}

}  // namespace
}  // namespace hydro::diagnose
