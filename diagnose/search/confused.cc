#include "diagnose/search/confused.h"

#include <string>

namespace hydro::diagnose {

bool IsConfusedWith(const Change& one, const Change& other) {
  if (one.effect.empty() || other.effect.empty() || one.effect == other.effect) return false;
  return model::FindEffect(one.effect)->confused_with.find(other.effect) != std::string::npos;
}

bool AreConfused(const Change& a, const Change& b) { return IsConfusedWith(a, b) || IsConfusedWith(b, a); }

}  // namespace hydro::diagnose
