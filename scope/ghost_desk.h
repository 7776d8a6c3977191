// The ghosts beside runs, each computed on a thread of its own at a lower priority: they delay nobody.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "scope/live_conversation.h"
#include "scope/run_table.h"

namespace hydro::scope {

class GhostDesk : public GhostSwitch {
 public:
  // A ghost beside a live run has the model of the configuration that the scope was started with (Run::listened), whatever the plant says
  // that it runs with: a simulated one names its own model, beside which there is no gap. A log's ghost has the model that the log names.
  explicit GhostDesk(RunTable* runs);
  ~GhostDesk() override;

  // For any run whose model is known; at most 4 at a time. A live one begins with the newest 10 s.
  Outcome Switch(uint32_t run, bool on, double resync_s) override;
  Outcome Sync(uint32_t run) override;

  // Hands new samples to the threads and takes what they have made. Never waits.
  void Poll();

  // Samples of live runs that were left out because the machine was too slow.
  int64_t skipped() const { return skipped_; }

 private:
  class Worker;
  struct Beside;
  std::shared_ptr<const settings::StackConfig> ConfigFor(const Run& run) const;
  void Feed(Run& run, Beside& beside);
  void Collect(Run& run, Beside& beside);

  RunTable& runs_;
  std::map<uint32_t, std::unique_ptr<Beside>> ghosts_;  // by run
  int64_t skipped_ = 0;
};

}  // namespace hydro::scope
