#include "draw.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

// The purpose is hashed by FNV-1a.
Draw::Draw(uint64_t seed, std::string_view purpose) : state_(0xcbf29ce484222325u) {
  for (const char c : purpose) state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  state_ += seed * 0x9e3779b97f4a7c15u;
  Next();
}

// SplitMix64 (Steele, Lea and Flood 2014).
uint64_t Draw::Next() {
  uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double Draw::Uniform() { return (static_cast<double>(Next() >> 11) + 0.5) * 0x1p-53; }

double Draw::LogBetween(double low, double high) { return low * std::pow(high / low, Uniform()); }

double Draw::Normal() {
  const double radius = std::sqrt(-2 * std::log(Uniform()));
  return radius * std::cos(6.283185307179586 * Uniform());
}

int Draw::Index(int count) { return std::min(count - 1, static_cast<int>(Uniform() * count)); }

}  // namespace foreign_rig
