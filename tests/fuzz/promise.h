// How a target says that the code under test broke a promise, and runs what may refuse its input.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace hydro::fuzz {

// Ends the process, for libFuzzer to keep the input, when `kept` is false.
inline void Promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

// Runs `work`; false when it refused its input, which must be in one line.
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
