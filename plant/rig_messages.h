// What a rig has to say to the others, as messages: its measurements at each tick (HYDRO_STATE), its faults,
// and what its output holds at the end of the run.
#pragma once

#include <cstdint>
#include <hydro/state_t.hpp>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "plant/rig.h"
#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// What a person must do about an output that refused the zero.
std::string NotAtZero(const OutputLeft& left);

class RigMessages {
 public:
  // Both must outlive this object.
  RigMessages(process::Participant& participant, Rig& rig, const settings::StackConfig& config);

  // Reads the rig at this tick, up to which `voltage`, from the command of `command_tick`, has acted. Throws
  // RigError.
  void Measure(int64_t tick, double voltage, int64_t command_tick) {
    state_.voltage = voltage;
    state_.command_tick = command_tick;
    model::Measurement measured;
    CopyFresh(&measured, rig_.Read(tick));
    state_.motor_angle = measured.motor_angle;
    state_.motor_speed = measured.motor_speed;
    state_.arm_angle = measured.arm_angle;
    state_.arm_speed = measured.arm_speed;
    state_.p1 = measured.p1;
    state_.p2 = measured.p2;
  }

  // Publishes what was measured, as the state of this tick.
  void PublishState(int64_t tick, int64_t skipped_ticks) {
    state_.utime = participant_.clock().Utime();
    state_.tick = tick;
    state_.session = participant_.session();
    ++state_.sequence;
    state_.time = static_cast<double>(tick) / rate_;
    state_.skipped_ticks = skipped_ticks;
    publisher_.Send(state_);
  }
  // Sends the same state once more: it or its answer may have been lost.
  void RepeatState() { publisher_.Send(state_); }
  const state_t& state() const { return state_; }

  // Publishes the rig's faults that have begun or ended.
  void PublishFaults(int64_t tick) {
    if (!rig_.faults().empty() || !active_faults_.empty()) PublishChanges(tick);
  }

  void PublishOutputLeft(const OutputLeft& left);

 private:
  [[gnu::cold]] void PublishChanges(int64_t tick);

  process::Participant& participant_;
  Rig& rig_;
  const double rate_;  // Hz
  bus::Publisher<state_t> publisher_;
  state_t state_{};
  std::vector<std::string> active_faults_;  // codes
};

}  // namespace hydro::plant
