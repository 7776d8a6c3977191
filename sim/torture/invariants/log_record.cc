#include "sim/torture/invariants/log_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>

#include "base/read_files.h"
#include "runs/log/log_reader.h"

namespace hydro::torture {
namespace {

uint64_t HashOf(std::string_view channel, const uint8_t* data, size_t size) {
  const std::hash<std::string_view> hash;
  return hash(channel) * 0x9fb21c651e98df25u ^ hash({reinterpret_cast<const char*>(data), size});
}

// The number of messages that the log says it lacks although its logger had received them.
int64_t SaidToBeMissing(const log::LogVerdict& verdict) {
  int64_t missing = 0;
  for (const std::string& remark : verdict.remarks) {
    if (remark.find("messages are not in the log") != std::string::npos)
      missing += std::atoll(remark.c_str());
  }
  return missing;
}

}  // namespace

void LogRecord::Handle(std::string_view channel, const uint8_t* data, size_t size) {
  handled.push_back(HashOf(channel, data, size));
}

std::string WrongWith(const LogRecord& record) {
  log::LogReader reader(record.file, log::OnDamage::kStop);
  std::vector<uint64_t> written;
  log::LogEvent event;
  while (reader.Next(event))
    written.push_back(HashOf(event.channel, event.data, static_cast<size_t>(event.size)));
  const log::LogVerdict verdict = reader.verdict();
  ForgetRead(record.file);
  const bool complete = verdict.completeness == log::Completeness::kComplete;
  if (complete && (record.killed || record.lied)) {
    return fmt::format("it says that it is complete; {}",
                       record.lied ? "a bit of it was changed" : "its logger was killed");
  }
  if (!complete && !record.killed && !record.was_full && !record.lied) {
    return fmt::format("it is {}: {}; nothing has happened to it", log::NameOf(verdict.completeness),
                       verdict.where);
  }
  // No checksum covers the end of a log that was cut off.
  if (record.lied && verdict.completeness == log::Completeness::kIncomplete) return "";
  // Sorted, because in lockstep the logger restores an order.
  std::vector<uint64_t> received = record.handled;
  std::sort(received.begin(), received.end());
  std::sort(written.begin(), written.end());
  if (!std::includes(received.begin(), received.end(), written.begin(), written.end())) {
    return fmt::format("it is {} and holds a message that its logger has not received",
                       log::NameOf(verdict.completeness));
  }
  const auto missing = static_cast<int64_t>(received.size() - written.size());
  if (complete && missing != SaidToBeMissing(verdict)) {
    return fmt::format("it is complete and lacks {} of {} messages; it says {}", missing, received.size(),
                       SaidToBeMissing(verdict));
  }
  return "";
}

}  // namespace hydro::torture
