// The table of messages in the form that readers of logs need: which type lies on which channel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runs/log/log_reader.h"

namespace hydro::log {

struct MessageKind {
  std::string channel;                     // without suffix, e.g. HYDRO_STATE
  std::string type;                        // e.g. hydro.state_t
  int64_t hash;                            // what an encoded message of the type begins with
  bool (*decodes)(const LogEvent& event);  // whether it is a whole message of the type
  // The sender of a message that takes part in the control loops, where a channel has one sender; none of any other.
  std::optional<int64_t> (*session)(const LogEvent& event);
};

// All kinds, in the order of the table of messages (bus/messages.h).
const std::vector<MessageKind>& MessageKinds();

// The kind whose name `channel` begins with; the rest is the suffix. Null: not a channel of this stack.
const MessageKind* KindOfChannel(std::string_view channel);

}  // namespace hydro::log
