// Random numbers that are the same with every standard library; those of its distributions are not.
#pragma once

#include <cstdint>
#include <string_view>

namespace hydro {

// SplitMix64's output function (Steele, Lea and Flood 2014): a bijection that scatters neighbouring inputs.
constexpr uint64_t Scatter(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// Turns a name into a key for drawing: its 64-bit FNV-1a hash.
constexpr uint64_t NameKey(std::string_view name) {
  uint64_t key = 0xcbf29ce484222325u;
  for (const char c : name) key = (key ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return key;
}

// A standard normal number that depends on `key` alone: Box-Muller on two outputs of SplitMix64. At most 8.6
// in size. Its last bits are those of the C library's log and cos.
double StandardNormal(uint64_t key);

// A sequence of random numbers: SplitMix64. Cheap to make: everything that draws has a sequence of its own,
// so that leaving out the draws of one changes none of the others'.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  Random(uint64_t seed, uint64_t stream) : state_(seed) { state_ = Next() ^ (stream * 0xd1342543de82ef95u); }

  uint64_t Next() {
    const uint64_t number = Scatter(state_);
    state_ += 0x9e3779b97f4a7c15u;
    return number;
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

}  // namespace hydro
