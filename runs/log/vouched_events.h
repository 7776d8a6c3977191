// Compares the events that are left in a damaged log with its check events.
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
  std::string ending;               // the text of that mark
  int64_t check_events = 0;         // number of sound ones
  int64_t check_bytes = 0;
  int64_t unvouched = 0;      // those in `messages` for which no checksum vouches
  int64_t lost_messages = 0;  // messages that were written but are not kept, as far as the check events tell
};

// Moves events that differ from what was written from `events` to `lost`: those that stand before their check
// event, but that no check event lists. Messages that no check event covers are kept and counted as
// `unvouched`: where their check event is missing or unreadable, where the file was cut before it and another
// log was joined to it. A log without check events keeps all of them.
VouchedEvents KeepVouched(const MappedFile& file, const ListedEvents& listed,
                          const std::vector<KeptEvent>& events, std::vector<LostBytes>& lost);

}  // namespace hydro::log
