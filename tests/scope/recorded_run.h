// The messages of a simulated run, as a bus or a log would give them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "sim/simulation.h"

namespace hydro::scope {

struct RecordedMessage {
  std::string channel;
  std::vector<uint8_t> data;
  int64_t utime = 0;
};

inline std::vector<RecordedMessage> Record(const settings::StackConfig& config) {
  std::vector<RecordedMessage> messages;
  sim::Simulate(config, [&](const bus::RawMessage& message) {
    messages.push_back(
        {std::string(message.channel), {message.data, message.data + message.size}, message.receive_utime});
  });
  return messages;
}

// A message of its own making.
template <class Message>
RecordedMessage Encoded(const std::string& channel, const Message& message, int64_t utime) {
  RecordedMessage recorded{channel, std::vector<uint8_t>(static_cast<size_t>(message.getEncodedSize())),
                           utime};
  message.encode(recorded.data.data(), 0, static_cast<int>(recorded.data.size()));
  return recorded;
}

inline settings::StackConfig DemoConfig(const std::vector<std::string>& overrides = {}) {
  return settings::LoadStackConfig(HYDRO_TEST_CONFIG, overrides);
}

}  // namespace hydro::scope
