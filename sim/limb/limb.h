// The joints of a limb, tick by tick. All joints take each step together, so that a fault of one reaches the
// others within the same tick.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "settings/limb_config.h"
#include "sim/limb/joint.h"

namespace hydro::limb {

// A clock that stands still within a tick. All joints of a limb get the same reading, and only one reading of
// the real clock is needed.
class TickClock : public bus::Clock {
 public:
  // `real` must outlive this object. The clock runs until it is stopped.
  explicit TickClock(const bus::Clock& real) : real_(real) {}

  void Stop() {
    now_ = real_.Now();
    utime_ = real_.Utime();
    suspended_ = real_.Suspended();
    stopped_ = true;
  }
  void Run() { stopped_ = false; }

  int64_t Utime() const override { return stopped_ ? utime_ : real_.Utime(); }
  Duration Suspended() const override { return stopped_ ? suspended_ : real_.Suspended(); }
  bool simulated() const override { return real_.simulated(); }

 private:
  TimePoint Read() const override { return stopped_ ? now_ : real_.Now(); }

  const bus::Clock& real_;
  TimePoint now_{};
  int64_t utime_ = 0;
  Duration suspended_{};
  bool stopped_ = false;
};

struct LimbOptions {
  std::vector<std::string> joints;  // joints of the configuration to run here; empty: all
  std::string program = "hydro-limb";
  const bus::Clock* clock = nullptr;     // null: lockstep on simulated clocks
  std::function<bool()> heartbeat = {};  // as in PlantApp
  int64_t session = 0;                   // of all joints, on simulated clocks
};

class Limb {
 public:
  // Throws InputError when a configuration and its model contradict each other.
  Limb(const settings::LimbConfig& config, const LimbOptions& options);

  std::vector<std::unique_ptr<Joint>>& joints() { return joints_; }
  size_t joint_count() const { return joints_.size(); }

  // Lockstep: computes the whole state of a tick and moves on to the next. Returns false when the run is
  // over. Begin() must be called first.
  bool Begin();
  bool StepLockstep();

  // Real time: advances by as many ticks as have elapsed. Returns false when the run is over.
  bool StepRealtime(const plant::WakeUp& wake_up);

  // While either text is not empty, all joints are at zero volts, because a joint in another process has a
  // fault or is no longer heard.
  void HoldForOthers(std::string fault, std::string silence) {
    elsewhere_ = std::move(fault);
    silence_ = std::move(silence);
  }

  // Ends all joints; each gets zero volts before anything else happens. `after_each` (may be empty) is called
  // after each joint's announcement. Returns the exit code: 0 when every joint's run ended well.
  int End(const std::function<void()>& after_each);

  int64_t tick() const { return tick_; }
  // Why the first joint that failed did so: "knee: plant: ..."; empty when none has failed.
  std::string failure() const;

 private:
  void CheckAll();
  void DriveAll();
  void NoteEnds();
  Joint* FirstFault(const Joint* besides) const;

  settings::OnJointFault on_joint_fault_;
  int64_t last_tick_;
  std::optional<TickClock> clock_;  // real time; declared before the joints, which use it
  std::vector<std::unique_ptr<Joint>> joints_;
  int64_t tick_ = 0;
  bool over_ = false;
  size_t polled_ = 0;
  std::string elsewhere_;
  std::string silence_;
};

}  // namespace hydro::limb
