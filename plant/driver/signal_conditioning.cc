#include "plant/driver/signal_conditioning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hydro::plant {

double ConverterRange::Volts(uint32_t code) const {
  return minimum_V + (maximum_V - minimum_V) * static_cast<double>(code) / static_cast<double>(max_code);
}

uint32_t ConverterRange::Code(double volts) const {
  if (std::isnan(volts)) volts = 0;
  const double share = std::clamp((volts - minimum_V) / (maximum_V - minimum_V), 0.0, 1.0);
  return static_cast<uint32_t>(std::llround(share * static_cast<double>(max_code)));
}

std::optional<int64_t> EncoderCount::Update(uint32_t reading) {
  const int64_t now = reading % modulus_;
  if (!started_) {
    started_ = true;
    reading_ = now;
    count_ = now >= (modulus_ + 1) / 2 ? now - modulus_ : now;
    return count_;
  }
  int64_t moved = now - reading_;
  if (moved >= (modulus_ + 1) / 2) moved -= modulus_;
  if (moved < -modulus_ / 2) moved += modulus_;
  reading_ = now;
  count_ += moved;
  if (std::abs(moved) >= modulus_ / 4) return std::nullopt;
  return count_;
}

double LowPass::Update(double input, double elapsed_s) {
  if (std::isnan(input)) {
    output_.reset();
    return input;
  }
  if (!output_ || corner_hz_ <= 0) {
    output_ = input;
  } else {
    const double share = -std::expm1(-2 * std::numbers::pi * corner_hz_ * std::max(elapsed_s, 0.0));
    *output_ += share * (input - *output_);
  }
  return *output_;
}

double Derivative::Update(double input, double elapsed_s) {
  if (std::isnan(input)) {
    input_.reset();
    rate_ = 0;
    return input;
  }
  if (input_ && elapsed_s > 0) rate_ = (input - *input_) / elapsed_s;
  input_ = input;
  return rate_;
}

}  // namespace hydro::plant
