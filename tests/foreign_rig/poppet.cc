#include "poppet.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

namespace {

constexpr double kLaminar = 1;  // psi, below which the flow is laminar

}  // namespace

double RestingLift(const Poppet& valve, double across) {
  return std::clamp((across - valve.opens_at) / valve.fully_open, 0.0, 1.0);
}

double PoppetFlow(const Poppet& valve, double lift, double across) {
  if (across <= 0 || lift <= 0) return 0;
  return valve.flow * lift * (across < kLaminar ? across / std::sqrt(kLaminar) : std::sqrt(across));
}

}  // namespace foreign_rig
