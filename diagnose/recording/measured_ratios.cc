#include "diagnose/recording/measured_ratios.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "base/maths/linear_fit.h"
#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Signal = runs::MeasuredSignal;
using Columns = std::vector<std::vector<double>>;

// s: means over this time replace derivatives of noisy signals, and leave out fast motion.
constexpr double kBlock = 0.1;
constexpr size_t kFewestInABlock = 2, kFewestBlocks = 20;
// As a fraction of the largest arm speed: in slower motion, the effects of friction and of the oil's
// compression are as large.
constexpr double kMoves = 0.2;
constexpr double kOff = 0.04;     // relative: a ruler is as accurate
constexpr double kSurely = 2;     // in half widths of the 95 % interval
constexpr double kDiffer = 0.05;  // relative difference between the two directions
// As a share of the variance: a fit that leaves more says nothing.
constexpr double kLeaves = 0.2;

// Consecutive samples of a run.
struct Block {
  const Run* run;
  size_t first, last;  // both included

  double seconds() const { return run->time[last] - run->time[first]; }
};

std::vector<Block> BlocksOf(const std::vector<Run>& runs) {
  std::vector<Block> blocks;
  for (const Run& run : runs) {
    for (size_t first = 0, i = 0; i < run.samples(); ++i) {
      const bool whole = run.time[i] - run.time[first] >= kBlock * (1 - 1e-9);
      if (!whole || i - first < kFewestInABlock) continue;
      if (run.time[i] - run.time[first] < 3 * kBlock || i - first == kFewestInABlock)
        blocks.push_back({&run, first, i});
      first = i;
    }
  }
  return blocks;
}

double Mean(const Block& block, const Signal& signal) {
  if (!signal.measured()) return runs::kMissing;
  double sum = 0;
  for (size_t i = block.first; i <= block.last; ++i) sum += signal.values[i];
  return sum / static_cast<double>(block.last - block.first + 1);
}

double RateOf(const Block& block, const Signal& signal) {
  return signal.measured() ? (signal.values[block.last] - signal.values[block.first]) / block.seconds()
                           : runs::kMissing;
}

// Prefers the angle, because an angle is counted, whereas a recorded speed has passed through a filter.
double MotorSpeed(const Block& block) {
  return block.run->motor_angle.measured() ? RateOf(block, block.run->motor_angle)
                                           : Mean(block, block.run->motor_speed);
}
double ArmSpeed(const Block& block) {
  return block.run->arm_angle.measured() ? RateOf(block, block.run->arm_angle)
                                         : Mean(block, block.run->arm_speed);
}
// False where the pressures were not measured: the leakage is then unknown, and its columns are 0.
bool HasPressures(const Block& block) { return block.run->p1.measured() && block.run->p2.measured(); }
double Difference(const Block& block) {
  return HasPressures(block) ? Mean(block, block.run->p2) - Mean(block, block.run->p1) : 0;
}
double RateOfDifference(const Block& block) {
  return HasPressures(block) ? RateOf(block, block.run->p2) - RateOf(block, block.run->p1) : 0;
}

double Largest(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

// Least squares of y on some columns: coefficients, and half of their 95 % intervals.
struct Fitted {
  std::vector<double> value, half;
};

// Empty where there are too few values, or where the fit leaves too much. A column that is 0 throughout has
// the coefficient 0.
std::optional<Fitted> Fit(Columns columns, const std::vector<double>& y) {
  if (y.size() < kFewestBlocks) return std::nullopt;
  std::vector<double> scales;
  Columns used;
  for (std::vector<double>& column : columns) {
    scales.push_back(Largest(column));
    if (scales.back() == 0) continue;
    for (double& value : column) value /= scales.back();
    used.push_back(column);
  }
  Fitted fitted;
  try {
    const maths::LinearFit fit = maths::FitLinear(used, y);
    double all = 0;
    for (const double value : y) all += value * value;
    const double left = fit.residual_deviation * fit.residual_deviation * static_cast<double>(y.size());
    if (!(left < kLeaves * all)) return std::nullopt;
    size_t place = 0;
    for (const double scale : scales) {
      std::vector<double> weights(used.size(), 0.0);
      if (scale > 0) weights[place++] = 1 / scale;
      fitted.value.push_back(fit.Value(weights));
      fitted.half.push_back(scale > 0 ? fit.HalfWidth95(weights) : 0);
    }
  } catch (const std::invalid_argument&) {  // the columns depend on each other
    return std::nullopt;
  }
  return fitted;
}

// No ratio is known to more than three digits, however small the scatter is.
std::string WithInterval(double value, double half) {
  half = std::max(half, 1e-3 * std::abs(value));
  return maths::PlusMinus({value, value - half, value + half});
}

// The possible cause of a wrong ratio.
std::string Cause(double factor) {
  constexpr double kNear = 0.1;
  const double turn = 2 * std::numbers::pi;
  if (std::abs(factor * turn - 1) < kNear) return "D is per radian: is the model's per revolution?";
  if (std::abs(factor / turn - 1) < kNear)
    return "is the model's D divided by 2 pi twice, or motor_speed in rev/s?";
  return factor > 0 ? "a bore, D, or the unit or scale of a speed?"
                    : "the arm goes the other way than the motor: the sign of one of them?";
}

// motor speed = c/D arm speed, plus leakage and compression: columns of dp and of its rate.
std::optional<std::string> RatioOfSpeeds(const model::ModelDescription& model,
                                         const std::vector<Block>& blocks) {
  // If the sides are known to be unequal, one ratio says nothing.
  for (const model::EffectDescription& effect : model.effects)
    if (effect.id == "actuator.unequal_areas") return std::nullopt;
  std::vector<double> motor, out, back, leaks, fills;
  std::vector<double> speeds;
  for (const Block& block : blocks) {
    if (block.run->shaft != model::Shaft::kClamped && !block.run->bypass) speeds.push_back(ArmSpeed(block));
  }
  const double slow = kMoves * Largest(speeds);
  for (const Block& block : blocks) {
    if (block.run->shaft == model::Shaft::kClamped || block.run->bypass) continue;
    const double arm = ArmSpeed(block), pump = MotorSpeed(block), dp = Difference(block);
    const double rate = RateOfDifference(block);
    if (!(std::abs(arm) > slow) || std::isnan(pump) || std::isnan(dp) || std::isnan(rate)) continue;
    motor.push_back(pump);
    out.push_back(std::max(arm, 0.0));
    back.push_back(std::min(arm, 0.0));
    leaks.push_back(dp);
    fills.push_back(rate);
  }
  std::vector<double> both(out.size());
  for (size_t k = 0; k < both.size(); ++k) both[k] = out[k] + back[k];
  const std::optional<Fitted> one = Fit({both, leaks, fills}, motor);
  if (!one.has_value()) return std::nullopt;
  const double given = model.parameters.c / model.parameters.D;
  const double ratio = one->value[0], half = one->half[0];
  const std::optional<Fitted> two = Fit({out, back, leaks, fills}, motor);
  if (two.has_value() && Largest(out) > 0 && Largest(back) > 0) {
    const double up = two->value[0], down = two->value[1];
    const double halves = two->half[0] + two->half[1];
    if (std::abs(up - down) > std::max(kDiffer * std::abs(ratio), kSurely * halves)) {
      return "motor and arm speed give c/D = " + WithInterval(up, two->half[0]) + " upwards and " +
             WithInterval(down, two->half[1]) + " downwards, the model " + ShortNumber(given, 4) +
             ": two unequal areas, leakage or a valve?";
    }
  }
  // An interval wider than what a ruler errs by is no measurement of a bore: pressures that follow the speed
  // have taken a part of it.
  if (half > kOff * std::abs(ratio)) return std::nullopt;
  const double factor = ratio / given;
  if (std::abs(factor - 1) <= kOff + kSurely * half / std::abs(given)) return std::nullopt;
  return "motor and arm speed give c/D = " + WithInterval(ratio, half) + ", the model " +
         ShortNumber(given, 4) + " (" + ShortNumber(factor, 3) +
         " times as much is measured): " + Cause(factor);
}

// force = -share k_2 dp + friction, for each direction of the arm, and a weight; where the arm hardly
// accelerates.
std::optional<std::string> RatioOfForces(const model::ModelDescription& model,
                                         const std::vector<Block>& blocks) {
  std::vector<double> force, pressed, friction, weight, speeds;
  for (const Block& block : blocks) speeds.push_back(block.run->arm_force.measured() ? ArmSpeed(block) : 0);
  const double slow = kMoves * Largest(speeds);
  std::string unit;
  for (const Block& block : blocks) {
    if (!block.run->arm_force.measured()) continue;
    const double arm = ArmSpeed(block), dp = Difference(block), cell = Mean(block, block.run->arm_force);
    if (!(std::abs(arm) > slow) || std::isnan(dp) || std::isnan(cell)) continue;
    unit = block.run->units.UnitFor("in-lbf", -1);
    force.push_back(cell);
    pressed.push_back(-model.parameters.k_2 * dp);
    friction.push_back(arm > 0 ? 1 : -1);
    weight.push_back(1);
  }
  const std::optional<Fitted> found = Fit({pressed, friction, weight}, force);
  if (!found.has_value()) return std::nullopt;
  const double share = found->value[0];
  std::string text = "arm_force is " + WithInterval(share, found->half[0]) +
                     " times what k_2 (p2 - p1) holds against it, beside a friction of " +
                     WithInterval(found->value[1], found->half[1]) + " " + unit + " and a constant of " +
                     WithInterval(found->value[2], found->half[2]) + " " + unit;
  if (share < 0) return text + ": it pushes with the pressures, not against them: scale = -1 on its column?";
  if (std::abs(share - 1) > kOff + kSurely * found->half[0])
    text += ": k_2, a pressure's scale or the cell's is off by as much";
  return text;
}

std::optional<std::string> Winding(const std::vector<Run>& runs) {
  std::vector<double> voltage, current, speed;
  for (const Block& block : BlocksOf(runs)) {
    if (!block.run->motor_voltage.measured()) continue;
    const double u = Mean(block, block.run->motor_voltage), i = Mean(block, block.run->voltage),
                 w = MotorSpeed(block);
    if (std::isnan(u) || std::isnan(i) || std::isnan(w)) continue;
    voltage.push_back(u);
    current.push_back(i);
    speed.push_back(w);
  }
  const std::optional<Fitted> found = Fit({current, speed}, voltage);
  if (!found.has_value()) return std::nullopt;
  return "the voltage is R current + k_e motor_speed with R = " +
         WithInterval(found->value[0], found->half[0]) +
         " ohm and k_e = " + WithInterval(found->value[1], found->half[1]) +
         " V s/rad, which in N m/A is the motor's torque constant";
}

}  // namespace

std::vector<std::string> RatioRemarks(const model::ModelDescription& model, const std::vector<Run>& runs) {
  const std::vector<Block> blocks = BlocksOf(runs);
  std::vector<std::string> remarks;
  for (const std::optional<std::string>& one :
       {RatioOfSpeeds(model, blocks), RatioOfForces(model, blocks), Winding(runs)}) {
    if (one.has_value()) remarks.push_back(*one);
  }
  return remarks;
}

}  // namespace hydro::diagnose
