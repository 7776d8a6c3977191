// The messages of a stack as Foxglove's protocol carries them: encoded as CDR, described by ROS 2 message definitions, which
// Foxglove, Lichtblick and PlotJuggler read. hydro-log export writes the same to MCAP files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/unit_system.h"

namespace hydro::scope {

struct FoxgloveTopic {
  std::string topic;    // "/hydro/state"
  std::string channel;  // of LCM, without the stack's suffix
  std::string schema_name;

  // A ROS 2 message definition; its comments say in which units the fields of such a stack are.
  std::string SchemaIn(const UnitSystem& units) const;

  // Writes the message as CDR, little endian. False: the bytes are no such message.
  bool Encode(const uint8_t* data, int size, std::string* cdr) const;
};

// Those that change while a stack runs.
const std::vector<FoxgloveTopic>& FoxgloveTopics();

}  // namespace hydro::scope
