// The code of the fault "two processes send this message", which follows from the message's channel: for
// HYDRO_MOTOR_COMMAND it is second_motor_command_sender.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "bus/messages.h"

namespace hydro::process {
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
