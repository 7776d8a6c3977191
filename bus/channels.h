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

  // The channel of a type of message, e.g. Of<state_t>(): HYDRO_STATE and the suffix.
  template <StackMessage Message>
  const std::string& Of() const {
    return names_[MessageIndex<Message>()];
  }

  // In the order of the table.
  const std::array<std::string, kMessageCount>& names() const { return names_; }

 private:
  std::array<std::string, kMessageCount> names_;
};

// Reads the numbers of a message without decoding the rest. Nothing: it takes no part in the loops, or is not
// whole.
std::optional<LoopNumbers> ReadLoopNumbers(const RawMessage& message, const Channels& channels);

}  // namespace hydro::bus
