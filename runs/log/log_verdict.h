// Whether a log is exactly what its writer wrote, and all of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/mapped_file.h"

namespace hydro::log {

enum class Completeness {
  kComplete,          // every checksum is right, and the mark of the end is there
  kIncomplete,        // the mark is missing: still being recorded, cut off, or its recorder was killed
  kDamaged,           // something in it differs from what was written
  kWithoutChecksums,  // from lcm-logger or an older version: only its structure could be judged
};

struct LogVerdict {
  Completeness completeness = Completeness::kWithoutChecksums;
  // Damaged and incomplete: the place, and what was found there.
  std::string where;
  // Events that end at or before this byte can be read; what follows is damaged or torn.
  int64_t readable_end = 0;
  // Incomplete: the messages after the last check event, which no checksum vouches for.
  int64_t unchecked_messages = 0;
  std::string note;  // where the log comes from, if not from a recording (hydro-log repair states it here)
  std::vector<std::string> remarks;  // remarks of the recorder on what it left out
  bool found_end = false;            // the (last) mark of the end was there
  std::string ending;  // why it ends, if not because the recording was finished (rotation, repair)
};

// Reads the whole file once.
LogVerdict ExamineLog(const MappedFile& file);

// "complete", "incomplete", "damaged", "without checksums".
const char* NameOf(Completeness completeness);

// Whether the log itself says that its recording continued, or may have continued, after its last message.
bool EndIsOpen(const LogVerdict& verdict);

// One line with what a reader of the log must know before trusting a result; empty when there is nothing.
std::string Caution(const LogVerdict& verdict);

}  // namespace hydro::log
