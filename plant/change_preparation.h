// Prepares a change of values, which takes longer than a loop may wait: on a thread of its own, at ordinary
// priority, one change at a time.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "tune/live/change_check.h"

namespace hydro::plant {

class ChangePreparation {
 public:
  using Work = std::function<tuning::PreparedChange()>;

  // Without a `thread`, Begin() does the work at once: on simulated time, nothing may depend on how long a
  // thread takes.
  explicit ChangePreparation(bool thread);
  ~ChangePreparation();

  // Call it only when no other work is under way.
  void Begin(Work work);
  bool busy() const { return busy_; }

  // Returns the result once, and nothing while the work goes on. Does not wait.
  std::optional<tuning::PreparedChange> Take();

 private:
  class Thread;
  std::unique_ptr<Thread> thread_;
  std::optional<tuning::PreparedChange> result_;  // without a thread
  bool busy_ = false;
};

}  // namespace hydro::plant
