#include "tune/design/linear_stack.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/maths/matrix_functions.h"
#include "model/terms/state.h"
#include "tune/design/held_input.h"

namespace hydro::design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;

constexpr int kMostDelayTicks = 60;
constexpr int64_t kMostSamples = 500;

// Rows of LinearModel's outputs.
enum Output : uint8_t { kSpeedRow = 1, kAngleRow = 2, kArmRateRow = 3, kFirstRow = 4, kSecondRow = 5 };

// A delay as whole ticks and a remainder above 0 and up to one tick, so that a late value always belongs to
// an earlier tick.
struct Delay {
  int ticks = 0;
  double rest = 0;  // s
};

Delay SplitDelay(double seconds, double tick, const char* what) {
  const double ticks = std::ceil(seconds / tick * (1 - 1e-12)) - 1;
  if (ticks > kMostDelayTicks) {
    throw std::domain_error(fmt::format("{} of {} s is more than {} ticks", what, seconds, kMostDelayTicks));
  }
  return {static_cast<int>(ticks), seconds - ticks * tick};
}

MatrixXd Power(MatrixXd base, int64_t exponent) {
  MatrixXd power = MatrixXd::Identity(base.rows(), base.rows());
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) power = base * power;
    base = base * base;
  }
  return power;
}

}  // namespace

// One tick is written as rows: each state at its end in terms of the states at its start. The states are
// those of the actuator, followed by the voltages that acted in earlier ticks, the voltage and the pressure
// reference computed last, the angle at the last sample, and late readings.
struct LinearStack::Parts {
  MatrixXd C;
  HeldInput before, after;  // with the voltages that act before and after the end of the amplifier's delay
  HeldInput read_before,
      read_after;            // the same, up to the time within a tick that late channels read
  bool reads_after = false;  // that time is after the change of the voltage
  int amplifier_ticks = -1;  // -1: no delay
  int late_ticks = -1;       // -1: no channel is late
  std::vector<Index> late;   // outputs
  StackTiming timing;
  pressure_ctrl::PressureLawSettings pressure;
  std::optional<position_ctrl::PositionLawSettings> position;
  int64_t period = 1;  // ticks

  Index plant() const { return C.cols(); }
  Index voltages() const { return amplifier_ticks + 1; }
  Index pending() const { return plant() + voltages(); }
  Index reference() const { return pending() + 1; }
  Index previous() const { return pending() + 2; }
  Index readings() const { return pending() + (position ? 3 : 1); }
  Index size() const { return readings() + (late_ticks + 1) * static_cast<Index>(late.size()); }

  MatrixXd Tick(bool pressure_samples, bool position_samples, double voltage, double reference_share) const;
  MatrixXd Advanced(const MatrixXd& x, const RowVectorXd& old_voltage, const RowVectorXd& new_voltage,
                    bool to_reading) const;
  MatrixXd TickByTick(double voltage, double reference_share) const;
  RowVectorXd Voltage(const MatrixXd& y, const RowVectorXd& reference_row, double share) const;
  RowVectorXd Reference(const RowVectorXd& angle, double share) const;
};

RowVectorXd LinearStack::Parts::Voltage(const MatrixXd& y, const RowVectorXd& reference_row,
                                        double share) const {
  const RowVectorXd speed = y.row(kSpeedRow) - pressure.arm_speed_ratio * y.row(kArmRateRow);
  const double areas = pressure.sides.areas;
  const RowVectorXd load_pressure = (1 + areas) * y.row(kSecondRow) - (1 - areas) * y.row(kFirstRow);
  const RowVectorXd fed_back = -pressure.gains.k_p * (load_pressure + pressure.gains.k_v * speed);
  // The reference passes through the same amplifier, so a factor on the voltage multiplies all of eq. (16).
  return share * (fed_back + (pressure.gains.k_p + pressure.reference_feedforward) * reference_row);
}

RowVectorXd LinearStack::Parts::Reference(const RowVectorXd& angle, double share) const {
  const RowVectorXd last = RowVectorXd::Unit(size(), previous());
  return -share * (position->c1 * angle + position->c2 / position->sample_interval * (angle - last));
}

MatrixXd LinearStack::Parts::Advanced(const MatrixXd& x, const RowVectorXd& old_voltage,
                                      const RowVectorXd& new_voltage, bool to_reading) const {
  const HeldInput& first = to_reading ? read_before : before;
  const HeldInput& second = to_reading ? read_after : after;
  MatrixXd result = first.states * x;
  result += first.input * old_voltage;
  if (to_reading && !reads_after) return result;
  result = second.states * result;
  result += second.input * new_voltage;
  return result;
}

MatrixXd LinearStack::Parts::Tick(bool pressure_samples, bool position_samples, double voltage,
                                  double reference_share) const {
  const MatrixXd now = MatrixXd::Identity(size(), size());
  MatrixXd next = now;
  const MatrixXd x = now.topRows(plant());
  MatrixXd y = C * x;
  const auto channels = static_cast<Index>(late.size());
  for (Index i = 0; i < channels; ++i) y.row(late[i]) = now.row(readings() + late_ticks * channels + i);

  // A reference acts on the first sample of the pressure loop after the delay, as the loop's voltage acts on
  // the motor.
  const bool at_once = timing.command_delay == 0;
  RowVectorXd reference_row = RowVectorXd::Zero(size());
  if (position) {
    RowVectorXd reference_now = now.row(reference());
    reference_row = reference_now;
    if (position_samples) {
      reference_now = Reference(y.row(kAngleRow), reference_share);
      next.row(reference()) = reference_now;
      next.row(previous()) = y.row(kAngleRow);
    }
    if (at_once) reference_row = reference_now;
  }
  if (pressure_samples) next.row(pending()) = Voltage(y, reference_row, voltage);
  const RowVectorXd acting = (at_once ? next : now).row(pending());

  RowVectorXd earlier = acting;
  RowVectorXd later = acting;
  if (amplifier_ticks >= 0) {
    earlier = now.row(plant() + amplifier_ticks);
    later = amplifier_ticks == 0 ? acting : RowVectorXd(now.row(plant() + amplifier_ticks - 1));
    for (Index i = amplifier_ticks; i > 0; --i) next.row(plant() + i) = now.row(plant() + i - 1);
    next.row(plant()) = acting;
  }
  next.topRows(plant()) = Advanced(x, earlier, later, false);
  if (late_ticks >= 0) {
    const MatrixXd then = C * Advanced(x, earlier, later, true);
    for (Index i = (late_ticks + 1) * channels - 1; i >= channels; --i) {
      next.row(readings() + i) = now.row(readings() + i - channels);
    }
    for (Index i = 0; i < channels; ++i) next.row(readings() + i) = then.row(late[i]);
  }
  return next;
}

LinearStack::LinearStack(const model::LinearModel& model, const StackTiming& timing,
                         const pressure_ctrl::PressureLawSettings& pressure,
                         const position_ctrl::PositionLawSettings* position) {
  auto parts = std::make_unique<Parts>();
  parts->timing = timing;
  parts->pressure = pressure;
  if (position != nullptr) parts->position = *position;
  parts->period = timing.pressure_interval;
  if (position != nullptr) {
    const int64_t common = std::gcd(timing.pressure_interval, timing.position_interval);
    const int64_t factor = timing.position_interval / common;
    if (factor > kMostSamples || timing.pressure_interval / common > kMostSamples) {
      throw std::domain_error(fmt::format(
          "the pattern of the samples of both loops, every {} and every {} ticks, repeats too seldom",
          timing.pressure_interval, timing.position_interval));
    }
    parts->period = timing.pressure_interval * factor;
  }

  const MatrixXd A = Eigen::Map<const MatrixXd>(model.A.data(), model.states, model.states);
  const MatrixXd B = Eigen::Map<const MatrixXd>(model.B.data(), model.states, 1);
  MatrixXd C = Eigen::Map<const MatrixXd>(model.C.data(), model.outputs, model.states);
  C.row(0).setZero();
  if (position == nullptr) C.row(kAngleRow).setZero();
  if (pressure.arm_speed_ratio == 0) C.row(kArmRateRow).setZero();
  const std::vector<Index> kept = StatesThatMatter(A, B, C);
  const MatrixXd a = A(kept, kept);
  const MatrixXd b = B(kept, 0);
  parts->C = C(Eigen::all, kept);

  Delay amplifier;
  if (timing.amplifier_delay > 0) {
    amplifier = SplitDelay(timing.amplifier_delay, timing.tick, "amp.delay");
    parts->amplifier_ticks = amplifier.ticks;
  }
  parts->before = TransitionOver(a, b, amplifier.rest);
  parts->after = TransitionOver(a, b, timing.tick - amplifier.rest);
  if (timing.late > 0) {
    const Delay reading = SplitDelay(timing.late, timing.tick, "sensor.skew");
    parts->late_ticks = reading.ticks;
    for (Index i = 0; i < static_cast<Index>(timing.late_outputs.size()); ++i) {
      if (timing.late_outputs[static_cast<size_t>(i)]) parts->late.push_back(i);
    }
    const double at = timing.tick - reading.rest;
    parts->reads_after = at > amplifier.rest;
    parts->read_before = TransitionOver(a, b, std::min(at, amplifier.rest));
    parts->read_after = TransitionOver(a, b, std::max(0.0, at - amplifier.rest));
  }
  parts_ = std::move(parts);
}

LinearStack::~LinearStack() = default;

double LinearStack::period() const { return static_cast<double>(parts_->period) * parts_->timing.tick; }

bool LinearStack::pressure_sampled_once() const { return parts_->period == parts_->timing.pressure_interval; }

// A reference that is replaced before the pressure loop samples it has no effect.
bool LinearStack::position_sampled_once() const {
  return parts_->period == parts_->timing.position_interval || pressure_sampled_once();
}

// The loop over one period, tick by tick, for intervals that are not multiples of each other.
MatrixXd LinearStack::Parts::TickByTick(double voltage, double reference_share) const {
  std::map<int64_t, MatrixXd> idle;  // transition over this many ticks without a sample
  MatrixXd loop = MatrixXd::Identity(size(), size());
  for (int64_t tick = 0; tick < period;) {
    loop = Tick(tick % timing.pressure_interval == 0, tick % timing.position_interval == 0, voltage,
                reference_share) *
           loop;
    ++tick;
    const auto wait = [&](int64_t interval) { return (interval - tick % interval) % interval; };
    const int64_t left = std::min(wait(timing.pressure_interval), wait(timing.position_interval));
    if (left == 0) continue;
    auto found = idle.find(left);
    if (found == idle.end()) {
      found = idle.emplace(left, Power(Tick(false, false, voltage, reference_share), left)).first;
    }
    loop = found->second * loop;
    tick += left;
  }
  return loop;
}

std::vector<std::complex<double>> LinearStack::Poles(double voltage, double reference) const {
  const Parts& parts = *parts_;
  const int64_t each = parts.timing.pressure_interval;
  MatrixXd loop;
  if (parts.period % each == 0 && (!parts.position || parts.period == parts.timing.position_interval)) {
    MatrixXd idle = MatrixXd::Identity(parts.size(), parts.size());
    if (each > 1) idle = Power(parts.Tick(false, false, voltage, reference), each - 1);
    loop = idle * parts.Tick(true, parts.position.has_value(), voltage, reference);
    if (parts.period > each) {
      loop = Power(idle * parts.Tick(true, false, voltage, reference), parts.period / each - 1) * loop;
    }
  } else {
    loop = parts.TickByTick(voltage, reference);
  }
  if (!loop.allFinite()) {  // it grows beyond all numbers within one period
    return std::vector<std::complex<double>>(static_cast<size_t>(parts.size()),
                                             std::numeric_limits<double>::infinity());
  }
  const Eigen::VectorXcd values = maths::Eigenvalues(loop);
  return {values.begin(), values.end()};
}

void FreezeArmAngle(int actuator_angle, model::LinearModel* model) {
  if (actuator_angle < 0) return;
  const Index n = model->states;
  const Index arm = model::kArmAngle;
  const auto own = static_cast<Index>(actuator_angle);
  Eigen::Map<MatrixXd> A(model->A.data(), n, n);
  Eigen::Map<MatrixXd> C(model->C.data(), model->outputs, n);
  if (own != arm) {
    // From here on the actuator's angle counts from the arm's, so a common motion of both changes nothing.
    A.row(own) -= A.row(arm);
  }
  A.col(arm).setZero();
  C.col(arm).setZero();
}

}  // namespace hydro::design
