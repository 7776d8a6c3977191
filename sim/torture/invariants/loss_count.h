// The number of states that one process has really missed, counted from what reached it. The process's own
// count must be the same.
#pragma once

#include <cstdint>
#include <optional>

#include "sim/torture/machines/packet.h"

namespace hydro::torture {

class LossCount {
 public:
  // A state was passed to the process.
  void Handle(const Packet& state);

  // States missing before or between those that were handled. None where a state was changed, forged or from
  // a second plant, because the count then depends on more than the network.
  std::optional<int64_t> lost() const { return countable_ ? std::optional(lost_) : std::nullopt; }

 private:
  std::optional<int64_t> session_;
  int64_t newest_ = 0;
  int64_t lost_ = 0;
  bool countable_ = true;
};

}  // namespace hydro::torture
