#include "diagnose/recording/stated_bypass.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "diagnose/recording/oil_spring.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {
namespace {

using Eigen::VectorXd;
using Run = runs::MeasuredRun;

constexpr double kWithinNoise = 3;
// In noise units: a motor turns if its speed differs from zero, or its angle from itself, by this much.
constexpr double kTurns = 20;
// Shares of the torque. The remaining flow through an open bypass never takes the first; above the second,
// the pressures indicate closed oil.
constexpr double kTakesTorque = 0.5, kTakesNone = 0.2;
// Of 227 clamped runs of 42 rigs, the 56 with an open bypass show -0.08 to 0.05 of the oil's stiffness. Of
// those with a closed bypass, 144 surely show more than 0.3, and none surely shows less than 0.15.
constexpr double kNoSpring = 0.15, kSpring = 0.3;
constexpr double kErrors = 3;
// Closed oil would have to take this share of the torque for its absence to show. Below the smaller number,
// the model has practically no oil.
constexpr double kWouldShow = 0.7, kNoOil = 0.1;
// The shares of the squared torque that a fit leaves. Where more is left, the model disagrees with the run
// for another reason.
constexpr double kExplained = 0.5, kUnexplainedWithout = 0.05, kBetter = 0.7;
// Fitted inertia over the model's. Beyond these limits a unit or a sign is wrong.
constexpr double kLeastInertia = 0.6, kMostInertia = 1.6;
// An arm that follows the motor through closed oil: correlation, and ratio of the displaced volumes. An arm
// behind a flexible connection, or one whose geometry is a guess, follows less closely, but moves.
constexpr double kFollows = 0.95, kSameVolume = 0.7, kMovesLittle = 0.2;

double Spread(const VectorXd& values) { return values.size() == 0 ? 0 : Rms(values.array() - values.mean()); }

double NoiseOf(const std::vector<double>& values) {
  return std::max(EstimateNoise(values), EstimateResolution(values));
}

bool Turns(const Run& run) {
  if (run.motor_speed.measured())
    return Rms(Held(run.motor_speed.values)) > kTurns * NoiseOf(run.motor_speed.values);
  return run.motor_angle.measured() &&
         maths::RangeOf(run.motor_angle.values).size() > kTurns * NoiseOf(run.motor_angle.values);
}

bool ShowsNoOil(const OilSpring& spring) {
  return std::abs(spring.stiffness) + kErrors * spring.error < kNoSpring && spring.would_take > kWouldShow &&
         spring.left_without < kExplained && spring.inertia > kLeastInertia && spring.inertia < kMostInertia;
}

bool ShowsClosedOil(const OilSpring& spring) {
  return spring.stiffness - kErrors * spring.error > kSpring && spring.stiffness < 1 / kSpring &&
         spring.left < kBetter * spring.left_without && spring.left < kExplained &&
         spring.left_without > kUnexplainedWithout;
}

class StatedBypass {
 public:
  StatedBypass(const model::Parameters& model, const Run& run) : run_(run) {
    both_ = run.p1.measured() && run.p2.measured();
    turns_ = Turns(run);
    const bool motion = run.motor_speed.measured() || run.motor_angle.measured();
    const bool arm = run.arm_angle.measured() || run.arm_speed.measured();
    if (motion && (run.shaft == model::Shaft::kClamped || arm)) spring_ = FitOilSpring(model, run);
    VectorXd torque = model.k_1 * Held(run.voltage.values);
    torque = torque.cwiseMin(model.T_pmax).cwiseMax(-model.T_pmax).eval();
    // A difference that never changes comes from the sensors.
    if (both_)
      share_ = model.D * Spread(Held(run.p2.values) - Held(run.p1.values)) / std::max(Spread(torque), 1e-300);
  }

  std::string Contradiction() const {
    const std::string found = run_.bypass ? WasClosed() : WasOpen();
    if (found.empty()) return "";
    const std::string sidecar = std::filesystem::path(run_.sidecar).filename().string();
    return found + "; this in " + (sidecar.empty() ? "the sidecar" : sidecar) +
           " mends it: bypass = " + (run_.bypass ? "false" : "true");
  }

 private:
  std::string WasClosed() const {
    if (both_ && share_ > kTakesTorque)
      return "bypass = true, but p2 - p1 takes the motor's torque: it was closed";
    if (!spring_) return "";
    if (run_.shaft == model::Shaft::kClamped) {
      if (!ShowsClosedOil(*spring_)) return "";
      return "bypass = true, but the motor turns against a spring of " + ShortNumber(spring_->stiffness, 2) +
             " times the stiffness of the model's oil: it was closed";
    }
    const bool follows =
        spring_->follows > kFollows && spring_->volume > kSameVolume && spring_->volume < 1 / kSameVolume;
    return follows ? "bypass = true, but the arm follows the motor as through closed oil: it was closed" : "";
  }

  std::string WasOpen() const {
    const bool clamped = run_.shaft == model::Shaft::kClamped;
    if (clamped && both_ && turns_ && run_.motor_speed.measured() && AreSame())
      return "p1 and p2 are the same within their noise while the motor turns: the bypass was open";
    if (!spring_ || !turns_ || (both_ && share_ > kTakesNone)) return "";
    // An arm may be heavy or held by friction, its geometry may be a guess, and a pump may leak as much as it
    // turns. Where pressures were recorded, they decide.
    if (both_ && !AreSame()) return "";
    const bool no_pressure = !run_.p1.measured() && !run_.p2.measured();
    if (clamped && no_pressure && spring_->at_most < kNoOil)
      return "the motor turns, and closed oil as the model has it would have taken less than " +
             ShortNumber(100 * kNoOil) + " % of its torque: the motor is bare, or the bypass was open";
    if (!ShowsNoOil(*spring_) || spring_->moved > kMovesLittle) return "";
    return "the motor turns freely, where closed oil would have taken " +
           ShortNumber(spring_->would_take, 2) +
           " times its torque: the motor is bare, or the bypass was open";
  }

  // An arm that moves freely may need no pressure difference.
  bool AreSame() const {
    const double noise = std::max(NoiseOf(run_.p1.values), NoiseOf(run_.p2.values));
    return run_.p1.values != run_.p2.values &&
           Rms(Held(run_.p2.values) - Held(run_.p1.values)) <= kWithinNoise * noise;
  }

  const Run& run_;
  bool both_ = false, turns_ = false;
  double share_ = 0;  // part of the motor's torque that the pressures take
  std::optional<OilSpring> spring_;
};

}  // namespace

std::string StatedBypassContradiction(const model::Parameters& model, const Run& run) {
  return StatedBypass(model, run).Contradiction();
}

}  // namespace hydro::diagnose
