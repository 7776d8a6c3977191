// Every path against trajectories that an event-located integration with steps of 1e-6 s gave, and against
// its own tolerance.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

struct Row {
  double time, motor_speed, p1, p2;
};

constexpr Row kStep[] = {
    {0.001, 0.199946007102, 100, 100.062195919},
    {0.01, 1.98968079341, 100, 106.191208016},
    {0.03, 5.81079093785, 100, 154.719737108},
    {0.05, 9.21885351823, 100, 247.633073358},
    {0.075, 12.5776535712, 100, 415.318441283},
    {0.1, 14.6476502977, 100, 622.773516935},
    {0.125, 15.2536026612, 100, 847.971501286},
    {0.15, 14.3729305683, 100, 1067.67367013},
    {0.2, 8.79897877881, 100, 1405.68503971},
    {0.225, 4.73413989465, 100, 1491.76871457},
    {0.24, 2.1225749227, 100, 1511.46811474},
    {0.25, 0.369731389396, 100, 1510.93812958},
    {0.252, 0.0211626221561, 100.043457453, 1509.52773084},
    {0.253, 0, 100.152742221, 1508.70246768},
    {0.26, 0, 100.919734499, 1502.93379915},
    {0.3, 0, 105.183156122, 1470.42811698},
    {0.4, 0, 114.990264298, 1392.47615379},
    {0.5, 0, 123.664635303, 1319.03267886},
    {0.7, 0, 137.998443194, 1184.62729042},
    {0.85, 0, 146.448809718, 1093.79997794},
    {1, 0, 153.213059699, 1010.70350468},
};

constexpr Row kSquare[] = {
    {0.001, 1.19967604261, 100, 100.373175515},
    {0.02, 19.4331464854, 100, 242.616741743},
    {0.04, 3.92298192982, 100, 387.417512855},
    {0.05, 0.230126075221, 100, 396.568239647},
    {0.06, -12.4969901437, 138.577643126, 356.495094896},
    {0.075, -23.547840107, 332.332785034, 160.499737812},
    {0.1, 2.44921814962, 429.472822425, 110.713464744},
    {0.11, 15.138862657, 372.792536839, 165.669750422},
    {0.125, 21.8609273812, 161.489090657, 374.403564594},
    {0.15, -3.79166022757, 122.187245164, 443.103032775},
    {0.163, -20.1588087897, 219.429660639, 343.455860032},
    {0.2, 4.35489127142, 449.429983467, 129.135848797},
    {0.251, -5.90884633241, 135.895289138, 449.193176211},
    {0.3, 4.76770817926, 454.370569893, 134.344406328},
    {0.333, 7.14855092948, 100, 483.90458899},
    {0.4, 4.88011177182, 455.734881557, 135.68926565},
    {0.49, 3.21610716294, 491.487662302, 102.6648786},
    {0.6, 4.91854109214, 456.204094884, 136.149085313},
    {0.75, -4.92116238368, 136.180423988, 456.236139794},
    {0.88, -11.712123523, 469.450621429, 117.037542695},
    {1, 4.92157787443, 456.241219573, 136.185391084},
};

class Reference : public ::testing::TestWithParam<model::Integrator> {};

void ExpectNear(const model::Measurement& m, const Row& row) {
  EXPECT_NEAR(m.motor_speed, row.motor_speed, 1e-5) << "at " << row.time << " s";
  EXPECT_NEAR(m.p1, row.p1, 1e-3) << "at " << row.time << " s";
  EXPECT_NEAR(m.p2, row.p2, 1e-3) << "at " << row.time << " s";
}

// Tests that a step of T_p = 10 in-lbf gives the reference trajectory, however long the calls are.
TEST_P(Reference, Step) {
  model::Actuator actuator(Table1Model(), Held(model::Shaft::kClamped, GetParam()));
  for (const Row& row : kStep) {
    actuator.Advance(2.5, row.time);
    ExpectNear(actuator.Measure(), row);
  }
}

// Tests that the sampled pressure loop on a square wave, with its mode changes and saturation, gives the
// reference trajectory, and that the one-way valves keep both pressures at or above p_3 at every sample.
TEST_P(Reference, SquareWave) {
  model::Actuator actuator(Table1Model(), Held(model::Shaft::kClamped, GetParam()));
  const Row* row = kSquare;
  for (int tick = 0; tick < 5000; ++tick) {
    actuator.Advance(SquareWaveLoop(actuator.Measure(), tick), (tick + 1) * 2e-4);
    const model::Measurement m = actuator.Measure();
    ASSERT_GE(m.p1, 100);
    ASSERT_GE(m.p2, 100);
    if (row != std::end(kSquare) && std::abs(actuator.time() - row->time) < 1e-9) ExpectNear(m, *row++);
  }
  EXPECT_EQ(row, std::end(kSquare));
}

// Tests that a tighter tolerance gives a smaller error, with a free arm, whose 302 rad/s make the tolerance
// choose the step.
TEST_P(Reference, ConvergesWithTolerance) {
  const auto run = [](model::Integrator integrator, double tolerance) {
    model::ActuatorOptions options = Held(model::Shaft::kFree, integrator);
    options.relative_tolerance = tolerance;
    model::Actuator actuator(Table1Model(), options);
    actuator.Advance(2.5, 0.15);
    return actuator.Measure().p2;
  };
  const double tight = run(model::Integrator::kErk, 1e-12);
  double previous = 1e9;
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const double error = std::abs(run(GetParam(), tolerance) - tight);
    EXPECT_LT(error, 0.3 * previous) << "at tolerance " << tolerance;
    previous = error;
  }
  EXPECT_LT(previous, 1e-5);
}

// Tests that the same calls give the same bits.
TEST_P(Reference, Repeats) {
  model::Actuator a(Table1Model(), Held(model::Shaft::kClamped, GetParam()));
  model::Actuator b(Table1Model(), Held(model::Shaft::kClamped, GetParam()));
  for (int tick = 0; tick < 1000; ++tick) {
    a.Advance(SquareWaveLoop(a.Measure(), tick), (tick + 1) * 2e-4);
    b.Advance(SquareWaveLoop(b.Measure(), tick), (tick + 1) * 2e-4);
    ASSERT_EQ(a.Measure().p2, b.Measure().p2);
    ASSERT_EQ(a.Measure().p1, b.Measure().p1);
    ASSERT_EQ(a.Measure().motor_speed, b.Measure().motor_speed);
    ASSERT_EQ(a.Measure().motor_angle, b.Measure().motor_angle);
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Reference, ::testing::ValuesIn(kIntegrators),
                         [](const auto& test) { return Name(test.param); });

}  // namespace
}  // namespace hydro::testing
