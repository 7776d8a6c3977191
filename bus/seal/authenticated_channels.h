// Which channels are authenticated when the stack has a key.
#pragma once

#include <string>
#include <vector>

#include "bus/channels.h"

namespace hydro::bus {

// The channels that the table of messages marks as sealed; the channel of the introductions comes first.
inline std::vector<std::string> AuthenticatedChannels(const Channels& channels) {
  std::vector<std::string> sealed = {channels.Of<introduction_t>()};
  ForEachMessage([&]<class Message>(const MessageRow<Message>& row) {
    const std::string& channel = channels.Of<Message>();
    if (row.sealed && channel != sealed.front()) sealed.push_back(channel);
  });
  return sealed;
}

}  // namespace hydro::bus
