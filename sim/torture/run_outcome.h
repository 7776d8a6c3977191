// The input of a run, and its outcome.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "settings/stack_config.h"
#include "sim/torture/invariants/observer.h"

namespace hydro::torture {

// The stacks that are run.
struct Stacks {
  settings::StackConfig right;
  settings::StackConfig other;          // started by FaultKind::kOtherConfiguration
  settings::StackConfig other_version;  // started by kOtherVersion
  settings::StackConfig knee;           // the other joint of a limb
  settings::StackConfig whole;          // what an operator addresses: all joints of a limb
};

// A number computed from everything that happened in a run. Two runs with the same number were the same.
class Trace {
 public:
  void Add(uint64_t value) { hash_ = Mixed(hash_ ^ value); }
  void Add(const std::vector<uint8_t>& bytes) {
    size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
      uint64_t word;
      std::memcpy(&word, bytes.data() + at, 8);
      hash_ = (hash_ ^ word) * 0x9fb21c651e98df25u;
      hash_ ^= hash_ >> 29;
    }
    uint64_t rest = bytes.size();
    for (; at < bytes.size(); ++at) rest = rest << 8 | bytes[at];
    Add(rest);
  }
  uint64_t value() const { return hash_; }

 private:
  static uint64_t Mixed(uint64_t x) {
    x = (x ^ (x >> 32)) * 0xd6e8feb86659fd93u;
    return x ^ (x >> 32);
  }
  uint64_t hash_ = 0x243f6a8885a308d3u;
};

struct RunOutcome {
  std::vector<Violation> violations;
  uint64_t trace = 0;  // of everything that happened
  Coverage coverage;
};

}  // namespace hydro::torture
