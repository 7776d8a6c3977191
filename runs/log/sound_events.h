// Finds the events of a damaged log by their structure alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/mapped_file.h"
#include "runs/log/listed_events.h"

namespace hydro::log {

// Bytes of a log that were not kept.
struct LostBytes {
  int64_t begin = 0;
  int64_t end = 0;  // first byte after them
  std::string reason;
};

struct KeptEvent {
  int64_t begin;
  int64_t end;
  bool vouched = false;  // a checksum confirms that it is as it was written
};

// The events of `file` that can be kept, in order, including check events. Appends the bytes between them to
// `lost`.
// - After bytes that are not an event, it looks for the next sync word that begins one.
// - It drops an event with a damaged length, which the bytes after it or inside it reveal, unless it is one
//   of those that check events list.
std::vector<KeptEvent> FindSoundEvents(const MappedFile& file, const ListedEvents& listed,
                                       std::vector<LostBytes>& lost);

}  // namespace hydro::log
