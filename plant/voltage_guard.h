// Which faults force zero volts, and until when. Pure: it knows ticks' findings and voltages, and no clock,
// message or file; the plant and the hardware driver share it.
#pragma once

#include <cstdint>
#include <string>
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
    kSuspended,
    kPressureLimit,
    kMotorSpeedLimit,
    kArmAngleLimit,
    kCount
  };

  explicit VoltageGuard(settings::Rearm rearm) : rearm_(rearm) {}

  // The fault's name on HYDRO_FAULT.
  static const char* CodeOf(Cause cause);

  // Latches however faults are ended: what was passed cannot be made good by the next input.
  static bool Trips(Cause cause) { return cause >= Cause::kSuspended; }

  // What was found in this tick. A cause that latches stays active when it has gone.
  void Set(Cause cause, bool present);

  bool present(Cause cause) const { return (present_ & Bit(cause)) != 0; }
  bool latched(Cause cause) const { return (latched_ & Bit(cause)) != 0; }
  bool active(Cause cause) const { return present(cause) || latched(cause); }
  bool any() const { return (present_ | latched_) != 0; }
  bool any_latched() const { return latched_ != 0; }

  // What may reach the motor of what was asked for.
  double Voltage(double commanded) const { return any() ? 0 : commanded; }

  // Ends what is latched, unless a cause is still present; returns what was ended. Nothing is ended, and
  // `standing` has the causes, where one is.
  std::vector<Cause> Release(std::vector<Cause>* standing);

 private:
  static uint32_t Bit(Cause cause) { return 1u << static_cast<unsigned>(cause); }
  static std::vector<Cause> Listed(uint32_t bits);

  const settings::Rearm rearm_;
  uint32_t present_ = 0;
  uint32_t latched_ = 0;
};

}  // namespace hydro::plant
