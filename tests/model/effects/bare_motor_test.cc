// Loads, gears and drives of a bare motor: each against a closed form, or against the textbook's equations
// integrated here.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

using Numbers = std::map<std::string, double>;

// A motor alone: the bypass is open, and nothing rubs unless the test says so.
model::ModelDescription BareMotor(std::vector<model::EffectDescription> effects, double T_s = 0,
                                  double b = 0) {
  model::ModelDescription model = Table1Model(std::move(effects));
  model.parameters.T_s = T_s;
  model.parameters.b = b;
  return model;
}

Rig RigOf(const model::ModelDescription& model) { return Rig(model, Bypassed()); }

// Classical Runge-Kutta for (angle, speed), for what the effects are compared with.
struct Motion {
  double angle = 0, speed = 0;
};
Motion Integrated(Motion x, double until, const std::function<double(const Motion&)>& acceleration) {
  constexpr double h = 1e-5;
  for (int step = 0; step < std::lround(until / h); ++step) {
    const auto at = [&](double by, const Motion& rate) {
      return Motion{x.angle + by * rate.angle, x.speed + by * rate.speed};
    };
    const auto rate = [&](const Motion& m) { return Motion{m.speed, acceleration(m)}; };
    const Motion a = rate(x), b = rate(at(h / 2, a)), c = rate(at(h / 2, b)), d = rate(at(h, c));
    x.angle += h / 6 * (a.angle + 2 * b.angle + 2 * c.angle + d.angle);
    x.speed += h / 6 * (a.speed + 2 * b.speed + 2 * c.speed + d.speed);
  }
  return x;
}

void ExpectMotion(const Rig& rig, const Motion& motion, double within) {
  EXPECT_NEAR(rig.Measure().motor_angle, motion.angle, within);
  EXPECT_NEAR(rig.Measure().motor_speed, motion.speed, 20 * within);
}

// Tests that a weight on the shaft swings as a pendulum does, far beyond small angles.
TEST(LoadGravity, SwingsLikeAPendulum) {
  Rig rig = RigOf(BareMotor({{"load.gravity", Numbers{{"mgl", 5}, {"phase", 0.7}}, {}}}));
  rig.simulation->Advance(0, 0.61);
  ExpectMotion(
      rig, Integrated({}, 0.61, [](const Motion& m) { return (-5 * std::sin(m.angle + 0.7)) / 0.03; }), 1e-5);
  EXPECT_GT(std::abs(rig.Measure().motor_angle), 0.5);
}

// Tests the period of a spring and the motor's inertia, about where voltage and spring are in balance.
TEST(LoadSpring, SwingsWithItsPeriod) {
  const double stiffness = 2, rest = 0.3, middle = rest + 4 / stiffness;
  Rig rig = RigOf(BareMotor({{"load.spring", Numbers{{"stiffness", stiffness}, {"rest", rest}}, {}}}));
  const double w = std::sqrt(stiffness / 0.03);
  for (const double time : {0.1, 0.37, 0.9}) {
    rig.simulation->Advance(1.0, time);
    EXPECT_NEAR(rig.Measure().motor_angle, middle * (1 - std::cos(w * time)), 1e-5) << time;
  }
}

// Tests friction by the torque on both sides of the gear, in all four quadrants and at rest.
TEST(GearLoadFriction, GrowsWithWhatTheGearPassesOn) {
  const double motor = 0.1, load = 0.2, T_s = 1, w = 1e-3 * 40;
  const auto soft = [&](double y) { return std::sqrt(y * y + w * w) - w; };
  const model::ModelDescription model =
      BareMotor({{"gear.load_friction", Numbers{{"motor_share", motor}, {"load_share", load}}, {}},
                 {"load.gravity", Numbers{{"mgl", 10}, {"phase", 0}}, {}}},
                T_s);
  const model::Equations equations(model, Bypassed());
  for (const double voltage : {-3.0, 3.0}) {
    for (const double angle : {-1.0, 1.0}) {
      for (const int direction : {-1, 0, 1}) {
        const std::vector<double> state = {angle, 5.0 * direction, 100, 100};
        double rate[model::kMaxStates], margin[model::kMaxSwitches];
        model::Mode mode;
        mode.pump = static_cast<int8_t>(direction);
        equations.Rates(0, voltage, mode, state.data(), rate, margin);
        const double carried = 10 * std::sin(angle), T = 4 * voltage;
        const double friction = T_s + motor * soft(T) + load * soft(carried);
        EXPECT_NEAR(friction, T_s + motor * 12 + load * std::abs(carried), 0.02);
        if (direction == 0) {
          EXPECT_NEAR(margin[model::kPumpSwitch], friction - std::abs(T - carried), 1e-12);
        } else {
          EXPECT_NEAR(rate[model::kMotorSpeed] * 0.03, T - carried - direction * friction, 1e-12);
        }
      }
    }
  }
}

// Tests that a gear whose load side rubs as much as it carries cannot be driven by its load, as a worm
// gear's.
TEST(GearLoadFriction, LocksAWormGear) {
  for (const double load : {0.5, 1.2}) {
    Rig rig = RigOf(BareMotor({{"gear.load_friction", Numbers{{"load_share", load}}, {}},
                               {"load.gravity", Numbers{{"mgl", 10}, {"phase", 1}}, {}}}));
    rig.simulation->Advance(0, 0.2);
    if (load > 1) {
      EXPECT_EQ(rig.Measure().motor_angle, 0);
    } else {
      EXPECT_LT(rig.Measure().motor_angle, -0.5);
    }
  }
}

// Tests friction over a turn, which holds at rest as well.
TEST(GearFrictionRipple, FollowsTheAngle) {
  const model::Equations equations(
      BareMotor({{"gear.friction_ripple", Numbers{{"amplitude", 0.4}, {"periods", 2}, {"phase", 0.3}}, {}}},
                3),
      Bypassed());
  for (const double angle : {0.0, 0.8, 3.0}) {
    double rate[model::kMaxStates];
    const model::Terms<double> x = TermsAt(equations, {angle, 0, 100, 100}, rate);
    EXPECT_NEAR(x.coulomb, 3 * (1 + 0.4 * std::sin(2 * angle + 0.3)), 1e-12);
    EXPECT_EQ(x.coulomb, x.breakaway);
  }
}

// Tests that a motor on a voltage runs up to v/k_e with the time constant J/(k_1 k_e), and with the
// inductance that a second-order equation gives.
TEST(MotorBackEmf, RunsUpAsTheTextbookSays) {
  const double k_e = 0.02, voltage = 2, rate = 4 * k_e / 0.03;
  Rig rig = RigOf(BareMotor({{"motor.back_emf", Numbers{{"k_e", k_e}, {"tau", 0}}, {}}}));
  for (const double time : {0.1, 0.4}) {
    rig.simulation->Advance(voltage, time);
    EXPECT_NEAR(rig.Measure().motor_speed, voltage / k_e * (1 - std::exp(-rate * time)), 1e-4);
  }
  // The torque is a motion's rate of speed: T' = (k_1 (v - k_e w) - T)/tau, w' = T/J.
  const double tau = 0.05;
  Rig slow = RigOf(BareMotor({{"motor.back_emf", Numbers{{"k_e", k_e}, {"tau", tau}}, {}}}));
  slow.simulation->Advance(voltage, 0.3);
  const Motion wound = Integrated({}, 0.3, [&](const Motion& m) {  // angle: w, speed: w'
    return (4 * (voltage - k_e * m.angle) / 0.03 - m.speed) / tau;
  });
  EXPECT_NEAR(slow.Measure().motor_speed, wound.angle, 1e-4);
}

// Tests that the amplifier's limit holds the torque where the winding would give more, and lets go where it
// gives less.
TEST(MotorBackEmf, KeepsTheLimit) {
  Rig rig = RigOf(BareMotor({{"motor.back_emf", Numbers{{"k_e", 0.1}, {"tau", 0}}, {}}}));
  const double voltage = 15;  // 60 in-lbf at rest, 40 allowed: until (60 - 40)/4/0.1 = 50 rad/s
  const double leaves = 50 / (40 / 0.03);
  rig.simulation->Advance(voltage, 0.9 * leaves);
  EXPECT_NEAR(rig.Measure().motor_speed, 0.9 * 50, 1e-6);
  EXPECT_EQ(TermsOf(rig, voltage).torque, 40);
  rig.simulation->Advance(voltage, leaves + 0.05);
  EXPECT_NEAR(rig.Measure().motor_speed, 150 - 100 * std::exp(-4 * 0.1 / 0.03 * 0.05), 1e-4);
}

// Tests that commands within the dead band do nothing, and what is beyond it acts, also behind a delay and
// before a lag.
TEST(AmpDeadband, TakesTheMiddleAway) {
  const model::EffectDescription band = {"amp.deadband", Numbers{{"width", 0.5}}, {}};
  const model::Equations equations(BareMotor({band}), Bypassed());
  for (const auto& [voltage, torque] :
       {std::pair{0.4, 0.0}, {-0.5, 0.0}, {2.0, 6.0}, {-2.0, -6.0}, {20.0, 40.0}}) {
    double rate[model::kMaxStates];
    model::Terms<double> x;
    const std::vector<double> state = {0, 0, 100, 100};
    equations.Evaluate(0, voltage, model::Mode{}, state.data(), rate, &x);
    EXPECT_NEAR(x.torque, torque, 1e-12) << voltage;
  }
  Rig late = RigOf(BareMotor(
      {band, {"amp.delay", Numbers{{"delay", 0.01}}, {}}, {"amp.lag", Numbers{{"tau", 0.02}}, {}}}));
  late.simulation->Advance(2, 0.03);
  EXPECT_NEAR(TermsOf(late, 2).torque, 6 * (1 - std::exp(-1)), 1e-6);
}

// Tests that the torque moves in straight lines: up to a command, and back from halfway where the command
// turns.
TEST(AmpRateLimit, MovesInStraightLines) {
  Rig rig = RigOf(BareMotor({{"amp.rate_limit", Numbers{{"rate", 400}}, {}}}));
  const auto torque_at = [&](double voltage, double time) {
    rig.simulation->Advance(voltage, time);
    return TermsOf(rig, voltage).torque;
  };
  EXPECT_NEAR(torque_at(3, 0.01), 4 * 1, 1e-6);
  EXPECT_NEAR(torque_at(3, 0.02), 4 * 2, 1e-6);
  EXPECT_NEAR(torque_at(-1, 0.03), 4 * 1, 1e-6);  // turned halfway
  EXPECT_NEAR(torque_at(-1, 0.05), 4 * -1, 1e-5);
  EXPECT_NEAR(torque_at(-1, 0.08), 4 * -1, 1e-5);  // reached
  // The motor's speed is the area under all that: 2 and 1 up, then down through 0.
  const double area = 4 * (0.02 * 2 / 2 + (0.02 * 2 / 2) - 0.01 * 1 / 2 - 0.03 * 1);
  EXPECT_NEAR(rig.Measure().motor_speed, area / 0.03, 1e-3);
  // A lag follows the line: tau T' = 400 t - T.
  const double tau = 0.02;
  Rig lagging = RigOf(
      BareMotor({{"amp.rate_limit", Numbers{{"rate", 400}}, {}}, {"amp.lag", Numbers{{"tau", tau}}, {}}}));
  lagging.simulation->Advance(3, 0.01);
  EXPECT_NEAR(TermsOf(lagging, 3).torque, 400 * (0.01 - tau * (1 - std::exp(-0.01 / tau))), 1e-5);
}

// Tests the corner: the whole torque below it, the line above it, nothing while braking.
TEST(MotorCurrentLimit, FallsAboveItsCorner) {
  Rig rig =
      RigOf(BareMotor({{"motor.current_limit", Numbers{{"corner_speed", 40}, {"speed_range", 40}}, {}}}));
  const double corner_time = 40 / (40 / 0.03);
  rig.simulation->Advance(10, 0.8 * corner_time);
  EXPECT_EQ(TermsOf(rig, 10).torque, 40);
  rig.simulation->Advance(10, corner_time + 0.02);
  EXPECT_NEAR(rig.Measure().motor_speed, 80 - 40 * std::exp(-1 / 0.03 * 0.02), 1e-3);
  EXPECT_NEAR(TermsOf(rig, 10).torque, 80 - rig.Measure().motor_speed, 1e-9);
  rig.simulation->Advance(-10, corner_time + 0.02 + 1e-6);
  EXPECT_EQ(TermsOf(rig, -10).torque, -40);
}

// Tests play: the motor runs free through it, pushes the load behind it, and keeps the energy of both;
// against the equations of two masses and a spring with a dead zone, integrated here in small steps.
TEST(GearBacklash, PassesNothingWithinThePlay) {
  const double width = 0.2, stiffness = 300, inertia = 0.02;
  Rig rig = RigOf(
      BareMotor({{"gear.backlash",
                  Numbers{{"width", width}, {"stiffness", stiffness}, {"damping", 0}, {"inertia", inertia}},
                  {}},
                 {"load.spring", Numbers{{"stiffness", 5}, {"rest", 0}}, {}}}));
  const double voltage = 0.5, touches = std::sqrt(2 * width / 2 * 0.03 / (4 * voltage));
  rig.simulation->Advance(voltage, 0.95 * touches);
  EXPECT_EQ(rig.simulation->now().state[4], 0) << "the load stands while the motor crosses half the play";
  EXPECT_NEAR(rig.Measure().motor_speed, 4 * voltage / 0.03 * 0.95 * touches, 1e-6);
  double x[4] = {0, 0, 0, 0};  // angle, speed of the motor; of the load
  constexpr double h = 1e-6;
  const double until = 0.4;
  for (int step = 0; step < std::lround(until / h); ++step) {
    const auto accelerations = [&](double angle, double load) {
      const double twist = angle - load, beyond = std::max(std::abs(twist) - width / 2, 0.0);
      const double passed = stiffness * (twist > 0 ? beyond : -beyond);
      return std::pair{(4 * voltage - passed) / 0.03, (passed - 5 * load) / inertia};
    };
    // Velocity Verlet, which keeps energy.
    const auto [a, b] = accelerations(x[0], x[2]);
    x[0] += h * x[1] + h * h / 2 * a;
    x[2] += h * x[3] + h * h / 2 * b;
    const auto [a_end, b_end] = accelerations(x[0], x[2]);
    x[1] += h / 2 * (a + a_end);
    x[3] += h / 2 * (b + b_end);
  }
  rig.simulation->Advance(voltage, until);
  EXPECT_NEAR(rig.Measure().motor_angle, x[0], 1e-4);
  EXPECT_NEAR(rig.simulation->now().state[4], x[2], 1e-4);
  EXPECT_GT(std::abs(x[2]), 0.05);
  const model::Point& now = rig.simulation->now();
  const model::Power power = rig.equations.PowerBalance(now.time, voltage, rig.simulation->mode(), now.state);
  EXPECT_NEAR(power.in + power.shaft_in, power.stored() + power.dissipated() + power.mismatch,
              1e-6 * std::abs(power.in) + 1e-6);
}

}  // namespace
}  // namespace hydro::testing
