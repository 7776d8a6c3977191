// The events for which the sound check events of a damaged file vouch, wherever these stand.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/mapped_file.h"
#include "runs/log/log_check.h"
#include "runs/log/log_reader.h"

namespace hydro::log {

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

}  // namespace hydro::log
