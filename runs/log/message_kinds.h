// The table of messages in the form that readers of logs need: the type of the messages on each channel.
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
  int64_t hash;                            // the first bytes of an encoded message of the type
  bool (*decodes)(const LogEvent& event);  // whether it is a whole message of the type
  // The sender of a message that takes part in the control loops, on a channel that has one sender; none for
  // any other message.
  std::optional<int64_t> (*session)(const LogEvent& event);
};

// All kinds, in the order of the table of messages (bus/messages.h).
const std::vector<MessageKind>& MessageKinds();

// The kind whose name `channel` begins with; the rest of `channel` is the suffix. Null: it is not a channel
// of this stack.
const MessageKind* KindOfChannel(std::string_view channel);

}  // namespace hydro::log
