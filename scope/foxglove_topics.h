// The messages of a stack in the form that Foxglove's protocol carries: encoded as CDR and described by ROS 2
// message definitions, which Foxglove, Lichtblick and PlotJuggler read. hydro-log export writes the same to
// MCAP files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/unit_system.h"

namespace hydro::scope {

struct FoxgloveTopic {
  std::string topic;    // "/hydro/state"
  std::string channel;  // LCM channel, without the stack's suffix
  std::string schema_name;

  // A ROS 2 message definition; its comments give the units of the fields for a stack in these units.
  std::string SchemaIn(const UnitSystem& units) const;

  // Writes the message as CDR, little endian. Returns false when the bytes are not such a message.
  bool Encode(const uint8_t* data, int size, std::string* cdr) const;
};

// The topics that change while a stack runs.
const std::vector<FoxgloveTopic>& FoxgloveTopics();

}  // namespace hydro::scope
