#include "sim/torture/invariants/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>

#include "base/read_files.h"
#include "bus/messages.h"
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

constexpr size_t kMostFalse = 256;
constexpr size_t kMostSenders = 64;

bool Same(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }

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

void LossCount::Handle(const Packet& state) {
  constexpr bus::NumberPlaces kPlaces = bus::PlacesOf<state_t>();
  countable_ = countable_ && state.origin == Origin::kProcess;
  if (!countable_) return;
  const int64_t session = NumberAt(state, kPlaces.session), sequence = NumberAt(state, kPlaces.sequence);
  if (!session_) {
    session_ = session;
  } else if (session != *session_ || sequence < newest_) {
    countable_ = false;  // the process decides which plant it follows, and from when on
    return;
  } else if (sequence > newest_) {
    lost_ += sequence - newest_ - 1;
  }
  newest_ = sequence;
}

void PlantRecord::Receive(const ReceivedCommand& command) {
  if (read_tick < 0 || command.tick < 0) return;  // it does not answer any state
  if (command.tick <= read_tick) Hear(command);   // one for a future tick is another fault
  if (command.origin != Origin::kProcess && command.origin != Origin::kRepeated) {
    false_.push_back(command);
    false_.back().silence = command.handled - genuine;
    if (false_.size() > kMostFalse) false_.pop_front();
    return;
  }
  if (command.tick <= read_tick - kRemembered) return;
  genuine = command.handled;
  // A repetition may arrive before the message that it repeats.
  Tick& entry = At(command.tick);
  ReceivedCommand& first = entry.answers[0];
  (first.tick < 0 || first.session == command.session ? first : entry.answers[1]) = command;
}

void PlantRecord::Hear(const ReceivedCommand& command) {
  const auto last = senders.find(command.session);
  if (last != senders.end()) {
    last->second = command.handled;
  } else if (senders.size() < kMostSenders) {
    senders[command.session] = command.handled;
  }
}

std::optional<ReceivedCommand> PlantRecord::Newest(double wanted, int64_t oldest, int64_t newest) {
  oldest = std::max({oldest, newest - kRemembered + 1, int64_t{0}});
  for (int64_t at = newest; at >= oldest; --at) {
    const Tick& entry = ticks_[static_cast<uint64_t>(at) % kRemembered];
    if (entry.tick != at) continue;
    for (const ReceivedCommand& command : entry.answers) {
      if (command.tick == at && Same(command.voltage, wanted)) return command;
    }
  }
  return std::nullopt;
}

const ReceivedCommand* PlantRecord::NewestFalse(double wanted) const {
  const auto found = std::find_if(false_.rbegin(), false_.rend(),
                                  [&](const ReceivedCommand& c) { return Same(c.voltage, wanted); });
  return found == false_.rend() ? nullptr : &*found;
}

}  // namespace hydro::torture
