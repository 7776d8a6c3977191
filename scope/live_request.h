// Reads and checks the requests that a page sends over its web socket (docs/developers/scope_protocol.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scope/signals/trigger.h"
#include "scope/signals/view.h"

namespace hydro::scope {

struct LiveRequest {
  enum class Op {
    kView,
    kUnview,
    kGet,
    kValues,
    kTrigger,
    kUntrigger,
    kArm,
    kMark,
    kGhost,
    kGhostSync,
    kStop,
    kRearm,
    kRearmForecast,
    kSet,
    kUndo,
  };
  Op op = Op::kView;
  uint32_t id = 0;
  uint32_t run = 0;
  ViewRequest view;        // kView; kGet and kValues use its channels and pixels
  TriggerRequest trigger;  // kTrigger
  double t0 = 0;           // kGet
  double t1 = 0;
  double t = 0;      // kValues, kMark
  std::string text;  // kMark
  bool on = false;   // kGhost
  double resync_s = 0;
  std::vector<std::string> entries;  // kSet
};

// Throws InputError: what was found, what is allowed. `id` receives the request's number if it has one, also
// when this throws.
LiveRequest ParseLiveRequest(std::string_view message, uint32_t* id);

}  // namespace hydro::scope
