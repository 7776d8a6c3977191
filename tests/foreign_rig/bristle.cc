#include "bristle.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

double SlipShare(const Bristles& b, double bend, double speed, double limit) {
  if (b.elastic_part <= 0) return 1;
  if (bend * speed <= 0) return 0;  // bristles that are released do not slip
  const double full = limit / b.stiffness;
  const double part = (std::abs(bend) / full - b.elastic_part) / (1 - b.elastic_part);
  if (part <= 0) return 0;
  if (part >= 1) return 1;
  return part * part * (3 - 2 * part);
}

double BristleForce(const Bristles& b, double bend, double speed, double limit) {
  double force = b.stiffness * bend;
  const double relative = speed / b.damping_speed;
  if (b.damping > 0 && std::abs(relative) < 5) {
    const double slip = SlipShare(b, bend, speed, limit);
    const double rate = speed - slip * std::abs(speed) * b.stiffness * bend / limit;
    force += b.damping * std::exp(-relative * relative) * rate;
  }
  return force;
}

double Bend(const Bristles& b, double bend, double speed, double limit, double h) {
  if (speed == 0) return bend;
  const double full = limit / b.stiffness;
  const double slip = SlipShare(b, bend, speed, limit);
  if (slip < 1e-6) {  // the quotient below would be all rounding
    const double next = bend + speed * h;
    return std::clamp(next, -full, full);
  }
  const double rest = std::copysign(full / slip, speed);
  const double next = rest + (bend - rest) * std::exp(-slip * std::abs(speed) * h / full);
  return std::clamp(next, -full > bend ? bend : -full, full < bend ? bend : full);
}

}  // namespace foreign_rig
