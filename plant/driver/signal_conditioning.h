// Turns a board's numbers into signals with scales, encoder counts and low passes. Pure: time is passed in.
#pragma once

#include <cstdint>
#include <optional>

namespace hydro::plant {

// A converter whose codes 0 to `max_code` map linearly to `minimum_V` to `maximum_V`, as Comedi's do.
struct ConverterRange {
  uint32_t max_code = 0;
  double minimum_V = 0;
  double maximum_V = 0;

  double Volts(uint32_t code) const;
  // The nearest code; beyond the range, the code at that end of it. NaN gives the code of 0 V.
  uint32_t Code(double volts) const;
};

// The count of an up/down counter that wraps between `max_count` and 0.
class EncoderCount {
 public:
  explicit EncoderCount(uint32_t max_count) : modulus_(int64_t{max_count} + 1) {}

  // The unwrapped count. The first reading counts as signed: a reading just below the wrap means just below
  // zero. Between two readings the counter must move by less than a quarter of its range; after a larger move
  // the direction is uncertain, and the function returns nothing.
  std::optional<int64_t> Update(uint32_t reading);

 private:
  int64_t modulus_;
  int64_t reading_ = 0;
  int64_t count_ = 0;
  bool started_ = false;
};

// First-order low pass, y' = 2 pi corner (x - y), exact for an input that is held between its samples,
// however far apart they are. Its output starts at the first input.
class LowPass {
 public:
  // With `corner_hz` 0 the input passes unchanged.
  explicit LowPass(double corner_hz) : corner_hz_(corner_hz) {}

  // `elapsed_s` is the time since the last update. NaN passes through, and the filter starts again at the
  // next number.
  double Update(double input, double elapsed_s);

 private:
  double corner_hz_;
  std::optional<double> output_;
};

// The rate of a signal from one sample to the next: 0 at the first sample, NaN for NaN.
class Derivative {
 public:
  // `elapsed_s` is the time since the last update. When it is not above 0, the rate stays as it was.
  double Update(double input, double elapsed_s);

 private:
  std::optional<double> input_;
  double rate_ = 0;
};

}  // namespace hydro::plant
