// Compares what really reached one logger process with the log that it left. A log must say what happened, or
// say that something is missing.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::torture {

struct LogRecord {
  std::string file;
  std::vector<uint64_t> handled;  // hashes of the messages, in order
  bool killed = false;            // the logger could not end its log
  bool was_full = false;          // the disk refused a write
  bool lied = false;              // the disk changed what was written
  bool deleted = false;           // the file was deleted while it was being written

  void Handle(std::string_view channel, const uint8_t* data, size_t size);
};

// Returns what is wrong with the log; empty when nothing is. Reads the whole log.
std::string WrongWith(const LogRecord& record);

}  // namespace hydro::torture
