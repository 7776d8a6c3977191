// What the catalogue's own effect needs to stand for one of this rig's.
#include <cmath>

#include "catalogue.h"

namespace foreign_rig {

namespace {

// Pressures over which a poppet's square-root flow is taken as a conductance: a usual difference beyond where
// it opens, and the lifts (psi) at which it is fully open.
constexpr double kCheckBeyond = 8, kCheckLift = 40, kReliefLift = 250;
constexpr double kLineDamping = 0.04;  // in the middle of those that are drawn

}  // namespace

Named NearestParameters(const Rig& rig, const Truth& truth) {
  const Effects& e = rig.effects;
  Named all = truth.parameters;
  if (truth.id == "motor.cogging") all.emplace_back("phase", e.cogging_phase);
  if (truth.id == "valve.check")
    all.emplace_back("conductance", e.check_flow * std::sqrt(e.check_cracking + kCheckBeyond) / kCheckLift);
  if (truth.id == "valve.relief")
    all.emplace_back("conductance", e.relief_flow * std::sqrt(e.relief_set) / kReliefLift);
  if (truth.id == "line.wave") all.emplace_back("damping", kLineDamping);
  return all;
}

}  // namespace foreign_rig
