#include "tune/design/bang_bang.h"

#include <cmath>

namespace hydro::design {
namespace {

// The speed v from rest under a constant torque and viscous friction: inertia v' = torque - viscous v.
// Braking is the same motion backward in time, with a viscous torque that helps: viscous < 0.
struct Ramp {
  double inertia;
  double torque;
  double viscous;

  double Time(double speed) const {
    if (viscous == 0) return inertia * speed / torque;
    return -inertia / viscous * std::log1p(-viscous * speed / torque);
  }
  double Distance(double speed) const {
    const double share = viscous * speed / torque;
    // The formula below loses digits where viscosity hardly matters; use its series there.
    if (std::fabs(share) < 1e-4) return inertia * speed * speed / torque * (0.5 + share / 3);
    return -inertia / viscous * (speed + torque / viscous * std::log1p(-share));
  }
};

Ramp Accelerating(const RigidDrive& d) { return {d.inertia, d.torque - d.friction, d.viscous}; }
Ramp Braking(const RigidDrive& d) { return {d.inertia, d.torque + d.friction, -d.viscous}; }

// The speed below `limit` at which a rising function of speed reaches `value`; `limit` if it does not.
template <class Function>
double SpeedWhere(const Function& rising, double value, double limit) {
  if (rising(limit) <= value) return limit;
  double low = 0, high = limit;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (rising(middle) < value ? low : high) = middle;
  }
  return low;
}

double HighestSpeed(const RigidDrive& d) {
  // The ramp takes forever to reach the terminal speed.
  const double terminal = d.viscous > 0 ? (d.torque - d.friction) / d.viscous : d.speed;
  return std::fmin(d.speed, terminal * (1 - 1e-12));
}

}  // namespace

RigidDrive MakeRigidDrive(const model::Parameters& p, double motor_speed) {
  const double motor_per_arm = p.c / p.D;  // speeds: theta'/alpha'
  const double torque_per_torque = p.k_2 / p.D;
  RigidDrive drive;
  drive.inertia = p.J * motor_per_arm * torque_per_torque + p.J_a;
  drive.torque = torque_per_torque * p.T_pmax;
  drive.friction = torque_per_torque * p.T_s;
  drive.viscous = torque_per_torque * motor_per_arm * p.b;
  drive.speed = motor_speed / motor_per_arm;
  return drive;
}

FastestMove FastestRestToRest(const RigidDrive& drive, double distance) {
  const Ramp up = Accelerating(drive), down = Braking(drive);
  const double limit = HighestSpeed(drive);
  FastestMove move;
  move.peak_speed =
      SpeedWhere([&](double speed) { return up.Distance(speed) + down.Distance(speed); }, distance, limit);
  const double cruise = distance - up.Distance(move.peak_speed) - down.Distance(move.peak_speed);
  move.speed_limited = move.peak_speed == limit;
  move.switch_time = up.Time(move.peak_speed);
  if (move.speed_limited) move.switch_time += cruise / move.peak_speed;
  move.time = move.switch_time + down.Time(move.peak_speed);
  return move;
}

double FastestSettling(const RigidDrive& drive, double distance, double band) {
  // The move that stops at the band's far edge reaches the near edge soonest.
  const FastestMove move = FastestRestToRest(drive, distance * (1 + band));
  const Ramp down = Braking(drive);
  const double speed_at_edge =
      SpeedWhere([&](double speed) { return down.Distance(speed); }, 2 * band * distance, move.peak_speed);
  double time = move.time - down.Time(speed_at_edge);
  // If the band is so wide that braking begins within it, the arm passes the near edge earlier still: at the
  // peak speed or while accelerating.
  const double before_braking = 2 * band * distance - down.Distance(speed_at_edge);
  if (before_braking > 1e-12 * distance) {
    const Ramp up = Accelerating(drive);
    const double speed =
        SpeedWhere([&](double v) { return up.Distance(v); }, distance * (1 - band), move.peak_speed);
    time = up.Time(speed) + (distance * (1 - band) - up.Distance(speed)) / speed;
  }
  return time;
}

}  // namespace hydro::design
