// Random numbers that are the same with every standard library. Each purpose has a stream of its own, so that
// a further draw for one purpose changes no other.
#pragma once

#include <cstdint>
#include <numbers>
#include <string_view>

namespace foreign_rig {

inline constexpr double kTurn = 2 * std::numbers::pi;  // rad: phases are drawn from 0 to it

class Draw {
 public:
  Draw(uint64_t seed, std::string_view purpose);

  double Uniform();  // in (0, 1)
  double Between(double low, double high) { return low + (high - low) * Uniform(); }
  double LogBetween(double low, double high);
  double Normal();
  int Index(int count);  // 0 ... count - 1
  bool Chance(double probability) { return Uniform() < probability; }
  double Sign() { return Chance(0.5) ? 1 : -1; }

 private:
  uint64_t Next();

  uint64_t state_;
};

}  // namespace foreign_rig
