// A binary message of bins, taken apart.
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace hydro::scope {

struct DecodedBins {
  uint32_t id = 0;
  uint32_t run = 0;
  uint32_t flags = 0;
  double t0 = 0;
  double width = 0;
  uint32_t bins = 0;
  std::vector<std::vector<double>> min;  // by channel
  std::vector<std::vector<double>> max;
};

inline DecodedBins Decode(const std::string& bytes) {
  DecodedBins decoded;
  size_t at = 4;
  const auto take = [&](auto* value) {
    if (at + sizeof *value > bytes.size()) throw std::runtime_error("the message ends early");
    std::memcpy(value, bytes.data() + at, sizeof *value);
    at += sizeof *value;
  };
  uint32_t channels = 0;
  take(&decoded.id);
  take(&decoded.run);
  take(&decoded.flags);
  take(&decoded.t0);
  take(&decoded.width);
  take(&decoded.bins);
  take(&channels);
  for (uint32_t c = 0; c < channels; ++c) {
    for (auto* list : {&decoded.min, &decoded.max}) {
      list->emplace_back(decoded.bins);
      for (double& value : list->back()) take(&value);
    }
  }
  if (at != bytes.size()) throw std::runtime_error("the message is too long");
  return decoded;
}

}  // namespace hydro::scope
