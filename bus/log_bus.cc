#include "bus/log_bus.h"

#include <exception>
#include <stdexcept>
#include <utility>

#include "bus/clock.h"

namespace hydro::bus {

LogBus::LogBus(EventSource source, Options options)
    : source_(std::move(source)),
      options_(std::move(options)),
      wall_start_(std::chrono::steady_clock::now()) {
  if (!(options_.speed >= 0) || (options_.clock != nullptr && options_.speed != 0)) {
    throw std::invalid_argument("the speed of a replay must be at least 0, and 0 on a simulated clock");
  }
  ReadNext();
  first_utime_ = next_.receive_utime;
  if (has_next_ && options_.clock != nullptr) options_.clock->AdvanceTo(DueTime());
}

void LogBus::ReadNext() { has_next_ = source_(&next_); }

LogBus::TimePoint LogBus::DueTime() const {
  using std::chrono::microseconds;
  if (options_.clock != nullptr) return TimePoint(microseconds(next_.receive_utime));
  if (options_.speed == 0) return TimePoint::min();
  const std::chrono::duration<double, std::micro> since(
      static_cast<double>(next_.receive_utime - first_utime_) / options_.speed);
  return wall_start_ + std::chrono::duration_cast<TimePoint::duration>(since);
}

// Returns false when a signal came first.
bool LogBus::WaitUntil(TimePoint time) {
  if (options_.clock != nullptr) {
    options_.clock->AdvanceTo(time);
    return true;
  }
  return SleepUntil(time);
}

int LogBus::HandleUntil(TimePoint deadline) {
  if (handling_) throw std::logic_error("HandleUntil called from a handler");
  while (has_next_) {
    const TimePoint due = DueTime();
    if (due > deadline) break;
    if (!WaitUntil(due)) return 0;
    bool handled = false;
    std::exception_ptr exception;
    handling_ = true;
    try {
      handled = Dispatch(next_);
    } catch (...) {
      exception = std::current_exception();  // rethrown below, once the bus stands at the next event
    }
    handling_ = false;
    ReadNext();
    if (exception) std::rethrow_exception(exception);
    if (handled) return 1;
  }
  WaitUntil(deadline);
  return 0;
}

bool LogBus::Dispatch(const RawMessage& event) {
  bool handled = !taps_.empty();
  // A handler subscribed meanwhile does not get this event.
  const size_t taps = taps_.size(), handlers = handlers_.size();
  for (size_t i = 0; i < taps; ++i) taps_[i](event);
  for (size_t i = 0; i < handlers; ++i) {
    Handler& handler = handlers_[i];
    if (handler.channel != event.channel) continue;
    if (handler.type->decode_into(handler.message.get(), event.data, event.size)) {
      handled = true;
      handler.call(handler.message.get());
    } else {
      ++undecodable_;
    }
  }
  return handled;
}

void LogBus::SubscribeAll(std::function<void(const RawMessage&)> handler) {
  taps_.push_back(std::move(handler));
}

void LogBus::SubscribeTyped(const std::string& channel, const MessageType& type,
                            std::function<void(const void*)> handler) {
  handlers_.push_back({channel, &type, type.create(), std::move(handler)});
}

void LogBus::PublishTyped(const std::string& channel, const MessageType& type, const void* message) {
  if (options_.published) options_.published(channel, type, message);
}

void LogBus::PublishRaw(const std::string& channel, const void* data, int size) {
  if (options_.published_raw) options_.published_raw(channel, data, size);
}

}  // namespace hydro::bus
