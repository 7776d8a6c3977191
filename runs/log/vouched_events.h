// Compares the events that a damaged log still has with its check events.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/mapped_file.h"
#include "runs/log/sound_events.h"

namespace hydro::log {

struct VouchedEvents {
  std::vector<KeptEvent> messages;  // in order, without the check events
  bool found_end = false;           // the last sound event is a mark of the end
  std::string ending;               // what that says
  int64_t check_events = 0;         // sound ones
  int64_t check_bytes = 0;
  int64_t unvouched = 0;      // messages among `messages` of which no checksum says that they are right
  int64_t lost_messages = 0;  // written and not kept, as far as the check events tell
};

// Moves events that have another checksum than when they were written from `events` to `lost`. Where a check
// event is absent or beyond reading, the messages that it would vouch for are kept and counted as `unvouched`. A log
// without check events keeps all of them.
VouchedEvents KeepVouched(const MappedFile& file, const std::vector<KeptEvent>& events,
                          std::vector<LostBytes>& lost);

}  // namespace hydro::log
