// Names of the channels. A suffix ("_2") lets two stacks share one network.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "bus/bus.h"
#include "bus/messages.h"

namespace hydro::bus {

class Channels {
 public:
  explicit Channels(const std::string& suffix = "");

  // The channel of a message type, e.g. Of<state_t>(): HYDRO_STATE plus the suffix.
  template <StackMessage Message>
  const std::string& Of() const {
    return names_[MessageIndex<Message>()];
  }

  // The text that follows each channel's own name.
  std::string suffix() const { return Of<fault_t>().substr(RowOf<fault_t>().channel.size()); }

  // The names, in the table's order.
  const std::array<std::string, kMessageCount>& names() const { return names_; }

 private:
  std::array<std::string, kMessageCount> names_;
};

// Reads a message's numbers without decoding the rest. Empty when the message takes no part in the loops or
// is incomplete.
std::optional<LoopNumbers> ReadLoopNumbers(const RawMessage& message, const Channels& channels);

}  // namespace hydro::bus
