// Checks whether a front end that ran eq. (16) itself (driver.mode = "loop_on_device") answered the states as
// the law does in single precision.
#pragma once

#include <cstdint>
#include <deque>
#include <hydro/motor_command_t.hpp>
#include <map>

#include "pressure_ctrl/pressure_app.h"
#include "settings/stack_config.h"

namespace hydro::hydro_log {

// Takes the device's place in a replay. It returns the recorded answer where that is right, and otherwise the
// answer that would have been right.
class DeviceAnswers : public pressure_ctrl::DeviceLoop {
 public:
  // `recorded`, by tick, must outlive it.
  DeviceAnswers(const settings::StackConfig& config, const std::map<int64_t, motor_command_t>& recorded);

  Answer Follow(const state_t& state, double pressure_ref,
                const pressure_ctrl::PressureLawSettings& law) override;
  void Release() override { sent_.clear(); }

  // The number of answers that a log does not allow to judge: those made while a change of gains was on its
  // way or taking effect.
  int64_t not_judged() const { return not_judged_; }

 private:
  // What was sent at a tick.
  struct Sent {
    int64_t tick = 0;
    float pressure_ref = 0;
    pressure_ctrl::PressureLawSettings law;
  };

  bool WasSent(float pressure_ref) const;
  bool GainsHaveChanged() const;

  const std::map<int64_t, motor_command_t>& recorded_;
  const int64_t delay_;  // ticks that a sent value may take to act
  const int64_t transfer_;
  std::deque<Sent> sent_;  // newest last, over as many ticks as matter
  int64_t not_judged_ = 0;
};

}  // namespace hydro::hydro_log
