// Every fault that a process of the stack can raise, and its effect on the voltage. docs/faults.md explains
// the faults, and process/safety lists when they occur; tests keep both and this list in step.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "bus/messages.h"

namespace hydro::process {

enum class FaultEffect {
  kZeroVolts,  // at once
  kRamp,       // the pressure reference goes to zero first (limits.pressure_ramp_s)
  kWarning,    // control goes on
};

struct FaultCode {
  std::string_view code;
  FaultEffect effect;
};

std::span<const FaultCode> FaultCodes();

// True unless `code` is known not to zero the voltage at once; an unknown code counts as one that does.
bool ZeroesVoltage(std::string_view code);

// Like ZeroesVoltage(), but also true for a fault that zeroes the voltage in the end, by ramping the
// reference to zero.
bool LeadsToZeroVolts(std::string_view code);

// True when `code` is known to be a warning only.
bool IsWarning(std::string_view code);

// The code of the fault "two processes send this message", which follows from the message's channel: for
// HYDRO_MOTOR_COMMAND it is second_motor_command_sender.
namespace internal {

template <bus::StackMessage Message>
inline constexpr auto kSecondSenderText = [] {
  constexpr std::string_view kBefore = "second_", kAfter = "_sender";
  constexpr std::string_view kPrefix = "HYDRO_";
  static_assert(bus::RowOf<Message>().channel.starts_with(kPrefix));
  constexpr std::string_view kName = bus::RowOf<Message>().channel.substr(kPrefix.size());
  std::array<char, kBefore.size() + kName.size() + kAfter.size() + 1> text{};
  char* end = std::copy(kBefore.begin(), kBefore.end(), text.begin());
  end = std::transform(kName.begin(), kName.end(), end,
                       [](char c) { return c == '_' ? c : char(c - 'A' + 'a'); });
  std::copy(kAfter.begin(), kAfter.end(), end);
  return text;
}();

}  // namespace internal

template <bus::StackMessage Message>
inline constexpr const char* kSecondSender = internal::kSecondSenderText<Message>.data();

}  // namespace hydro::process
