// The messages of a run, with a list for each row of the table of messages.
#pragma once

#include <tuple>
#include <vector>

#include "bus/messages.h"

namespace hydro::runs {

class RunMessages {
 public:
  template <bus::StackMessage Message>
  std::vector<Message>& Of() {
    return std::get<std::vector<Message>>(lists_);
  }
  template <bus::StackMessage Message>
  const std::vector<Message>& Of() const {
    return std::get<std::vector<Message>>(lists_);
  }

 private:
  template <class... Message>
  static std::tuple<std::vector<Message>...> ListsFor(const std::tuple<bus::MessageRow<Message>...>&);

  decltype(ListsFor(bus::kMessages)) lists_;
};

}  // namespace hydro::runs
