// The runs that a scope holds: a live one, what came before it, and logs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scope/signals/run.h"

namespace hydro::scope {

class RunTable {
 public:
  // Of a running stack, each keeping at least `rows` ticks and messages of up to `bytes`. A limb's joints have one each. `config`: null,
  // or what the scope was started with.
  Run& StartLive(const std::string& name, const std::string& suffix, uint64_t rows, size_t bytes,
                 std::shared_ptr<const settings::StackConfig> config = nullptr);

  // The live run of that id becomes a past one under another, of which the newest is kept; a new one takes its place.
  Run& RestartLive(uint32_t id = 0);

  // Returns its id.
  uint32_t Add(std::unique_ptr<Run> run);

  // False: there is none of that id, or it is a live one.
  bool Close(uint32_t id);

  Run* Find(uint32_t id);
  Run* live() { return live_.empty() ? nullptr : live_.front().run; }  // the first; null: none
  std::vector<const Run*> AllLive() const;
  std::vector<const Run*> All() const;
  // Grows with each change of the list, or of what its runs say of themselves.
  uint64_t revision() const;
  size_t memory() const;

 private:
  // A stack that is listened to.
  struct Live {
    std::string name;
    std::string suffix;
    uint64_t rows = 0;
    size_t bytes = 0;
    std::shared_ptr<const settings::StackConfig> config;
    Run* run = nullptr;
    Run* past = nullptr;  // the run before
  };
  static std::unique_ptr<Run> NewRun(const Live& live);

  std::vector<std::unique_ptr<Run>> runs_;
  std::vector<Live> live_;
  uint32_t next_id_ = 0;
  uint64_t changes_ = 0;
};

}  // namespace hydro::scope
