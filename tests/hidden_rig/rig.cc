#include "rig.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>

#include "physics.h"

namespace hidden_rig {

namespace {

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
    kept_ = r * std::sin(2 * std::numbers::pi * v);
    return r * std::cos(2 * std::numbers::pi * v);
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
      return s.offset + s.amplitude * std::sin(2 * std::numbers::pi * s.hz * u);
    case Segment::Form::kSquare:
      return s.offset + (std::fmod(u * s.hz, 1.0) < 0.5 ? s.amplitude : -s.amplitude);
    case Segment::Form::kChirp: {
      const double grow = (s.hz_end - s.hz) / (s.end - s.start);
      return s.offset + s.amplitude * std::sin(2 * std::numbers::pi * (s.hz * u + 0.5 * grow * u * u));
    }
  }
  return 0;
}

// Channels as the transducers give them.
struct Reading {
  double speed, angle, p1, p2;
};

// Null for kNone.
double* Find(Reading& reading, Channel channel) {
  switch (channel) {
    case Channel::kMotorSpeed:
      return &reading.speed;
    case Channel::kArmAngle:
      return &reading.angle;
    case Channel::kP1:
      return &reading.p1;
    case Channel::kP2:
      return &reading.p2;
    case Channel::kNone:
      break;
  }
  return nullptr;
}

// The transducers, and what is wrong with them.
class Sensors {
 public:
  Sensors(const Effects& fx, const Conditions& conditions)
      : fx_(fx),
        noise_size_(conditions.noise),
        noise_(conditions.seed),
        skew_steps_(static_cast<int>(std::lround(fx.skew / kStep))) {}

  // Call once a step, before it.
  void Remember(const Reading& pure) {
    if (!(fx_.skew > 0)) return;
    Reading reading = pure;
    const double* const channel = Find(reading, fx_.skew_channel);
    late_.push_back(channel != nullptr ? *channel : reading.p2);
    if (static_cast<int>(late_.size()) > skew_steps_) late_.pop_front();
  }

  // What the loops read, and what the recorder does: it gets one channel late. `pure`: without the faults.
  void Read(const Reading& pure, Reading* loop, Reading* recorded) {
    *loop = WithErrors(pure);
    Reading late = pure;
    double* const channel = Find(late, fx_.skew_channel);
    if (fx_.skew > 0 && !late_.empty() && channel != nullptr) *channel = late_.front();
    *recorded = WithErrors(late);
    if (!(noise_size_ > 0)) return;
    const double n[4] = {noise_.Next(), noise_.Next(), noise_.Next(), noise_.Next()};
    AddNoise(n, recorded);
    AddNoise(n, loop);
  }

 private:
  Reading WithErrors(Reading reading) const {
    reading.p1 = reading.p1 * (1 + fx_.gain) + fx_.offset_p1;
    reading.p2 = reading.p2 * (1 + fx_.gain) + fx_.offset_p2;
    return reading;
  }

  void AddNoise(const double* n, Reading* r) const {
    r->speed = Quantise(r->speed + kSpeedNoise * noise_size_ * n[0], -600, 600, 12);
    r->angle = kAngleStep * std::round((r->angle + 0.2 * kAngleStep * n[1]) / kAngleStep);
    r->p1 = Quantise(r->p1 + kPressureNoise * noise_size_ * n[2], 0, 3000, 12);
    r->p2 = Quantise(r->p2 + kPressureNoise * noise_size_ * n[3], 0, 3000, 12);
  }

  const Effects& fx_;
  double noise_size_;
  Noise noise_;
  int skew_steps_;
  std::deque<double> late_;  // pure values of the late channel, one a step
};

// Eq. (16) as an experimenter would tune it for 120 rad/s, eq. (17) at 200 Hz with the paper's gains.
class Loops {
 public:
  Loops(const Plan& plan, double rate)
      : plan_(plan), samples_an_interval_(static_cast<int>(std::lround(kInterval * rate))) {}

  double Voltage(int k, double t, const Reading& read) {
    const Segment& s = SegmentAt(t);
    const double wanted = Value(s, t);
    double voltage = wanted;
    if (s.kind == Segment::Kind::kVoltage) {
      pressure_ref_ = 0;
    } else {
      if (s.kind == Segment::Kind::kPressure) {
        pressure_ref_ = wanted;
      } else if (k % samples_an_interval_ == 0) {
        const double error = read.angle - wanted;
        pressure_ref_ = -kC1 * error - (has_previous_ ? kC2 / kInterval * (read.angle - previous_angle_) : 0);
        previous_angle_ = read.angle;  // derivative on the measurement: no kick from a step of the reference
        has_previous_ = true;
      }
      pressure_ref_ = std::clamp(pressure_ref_, -kLargestPressure, kLargestPressure);
      voltage = kKp * ((pressure_ref_ - (read.p2 - read.p1)) - kKv * read.speed) + 0.0026 * pressure_ref_;
    }
    return kVoltageStep * std::round(std::clamp(voltage, -kLargestVoltage, kLargestVoltage) / kVoltageStep);
  }

  double pressure_ref() const { return pressure_ref_; }

 private:
  static constexpr double kKp = 0.08, kKv = 10.0, kC1 = 10500, kC2 = 350, kInterval = 0.005;
  static constexpr double kLargestVoltage = 11.5, kVoltageStep = 1.0 / 2048, kLargestPressure = 3000;

  const Segment& SegmentAt(double t) {
    while (segment_ + 1 < plan_.segments.size() && plan_.segments[segment_ + 1].start <= t + 1e-9) {
      ++segment_;
      has_previous_ = false;
    }
    return plan_.segments[segment_];
  }

  const Plan& plan_;
  int samples_an_interval_;
  size_t segment_ = 0;
  double pressure_ref_ = 0;
  double previous_angle_ = 0;
  bool has_previous_ = false;
};

void Append(double t, double voltage, double pressure_ref, const Reading& recorded, Record* record) {
  record->time.push_back(t);
  record->voltage.push_back(voltage);
  record->pressure_ref.push_back(pressure_ref);
  record->motor_speed.push_back(recorded.speed);
  record->arm_angle.push_back(recorded.angle);
  record->p1.push_back(recorded.p1);
  record->p2.push_back(recorded.p2);
}

}  // namespace

Record RecordRun(const RigSetup& setup, const Plan& plan, const Conditions& conditions) {
  Physics rig(setup, plan, conditions);
  Sensors sensors(setup.effects, conditions);
  Loops loops(plan, conditions.rate);
  const int steps_a_sample = static_cast<int>(std::lround(1 / (conditions.rate * kStep)));
  const int samples = static_cast<int>(std::lround(conditions.seconds * conditions.rate)) + 1;
  const auto& x = rig.state();
  const auto pure = [&x] { return Reading{x[kTachometer], x[kArm], x[kSensor1b], x[kSensor2b]}; };

  Record record;
  for (int k = 0; k < samples; ++k) {
    const double t = k / conditions.rate;
    Reading loop, recorded;
    sensors.Read(pure(), &loop, &recorded);
    const double voltage = conditions.voltage != nullptr
                               ? (*conditions.voltage)[std::min<size_t>(k, conditions.voltage->size() - 1)]
                               : loops.Voltage(k, t, loop);
    // A wrong sign is the recorder's fault: the loops are wired correctly.
    if (double* const channel = Find(recorded, setup.effects.sign_channel)) *channel = -*channel;
    Append(t, voltage, loops.pressure_ref(), recorded, &record);
    if (k + 1 == samples) break;
    for (int i = 0; i < steps_a_sample; ++i) {
      sensors.Remember(pure());
      rig.Step(voltage);
    }
  }
  return record;
}

}  // namespace hidden_rig
