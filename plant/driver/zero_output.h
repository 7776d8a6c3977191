// The one write that must always work: zero volts at the amplifier.
#pragma once

#include "plant/driver/device.h"

namespace hydro::plant {

// Has `device` put out `zero`, and tries again when the device refuses. As async-signal-safe as
// Device::Zero(); preserves errno. Returns whether the device took it.
bool WriteZeroTo(Device& device, double zero) noexcept;

// From now on every way out of this process in which it can still act has `device` put out `zero` first:
// exit(), quick_exit(), std::terminate (an uncaught exception) and every signal that ends or stops a process,
// except SIGKILL, SIGSTOP and those that already have a handler. The signal then takes its default action.
// This lasts until DisarmZero(). A process can arm one device; call ArmZero() after CatchStopSignals().
void ArmZero(Device& device, double zero);
void DisarmZero();

}  // namespace hydro::plant
