// What really reached one logger process, held against the log that it has left: what a log says happened is what
// happened, or it says that something is missing.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::torture {

struct LogRecord {
  std::string file;
  std::vector<uint64_t> handled;  // hashes of the messages, in order
  bool killed = false;            // it could not end its log
  bool was_full = false;          // the disk refused a write
  bool lied = false;              // the disk has changed what was written
  bool deleted = false;           // somebody has taken it away from its name

  void Handle(std::string_view channel, const uint8_t* data, size_t size);
};

// What is wrong with the log; empty when nothing is. Reads it whole.
std::string WrongWith(const LogRecord& record);

}  // namespace hydro::torture
