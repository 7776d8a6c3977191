// How a target reports that the code under test broke a promise, and runs code that may refuse its input.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "base/input_error.h"

namespace hydro::fuzz {

// Ends the process when `kept` is false, so that libFuzzer keeps the input.
inline void Promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

// Runs `work`; false when it refused its input, which it must do in one line.
template <class Work>
bool Accepts(Work work) {
  try {
    work();
    return true;
  } catch (const InputError& error) {
    Promise(std::strchr(error.what(), '\n') == nullptr, "an error is one line");
    Promise(error.what()[0] != '\0', "an error says something");
    return false;
  }
}

inline std::string_view Text(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace hydro::fuzz
