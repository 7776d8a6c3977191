// From a board's numbers to signals: scales, encoder counts, low passes. Pure: time is passed in.
#pragma once

#include <cstdint>
#include <optional>

namespace hydro::plant {

// A converter whose codes 0 to `max_code` stand for `minimum_V` to `maximum_V`, evenly, as Comedi's do.
struct ConverterRange {
  uint32_t max_code = 0;
  double minimum_V = 0;
  double maximum_V = 0;

  double Volts(uint32_t code) const;
  // The nearest code; beyond the range, its end. NaN gives that of 0 V.
  uint32_t Code(double volts) const;
};

// Counts of an up-and-down counter that wraps from `max_count` to 0 and back.
class EncoderCount {
 public:
  explicit EncoderCount(uint32_t max_count) : modulus_(int64_t{max_count} + 1) {}

  // The count without wraps. The first reading is taken as signed: just below the wrap is just below zero.
  // Between two readings the counter may move by less than a quarter of its range; nothing when it has moved
  // more, where a turn forth cannot be told from one back.
  std::optional<int64_t> Update(uint32_t reading);

 private:
  int64_t modulus_;
  int64_t reading_ = 0;
  int64_t count_ = 0;
  bool started_ = false;
};

// First-order low pass, y' = 2 pi corner (x - y), exact for an input that is held between its samples,
// however far apart they are. Starts at its first input.
class LowPass {
 public:
  // `corner_hz` 0: what comes in goes out.
  explicit LowPass(double corner_hz) : corner_hz_(corner_hz) {}

  // `elapsed_s` since the last update. NaN goes through, and the next number is a first one.
  double Update(double input, double elapsed_s);

 private:
  double corner_hz_;
  std::optional<double> output_;
};

// The rate of a signal from one sample to the next: 0 at first, NaN beside NaN.
class Derivative {
 public:
  // `elapsed_s` since the last update, above 0; else the rate stays what it was.
  double Update(double input, double elapsed_s);

 private:
  std::optional<double> input_;
  double rate_ = 0;
};

}  // namespace hydro::plant
