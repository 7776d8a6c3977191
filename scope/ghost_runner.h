// The ghosts beside runs. Each is computed on a thread of its own at a lower priority, so that none delays
// the server.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "scope/live_conversation.h"
#include "scope/run_table.h"

namespace hydro::scope {

class GhostRunner : public GhostSwitch {
 public:
  // A ghost beside a live run has the model of the configuration with which the scope was started
  // (Run::listened), no matter which model the plant reports: a simulated plant names its own model, and
  // beside that model there is no gap. A log's ghost has the model that the log names.
  explicit GhostRunner(RunTable* runs);
  ~GhostRunner() override;

  // Works for any run whose model is known, for at most 4 at a time. A live ghost begins with the newest 10
  // s.
  Outcome Switch(uint32_t run, bool on, double resync_s) override;
  Outcome Sync(uint32_t run) override;

  // Hands new samples to the threads and takes their results. Never waits.
  void Poll();

  // The number of samples of live runs that were left out because the machine was too slow.
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
