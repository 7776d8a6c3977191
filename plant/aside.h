// Work that takes longer than a loop may: done on a thread of its own, at ordinary priority, one piece at a time.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "tune/live/change_check.h"

namespace hydro::plant {

class Aside {
 public:
  using Work = std::function<tuning::PreparedChange()>;

  // Without a `thread` the work is done at once, by whoever begins it: on simulated time nothing may depend on how
  // long a thread takes.
  explicit Aside(bool thread);
  ~Aside();

  // Only when no other work is under way.
  void Begin(Work work);
  bool busy() const { return busy_; }

  // The result, once; empty while the work goes on. Does not wait.
  std::optional<tuning::PreparedChange> Take();

 private:
  class Thread;
  std::unique_ptr<Thread> thread_;
  std::optional<tuning::PreparedChange> result_;  // without a thread
  bool busy_ = false;
};

}  // namespace hydro::plant
