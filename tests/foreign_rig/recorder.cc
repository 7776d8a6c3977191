#include "recorder.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

namespace {

Channel DrawChannel(Draw& draw, double noise, double step) {
  Channel c;
  c.noise = noise;
  c.coloured = draw.Chance(0.6) ? draw.Between(0.05, 0.4) : 0;
  c.colour_time = draw.LogBetween(0.002, 0.02);
  c.hum = draw.Chance(0.3) ? noise * draw.Between(0.1, 0.4) : 0;
  c.wander = draw.Chance(0.3) ? noise * draw.Between(0.1, 0.4) : 0;
  c.step = step;
  c.filter = draw.Chance(0.5) ? draw.LogBetween(5e-5, 3e-4) : 0;
  return c;
}

}  // namespace

Recorder DrawRecorder(uint64_t seed, double slowest) {
  Draw draw(seed, "recorder");
  Recorder r;
  constexpr double kRates[] = {200, 500, 1000, 1000, 2000, 2000};
  do {
    r.rate = kRates[draw.Index(6)];
  } while (r.rate < slowest);
  r.channels[kSpeed] = DrawChannel(draw, draw.LogBetween(0.15, 0.8), draw.LogBetween(0.05, 0.5));
  r.channels[kShaft] = DrawChannel(draw, 0, kTurn / (4 * 1024));
  const double encoder = kTurn / std::ldexp(1.0, 13 + draw.Index(4));
  r.channels[kArmAngle] = DrawChannel(draw, 0.3 * encoder, encoder);
  const double pressure = draw.LogBetween(0.7, 3);
  const double range = draw.Chance(0.5) ? 3000 : 5000;
  const double step = range / std::ldexp(1.0, 12 + 2 * draw.Index(2));
  for (const int i : {kSide1, kSide2}) r.channels[i] = DrawChannel(draw, pressure, step);
  r.channels[kSide2].filter = r.channels[kSide1].filter;  // two transducers of one make
  // A mean is late by half an interval: where intervals are long that would be an effect of its own.
  r.averages = draw.Chance(0.3) && r.rate >= 1000;
  r.jitter = draw.Chance(0.4) ? draw.Between(0.01, 0.08) : 0;
  r.jitter_known = draw.Chance(0.5);
  r.spikes = draw.Chance(0.2) ? 0.1 : 0;
  r.dropouts = draw.Chance(0.2) ? 0.2 : 0;
  r.dropout = draw.Chance(0.5) ? Recorder::Dropout::kMissing : Recorder::Dropout::kHeld;
  r.motor_angle = draw.Chance(0.25);
  return r;
}

double NoiseUnit(const Channel& c) {
  return std::sqrt(c.noise * c.noise + c.step * c.step / 12 + 0.5 * c.hum * c.hum);
}

Sensing::Sensing(const Recorder& recorder, uint64_t seed, double seconds)
    : recorder_(recorder), draw_(seed, "noise"), hum_phase_(draw_.Between(0, kTurn)) {
  for (int i = 0; i < kChannels; ++i) {
    colour_[i] = draw_.Normal();
    slope_[i] = draw_.Normal() * recorder.channels[i].wander / seconds;
  }
}

void Sensing::Follow(const Reading& reading) {
  const Sample now = {reading.speed, reading.shaft, reading.arm, reading.p1, reading.p2};
  for (int i = 0; i < kChannels; ++i) {
    const double time = recorder_.channels[i].filter;
    if (!started_ || time == 0) {
      filtered_[i] = now[i];
    } else {
      filtered_[i] += (now[i] - filtered_[i]) * kStep / (time + kStep);
    }
    sum_[i] += filtered_[i];
  }
  started_ = true;
  ++count_;
}

Sample Sensing::Take(double t) {
  Sample sample;
  for (int i = 0; i < kChannels; ++i) {
    const Channel& c = recorder_.channels[i];
    double value = recorder_.averages && count_ > 0 ? sum_[i] / count_ : filtered_[i];
    const double keep = std::exp(-1 / (recorder_.rate * c.colour_time));
    colour_[i] = keep * colour_[i] + std::sqrt(1 - keep * keep) * draw_.Normal();
    value += c.noise * (std::sqrt(1 - c.coloured) * draw_.Normal() + std::sqrt(c.coloured) * colour_[i]);
    value += c.hum * std::sin(kTurn * 50 * t + hum_phase_ + i) + slope_[i] * std::max(0.0, t);
    if (draw_.Chance(recorder_.spikes / recorder_.rate))
      value += draw_.Sign() * c.noise * draw_.LogBetween(15, 300);
    sample[i] = c.step > 0 ? c.step * std::round(value / c.step) : value;
    sum_[i] = 0;
  }
  count_ = 0;
  if (t >= 0.1 && draw_.Chance(recorder_.dropouts / recorder_.rate)) lost_ = 2 + draw_.Index(8);
  if (lost_ > 0) {
    --lost_;
    if (recorder_.dropout == Recorder::Dropout::kHeld) return held_;
    sample.fill(std::numeric_limits<double>::quiet_NaN());
    return sample;
  }
  held_ = sample;
  return sample;
}

}  // namespace foreign_rig
