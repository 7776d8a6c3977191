// Finds the events of a damaged log by their structure alone, and those for which its sound check events
// vouch, wherever these stand.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/mapped_file.h"
#include "runs/log/log_check.h"
#include "runs/log/log_reader.h"

namespace hydro::log {

// The events for which the sound check events of a file vouch.
//
// A check event says which number and which checksum each message before it has. So a message can be
// recognised in a file that was joined from parts, merged or shuffled, in which other messages stand between
// it and its check event.
class ListedEvents {
 public:
  explicit ListedEvents(const MappedFile& file);

  // Whether a check event lists this event.
  bool Contains(int64_t number, uint32_t checksum) const;

  bool empty() const { return listed_.empty(); }

 private:
  void Add(const LogEvent& check_event, const LogCheck& check);

  std::vector<std::pair<int64_t, uint32_t>> listed_;  // number and checksum, sorted
};

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
