// The one write that must always work: zero volts at the amplifier.
#pragma once

#include <comedilib.h>

#include <cstdint>
#include <optional>

namespace hydro::plant {

// Plain numbers, so that a signal handler or a forked child may use it: it allocates nothing, takes no lock
// and calls only comedi_data_write, comedi_dio_write and comedi_errno. In libcomedi 0.11 these fill a struct
// on the stack and make one ioctl; an error is stored in a global int (and printed only at a log level that
// this project never sets).
struct ZeroOutput {
  comedi_t* device = nullptr;
  unsigned subdevice = 0;
  unsigned channel = 0;
  unsigned range = 0;
  unsigned reference = 0;
  uint32_t zero_code = 0;
  bool has_watchdog = false;
  unsigned watchdog_subdevice = 0;
  unsigned watchdog_channel = 0;

  // Writes zero volts, then sets the watchdog line low. Tries again when the board refuses. Async-signal-safe
  // as far as the above holds; preserves errno. Returns whether the board accepted the zero.
  bool Write() const noexcept;

  // The code that the output holds; nothing when the board cannot read it back. Not for signal handlers.
  std::optional<uint32_t> ReadBack() const noexcept;
};

// From now on every way out of this process in which it can still act writes `output` first: exit(),
// quick_exit(), std::terminate (an uncaught exception) and every signal that ends or stops a process, except
// SIGKILL, SIGSTOP and those that already have a handler. The signal then takes its default action. Lasts
// until DisarmZero(). One output per process; call it after CatchStopSignals().
void ArmZero(const ZeroOutput& output);
void DisarmZero();

}  // namespace hydro::plant
