#include "plant/voltage_guard.h"

#include "process/fault_codes.h"

namespace hydro::plant {

const char* VoltageGuard::CodeOf(Cause cause) {
  switch (cause) {
    case Cause::kNonfiniteCommand:
      return "nonfinite_motor_command";
    case Cause::kExcessiveCommand:
      return "excessive_motor_command";
    case Cause::kFutureCommand:
      return "future_motor_command";
    case Cause::kStaleCommand:
      return "stale_motor_command";
    case Cause::kSecondCommandSender:
      return process::kSecondSender<motor_command_t>;
    case Cause::kOtherStack:
      return "other_stack";
    case Cause::kLatePlant:
      return "late_plant";
    case Cause::kControllerFault:
      return "controller_fault";
    case Cause::kRigFault:
      return "rig_fault";
    case Cause::kSupervisorGone:
      return "supervisor_gone";
    case Cause::kOtherJoint:
      return "other_joint";
    case Cause::kJointGone:
      return "joint_gone";
    case Cause::kSuspended:
      return "machine_suspended";
    case Cause::kPressureLimit:
      return "pressure_limit";
    case Cause::kMotorSpeedLimit:
      return "motor_speed_limit";
    case Cause::kArmAngleLimit:
      return "arm_angle_limit";
    case Cause::kCount:
      break;
  }
  return "";
}

void VoltageGuard::Set(Cause cause, bool present) {
  if (!present) {
    present_ &= ~Bit(cause);
    return;
  }
  present_ |= Bit(cause);
  const bool latches = rearm_ == settings::Rearm::kExplicit && cause != Cause::kOtherJoint;
  if (latches || Trips(cause)) latched_ |= Bit(cause);
}

std::vector<VoltageGuard::Cause> VoltageGuard::Release(std::vector<Cause>* present) {
  *present = Listed(present_ & ~Bit(Cause::kOtherJoint));
  if (!present->empty()) return {};
  std::vector<Cause> ended = Listed(latched_);
  latched_ = 0;
  return ended;
}

std::vector<VoltageGuard::Cause> VoltageGuard::Listed(uint32_t bits) {
  std::vector<Cause> causes;
  for (unsigned i = 0; i < static_cast<unsigned>(Cause::kCount); ++i) {
    if ((bits >> i & 1u) != 0) causes.push_back(static_cast<Cause>(i));
  }
  return causes;
}

}  // namespace hydro::plant
