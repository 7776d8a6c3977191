#include "scope/signals/events.h"

#include <utility>

namespace hydro::scope {

const Event& EventList::Add(Event event) {
  event.n = ++last_;
  events_.push_back(std::move(event));
  if (events_.size() > kMost) events_.pop_front();
  return events_.back();
}

}  // namespace hydro::scope
