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
  // Of the running stack, each keeping at least `rows` ticks and messages of up to `bytes`.
  Run& StartLive(const std::string& name, const std::string& suffix, uint64_t rows, size_t bytes);

  // The live run becomes a past one under another id, of which the newest is kept; a new one takes its place.
  Run& RestartLive();

  // Returns its id.
  uint32_t Add(std::unique_ptr<Run> run);

  // False: there is none of that id, or it is the live one.
  bool Close(uint32_t id);

  Run* Find(uint32_t id);
  Run* live() { return live_; }  // null: none
  std::vector<const Run*> All() const;
  // Grows with each change of the list, or of what its runs say of themselves.
  uint64_t revision() const;
  size_t memory() const;

 private:
  std::unique_ptr<Run> NewLive() const;

  std::vector<std::unique_ptr<Run>> runs_;
  Run* live_ = nullptr;
  Run* past_ = nullptr;
  std::string name_;
  std::string suffix_;
  uint64_t rows_ = 0;
  size_t bytes_ = 0;
  uint32_t next_id_ = 0;
  uint64_t changes_ = 0;
};

}  // namespace hydro::scope
