// Random numbers that are the same on every machine, unlike those of the standard library's distributions.
#pragma once

#include <cstdint>

namespace hydro::torture {

// SplitMix64 (Steele, Lea and Flood 2014). Cheap to make: everything that draws has one of its own, so that
// leaving out one fault of a schedule changes nothing that the others draw.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  Random(uint64_t seed, uint64_t stream) : state_(seed) { state_ = Next() ^ (stream * 0xd1342543de82ef95u); }

  uint64_t Next() {
    uint64_t x = state_ += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }

  // In [0, 1).
  double Unit() { return static_cast<double>(Next() >> 11) * 0x1p-53; }
  double Between(double low, double high) { return low + (high - low) * Unit(); }
  bool Chance(double probability) { return Unit() < probability; }
  // In [0, count).
  uint64_t Index(uint64_t count) { return Next() % count; }

 private:
  uint64_t state_;
};

}  // namespace hydro::torture
