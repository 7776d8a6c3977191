// The two ways to pace a run on a rig: lockstep, which waits for every answer, and real time, which waits for
// none. plant_app.h describes both.
#pragma once

#include <cstdint>

#include "bus/clock.h"
#include "plant/rig.h"
#include "process/timing/followed_rate_loop.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class PlantApp;

class PlantPace {
 public:
  // Takes the steps of `plant`, which must outlive this object. `pacemaker` is not null when the rig's own
  // clock wakes the plant.
  PlantPace(PlantApp& plant, const settings::StackConfig& config, Pacemaker* pacemaker);

  // Takes the plant from tick 0 to the end of its run. Throws RigError.
  void Run();

  // Lockstep: waits from `*now` on until everything that is due at this tick has arrived, and sets `*now` to
  // the time at which it went on. Returns false when the run has ended.
  bool AwaitAnswers(bus::Clock::TimePoint* now);

 private:
  void RunLockstep();
  void RunRealtime();
  void RunAtThePaceOf(Pacemaker& device);
  int64_t AwaitSample(Pacemaker& device, timing::FollowedRateLoop& loop);
  void CheckAndDrive(bus::Clock::TimePoint now);
  [[gnu::cold]] void RequestStopFor(const char* who);

  PlantApp& plant_;
  Pacemaker* const pacemaker_;
  const bool lockstep_;
  const double rate_;   // Hz, ticks per second of plant time
  const double speed_;  // seconds of plant time per second of wall time
  const int64_t last_tick_;
  const double stall_timeout_s_;
};

}  // namespace hydro::plant
