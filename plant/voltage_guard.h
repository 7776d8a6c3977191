// Decides which faults force zero volts, and until when. Pure: it takes each tick's findings and voltages and
// knows no clock, message or file. The plant and the hardware driver share it.
#pragma once

#include <cstdint>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::plant {

class VoltageGuard {
 public:
  enum class Cause : uint8_t {
    kNonfiniteCommand,
    kExcessiveCommand,
    kFutureCommand,
    kStaleCommand,
    kSecondCommandSender,
    kOtherStack,
    kLatePlant,
    kControllerFault,
    kRigFault,
    kSupervisorGone,
    kOtherJoint,
    kJointGone,
    kSuspended,
    kPressureLimit,
    kMotorSpeedLimit,
    kArmAngleLimit,
    kCount
  };

  explicit VoltageGuard(settings::Rearm rearm) : rearm_(rearm) {}

  // The fault's name on HYDRO_FAULT.
  static const char* CodeOf(Cause cause);

  // Causes that latch in either rearm mode: a good next input does not undo an exceeded limit or a suspend.
  static bool Trips(Cause cause) { return cause >= Cause::kSuspended; }

  // Records whether this tick's check found the cause. A cause that latches stays active after it has gone.
  // kOtherJoint never latches here: it latches in the joint that has the fault.
  void Set(Cause cause, bool present);

  bool present(Cause cause) const { return (present_ & Bit(cause)) != 0; }
  bool latched(Cause cause) const { return (latched_ & Bit(cause)) != 0; }
  bool active(Cause cause) const { return present(cause) || latched(cause); }
  bool any() const { return (present_ | latched_) != 0; }
  bool any_but(Cause cause) const { return ((present_ | latched_) & ~Bit(cause)) != 0; }
  bool any_present() const { return present_ != 0; }

  // The voltage that may reach the motor: all of the commanded voltage, or zero.
  double Voltage(double commanded) const { return any() ? 0 : commanded; }

  // Ends all latched causes and returns them. If any cause but kOtherJoint is still present, it ends nothing,
  // returns nothing and fills `present`. kOtherJoint is excepted because two joints would otherwise wait for
  // each other.
  std::vector<Cause> Release(std::vector<Cause>* present);

 private:
  static uint32_t Bit(Cause cause) { return 1u << static_cast<unsigned>(cause); }
  static std::vector<Cause> Listed(uint32_t bits);

  const settings::Rearm rearm_;
  uint32_t present_ = 0;
  uint32_t latched_ = 0;
};

}  // namespace hydro::plant
