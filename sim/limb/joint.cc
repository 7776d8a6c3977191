#include "sim/limb/joint.h"

#include <algorithm>
#include <utility>

namespace hydro::limb {
namespace {

// All parts of a limb run with the configuration that this process has read, so there is nothing to compare.
// The limb itself handles the faults of its joints.
settings::StackConfig InsideALimb(settings::StackConfig config) {
  config.agreed.clear();
  config.siblings.clear();
  config.bus.limb_suffix.reset();
  return config;
}

}  // namespace

Joint::Joint(const settings::JointConfig& joint, std::unique_ptr<plant::Rig> rig, bus::Clock* clock,
             const std::string& program, std::function<bool()> heartbeat, int64_t session)
    : name_(joint.name),
      config_(InsideALimb(joint.config)),
      simulated_(session),
      clock_(clock != nullptr ? *clock : simulated_),
      bus_(clock != nullptr ? bus::InProcessBus(*clock) : bus::InProcessBus(&simulated_)),
      rig_(std::move(rig)),
      plant_(bus_, clock_, config_, *rig_, {}, program, std::move(heartbeat)),
      pressure_(bus_, clock_, config_),
      position_(bus_, clock_, config_),
      sessions_{plant_.participant().session(), pressure_.session(), position_.session()} {}

bool Joint::IsOwn(int64_t session) const {
  return std::find(sessions_.begin(), sessions_.end(), session) != sessions_.end();
}

void Joint::Dispatch(bus::Clock::TimePoint until) {
  while (bus_.HandleUntil(until) > 0) {
  }
}

// Each due time is computed from the start, so that rounding errors do not add up.
bus::Clock::TimePoint Joint::DueTime(int64_t tick) const {
  return start_ + bus::FromSeconds(static_cast<double>(tick) / config_.plant.rate_hz);
}

void Joint::Poll() {
  plant_.Poll(clock_.Now());
  pressure_.Poll();
  position_.Poll();
}

int Joint::End() {
  if (ended_) return exit_code_;
  ended_ = true;
  exit_code_ = plant_.End();
  Dispatch(clock_.Now());
  position_.Finish();
  pressure_.Finish();
  Dispatch(clock_.Now());
  return exit_code_;
}

}  // namespace hydro::limb
