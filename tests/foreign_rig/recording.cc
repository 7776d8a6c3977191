#include "recording.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

namespace {

// What the loops read: the sensors without their faults of sign, or what was last known.
void Note(const Sample& sample, Reading* known) {
  double* const to[kChannels] = {&known->speed, &known->shaft, &known->arm, &known->p1, &known->p2};
  for (int i = 0; i < kChannels; ++i) {
    if (std::isfinite(sample[i])) *to[i] = sample[i];
  }
}

int InvertedChannel(Signal signal) {
  switch (signal) {
    case Signal::kMotorSpeed:
      return kSpeed;
    case Signal::kArmAngle:
      return kArmAngle;
    case Signal::kP1:
      return kSide1;
    case Signal::kP2:
      return kSide2;
    case Signal::kNone:
      break;
  }
  return -1;
}

}  // namespace

std::vector<Row> Record(const Rig& rig, const Plan& plan, const Recorder& recorder, double seconds,
                        uint64_t seed) {
  Machine machine(rig, plan.day);
  Sensing sensing(recorder, seed, seconds);
  Draw jitter(seed, "jitter");
  Loops loops(plan, rig.values, recorder.rate);
  const int steps_a_sample = static_cast<int>(std::lround(1 / (recorder.rate * kStep)));
  const int before = static_cast<int>(plan.day.prelude * recorder.rate);
  const int rows = static_cast<int>(std::lround(seconds * recorder.rate)) + 1;
  const int inverted = InvertedChannel(rig.effects.inverted);
  std::vector<Row> table;
  Reading known = machine.Read();
  sensing.Follow(known);
  Sample sample = sensing.Take(-before / recorder.rate);
  int early = 0;  // steps by which the sample was taken before its tick, at which the command changes
  for (int k = -before; k < rows; ++k) {
    const double t = k / recorder.rate;
    Note(sample, &known);
    const double volts = loops.Volts(t, known);
    if (inverted >= 0) sample[inverted] = -sample[inverted];
    if (k >= 0) table.push_back({recorder.jitter_known ? t - early * kStep : t, volts, sample});
    if (k + 1 == rows) break;
    early = static_cast<int>(
        std::lround(std::clamp(recorder.jitter * std::abs(jitter.Normal()), 0.0, 0.3) * steps_a_sample));
    for (int i = 1; i <= steps_a_sample; ++i) {
      machine.Step(volts);
      sensing.Follow(machine.Read());
      if (i == steps_a_sample - early) sample = sensing.Take(t + i * kStep);
    }
  }
  return table;
}

}  // namespace foreign_rig
