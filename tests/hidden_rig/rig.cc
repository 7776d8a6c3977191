#include "rig.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "physics.h"

namespace hidden_rig {

namespace {

constexpr double kPi = 3.14159265358979323846;

// Normal deviates that are the same with every standard library.
class Noise {
 public:
  explicit Noise(uint64_t seed) : engine_(seed) {}
  double Next() {
    if (spare_) {
      spare_ = false;
      return kept_;
    }
    const double u = (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53;
    const double v = (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53;
    const double r = std::sqrt(-2 * std::log(u));
    spare_ = true;
    kept_ = r * std::sin(2 * kPi * v);
    return r * std::cos(2 * kPi * v);
  }

 private:
  std::mt19937_64 engine_;
  bool spare_ = false;
  double kept_ = 0;
};

double Quantise(double value, double low, double high, int bits) {
  const double step = (high - low) / std::ldexp(1.0, bits);
  const double level = std::clamp(std::round((value - low) / step), 0.0, std::ldexp(1.0, bits) - 1);
  return low + level * step;
}

double Value(const Segment& s, double t) {
  const double u = t - s.start;
  switch (s.form) {
    case Segment::Form::kHold:
      return s.offset;
    case Segment::Form::kRamp:
      return s.offset + s.amplitude * u / (s.end - s.start);
    case Segment::Form::kSine:
      return s.offset + s.amplitude * std::sin(2 * kPi * s.hz * u);
    case Segment::Form::kSquare:
      return s.offset + (std::fmod(u * s.hz, 1.0) < 0.5 ? s.amplitude : -s.amplitude);
    case Segment::Form::kChirp: {
      const double grow = (s.hz_end - s.hz) / (s.end - s.start);
      return s.offset + s.amplitude * std::sin(2 * kPi * (s.hz * u + 0.5 * grow * u * u));
    }
  }
  return 0;
}

}  // namespace

Record RecordRun(const RigSetup& setup, const Plan& plan, const Conditions& conditions) {
  // Eq. (16) as an experimenter would tune it for 120 rad/s, eq. (17) at 200 Hz with the paper's gains.
  constexpr double k_p = 0.08, k_v = 10.0, c1 = 10500, c2 = 350, interval = 0.005;
  constexpr double kLargestVoltage = 11.5, kVoltageStep = 1.0 / 2048, kLargestPressure = 3000;

  Physics rig(setup, plan, conditions);
  Noise noise(conditions.seed);
  const bool real = conditions.noise > 0;
  const Effects& fx = setup.effects;
  const int steps_a_sample = static_cast<int>(std::lround(1 / (conditions.rate * kStep)));
  const int samples = static_cast<int>(std::lround(conditions.seconds * conditions.rate)) + 1;
  const int samples_an_interval = static_cast<int>(std::lround(interval * conditions.rate));
  const int skew_steps = static_cast<int>(std::lround(fx.skew / kStep));
  std::deque<double> late;  // true values of the late channel, one a step

  Record record;
  double pressure_ref = 0;
  double previous_error = 0;
  bool has_previous = false;
  size_t segment = 0;
  for (int k = 0; k < samples; ++k) {
    const double t = k / conditions.rate;
    const auto& x = rig.state();
    // Channels as the transducers give them.
    struct Reading {
      double speed, angle, p1, p2;
    } true_now{x[kTachometer], x[kArm], x[kSensor1b] * (1 + fx.gain) + fx.offset_p1,
               x[kSensor2b] * (1 + fx.gain) + fx.offset_p2};
    Reading loop = true_now;
    if (fx.skew > 0 && !late.empty()) {
      const double old = late.front();
      switch (fx.skew_channel) {
        case Channel::kMotorSpeed:
          true_now.speed = old;
          break;
        case Channel::kArmAngle:
          true_now.angle = old;
          break;
        case Channel::kP1:
          true_now.p1 = old * (1 + fx.gain) + fx.offset_p1;
          break;
        case Channel::kP2:
          true_now.p2 = old * (1 + fx.gain) + fx.offset_p2;
          break;
        case Channel::kNone:
          break;
      }
    }
    if (real) {
      const double n[4] = {noise.Next(), noise.Next(), noise.Next(), noise.Next()};
      const auto read = [&](Reading& r) {
        r.speed = Quantise(r.speed + kSpeedNoise * conditions.noise * n[0], -600, 600, 12);
        r.angle = kAngleStep * std::round((r.angle + 0.2 * kAngleStep * n[1]) / kAngleStep);
        r.p1 = Quantise(r.p1 + kPressureNoise * conditions.noise * n[2], 0, 3000, 12);
        r.p2 = Quantise(r.p2 + kPressureNoise * conditions.noise * n[3], 0, 3000, 12);
      };
      read(true_now);
      read(loop);
    }

    double voltage = 0;
    if (conditions.voltage != nullptr) {
      voltage = (*conditions.voltage)[std::min<size_t>(k, conditions.voltage->size() - 1)];
    } else {
      while (segment + 1 < plan.segments.size() && plan.segments[segment + 1].start <= t + 1e-9) {
        ++segment;
        has_previous = false;
      }
      const Segment& s = plan.segments[segment];
      const double wanted = Value(s, t);
      if (s.kind == Segment::Kind::kVoltage) {
        voltage = wanted;
        pressure_ref = 0;
      } else {
        if (s.kind == Segment::Kind::kPressure) {
          pressure_ref = wanted;
        } else if (k % samples_an_interval == 0) {
          const double error = loop.angle - wanted;
          pressure_ref = -c1 * error - (has_previous ? c2 / interval * (loop.angle - previous_error) : 0);
          previous_error = loop.angle;  // derivative on the measurement: no kick from a step of the reference
          has_previous = true;
        }
        pressure_ref = std::clamp(pressure_ref, -kLargestPressure, kLargestPressure);
        voltage = k_p * ((pressure_ref - (loop.p2 - loop.p1)) - k_v * loop.speed) + 0.0026 * pressure_ref;
      }
      voltage =
          kVoltageStep * std::round(std::clamp(voltage, -kLargestVoltage, kLargestVoltage) / kVoltageStep);
    }

    // A wrong sign is the recorder's fault: the loops are wired correctly.
    switch (fx.sign_channel) {
      case Channel::kMotorSpeed:
        true_now.speed = -true_now.speed;
        break;
      case Channel::kArmAngle:
        true_now.angle = -true_now.angle;
        break;
      case Channel::kP1:
        true_now.p1 = -true_now.p1;
        break;
      case Channel::kP2:
        true_now.p2 = -true_now.p2;
        break;
      case Channel::kNone:
        break;
    }
    record.time.push_back(t);
    record.voltage.push_back(voltage);
    record.pressure_ref.push_back(pressure_ref);
    record.motor_speed.push_back(true_now.speed);
    record.arm_angle.push_back(true_now.angle);
    record.p1.push_back(true_now.p1);
    record.p2.push_back(true_now.p2);

    if (k + 1 == samples) break;
    for (int i = 0; i < steps_a_sample; ++i) {
      if (fx.skew > 0) {
        const double value = fx.skew_channel == Channel::kMotorSpeed ? x[kTachometer]
                             : fx.skew_channel == Channel::kArmAngle ? x[kArm]
                             : fx.skew_channel == Channel::kP1       ? x[kSensor1b]
                                                                     : x[kSensor2b];
        late.push_back(value);
        if (static_cast<int>(late.size()) > skew_steps) late.pop_front();
      }
      rig.Step(voltage);
    }
  }
  return record;
}

}  // namespace hidden_rig
