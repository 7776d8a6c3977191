// The runs that a scope holds: live runs, the runs before them, and logs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scope/signals/run.h"

namespace hydro::scope {

class RunTable {
 public:
  // Adds the run of a running stack, which keeps at least `rows` ticks and messages of up to `bytes`. Each
  // joint of a limb has a run of its own. `config` is null, or the configuration with which the scope was
  // started.
  Run& StartLive(const std::string& name, const std::string& suffix, uint64_t rows, size_t bytes,
                 std::shared_ptr<const settings::StackConfig> config = nullptr);

  // Makes the live run of that id a past run with a new id, and puts a new run in its place. Only the newest
  // past run is kept.
  Run& RestartLive(uint32_t id = 0);

  // Returns its id.
  uint32_t Add(std::unique_ptr<Run> run);

  // Returns false when there is no run with that id, or when it is live.
  bool Close(uint32_t id);

  Run* Find(uint32_t id);
  Run* live() { return live_.empty() ? nullptr : live_.front().run; }  // the first; null: none
  std::vector<const Run*> AllLive() const;
  std::vector<const Run*> All() const;
  // Grows with each change of the list, or of the facts about its runs.
  uint64_t revision() const;
  size_t memory() const;

 private:
  // A stack to which the scope listens.
  struct Live {
    std::string name;
    std::string suffix;
    uint64_t rows = 0;
    size_t bytes = 0;
    std::shared_ptr<const settings::StackConfig> config;
    Run* run = nullptr;
    Run* past = nullptr;  // the run before it
  };
  static std::unique_ptr<Run> NewRun(const Live& live);

  std::vector<std::unique_ptr<Run>> runs_;
  std::vector<Live> live_;
  uint32_t next_id_ = 0;
  uint64_t changes_ = 0;
};

}  // namespace hydro::scope
