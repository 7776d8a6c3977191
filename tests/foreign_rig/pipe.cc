#include "pipe.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

namespace {

// Part of a wave that arrives late because of friction that depends on frequency, per unit of loss.
constexpr double kLatePart = 2.0;

}  // namespace

Pipe::Pipe(double delay, double impedance, double loss, double step)
    : impedance_(impedance), keep_(1 - loss) {
  const size_t steps = std::max<size_t>(1, static_cast<size_t>(std::lround(delay / step)));
  towards_a_.assign(steps, 0);
  towards_b_.assign(steps, 0);
  // The late part follows within half a pass.
  rounding_ = std::min(0.5, kLatePart * loss);
}

void Pipe::Fill(double pressure) {
  std::fill(towards_a_.begin(), towards_a_.end(), pressure);
  std::fill(towards_b_.begin(), towards_b_.end(), pressure);
  at_a_ = at_b_ = round_a_ = round_b_ = pressure;
}

double Pipe::Round(double wave, double* state) const {
  const double follow = 2.0 / static_cast<double>(towards_a_.size() + 1);
  *state += std::min(1.0, follow) * (wave - *state);
  return (1 - rounding_) * wave + rounding_ * *state;
}

void Pipe::Step(double pressure_a, double pressure_b) {
  // p + Z q of what leaves each end. The lost part of a flow's wave is taken from the flow, never from a
  // pressure at rest.
  const double flow_a = FlowA(pressure_a);
  const double flow_b = FlowB(pressure_b);
  const double sent_to_b = pressure_a + keep_ * impedance_ * flow_a;
  const double sent_to_a = pressure_b + keep_ * impedance_ * flow_b;
  at_b_ = Round(towards_b_[next_], &round_b_);
  at_a_ = Round(towards_a_[next_], &round_a_);
  towards_b_[next_] = sent_to_b;
  towards_a_[next_] = sent_to_a;
  next_ = next_ + 1 == towards_a_.size() ? 0 : next_ + 1;
}

}  // namespace foreign_rig
