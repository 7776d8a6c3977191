#include "diagnose/recording/measured_ratios.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/number_text.h"
#include "diagnose/recording/block_means.h"
#include "model/sides.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

// As a fraction of the largest arm speed: in slower motion, the effects of friction and of the oil's
// compression are as large.
constexpr double kMoves = 0.2;
constexpr double kOff = 0.04;     // relative: a ruler is as accurate
constexpr double kSurely = 2;     // in half widths of the 95 % interval
constexpr double kDiffer = 0.05;  // relative difference between the two directions

std::vector<RunBlock> BlocksOf(const std::vector<Run>& runs) {
  std::vector<RunBlock> all;
  for (const Run& run : runs) {
    const std::vector<RunBlock> blocks = RunBlocksOf(run);
    all.insert(all.end(), blocks.begin(), blocks.end());
  }
  return all;
}

// Prefers the angle, because an angle is counted, whereas a recorded speed has passed through a filter.
double MotorSpeed(const RunBlock& block) {
  return block.run->motor_angle.measured() ? block.Rate(block.run->motor_angle)
                                           : block.Mean(block.run->motor_speed);
}
double ArmSpeed(const RunBlock& block) {
  return block.run->arm_angle.measured() ? block.Rate(block.run->arm_angle)
                                         : block.Mean(block.run->arm_speed);
}
// False where the pressures were not measured: the leakage is then unknown, and its columns are 0.
bool HasPressures(const RunBlock& block) { return block.run->p1.measured() && block.run->p2.measured(); }
double Difference(const RunBlock& block) {
  return HasPressures(block) ? block.Mean(block.run->p2) - block.Mean(block.run->p1) : 0;
}
double RateOfDifference(const RunBlock& block) {
  return HasPressures(block) ? block.Rate(block.run->p2) - block.Rate(block.run->p1) : 0;
}

double Largest(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

// The possible cause of a wrong ratio.
std::string Cause(double factor) {
  constexpr double kNear = 0.1;
  const double turn = 2 * std::numbers::pi;
  if (std::abs(factor / turn - 1) < kNear) return "D is per radian: is the model's per revolution?";
  if (std::abs(factor * turn - 1) < kNear)
    return "is the model's D divided by 2 pi twice, or motor_speed in rev/s?";
  return factor > 0 ? "a bore, D, or the unit or scale of a speed?"
                    : "the arm goes the other way than the motor: the sign of one of them?";
}

// motor speed = c/D arm speed, plus leakage and compression: columns of dp and of its rate.
std::optional<std::string> RatioOfSpeeds(const model::ModelDescription& model,
                                         const std::vector<RunBlock>& blocks) {
  // If the sides are known to be unequal, one ratio says nothing.
  for (const model::EffectDescription& effect : model.effects)
    if (effect.id == "actuator.unequal_areas") return std::nullopt;
  std::vector<double> motor, out, back, leaks, fills;
  std::vector<double> speeds;
  for (const RunBlock& block : blocks) {
    if (block.run->shaft != model::Shaft::kClamped && !block.run->bypass) speeds.push_back(ArmSpeed(block));
  }
  const double slow = kMoves * Largest(speeds);
  for (const RunBlock& block : blocks) {
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
  const std::optional<FittedBlocks> one = FitBlocks({both, leaks, fills}, motor);
  if (!one.has_value()) return std::nullopt;
  const double given = model.parameters.c / model.parameters.D;
  const double ratio = one->value[0], half = one->half[0];
  const std::optional<FittedBlocks> two = FitBlocks({out, back, leaks, fills}, motor);
  if (two.has_value() && Largest(out) > 0 && Largest(back) > 0) {
    const double up = two->value[0], down = two->value[1];
    const double halves = two->half[0] + two->half[1];
    if (std::abs(up - down) > std::max(kDiffer * std::abs(ratio), kSurely * halves)) {
      return "motor and arm speed give c/D = " + WithHalfWidth(up, two->half[0]) + " upwards and " +
             WithHalfWidth(down, two->half[1]) + " downwards, the model " + ShortNumber(given, 4) +
             ": two unequal areas, leakage or a valve?";
    }
  }
  // An interval wider than what a ruler errs by is no measurement of a bore: pressures that follow the speed
  // have taken a part of it.
  if (half > kOff * std::abs(ratio)) return std::nullopt;
  const double factor = ratio / given;
  if (std::abs(factor - 1) <= kOff + kSurely * half / std::abs(given)) return std::nullopt;
  return "motor and arm speed give c/D = " + WithHalfWidth(ratio, half) + ", the model " +
         ShortNumber(given, 4) + " (" + ShortNumber(factor, 3) +
         " times as much is measured): " + Cause(factor);
}

// force = -share k_2 dp + friction, for each direction of the arm, and a weight; where the arm hardly
// accelerates.
std::optional<std::string> RatioOfForces(const model::ModelDescription& model,
                                         const std::vector<RunBlock>& blocks) {
  std::vector<double> force, pressed, friction, weight, speeds;
  for (const RunBlock& block : blocks)
    speeds.push_back(block.run->arm_force.measured() ? ArmSpeed(block) : 0);
  const double slow = kMoves * Largest(speeds);
  const double areas = model::DifferencesOf(model).areas;
  std::string unit;
  for (const RunBlock& block : blocks) {
    if (!block.run->arm_force.measured()) continue;
    const double arm = ArmSpeed(block), cell = block.Mean(block.run->arm_force);
    const double load = HasPressures(block)
                            ? model::LoadPressure(areas, block.Mean(block.run->p1), block.Mean(block.run->p2))
                            : 0;
    if (!(std::abs(arm) > slow) || std::isnan(load) || std::isnan(cell)) continue;
    unit = block.run->units.UnitFor("in-lbf", -1);
    force.push_back(cell);
    pressed.push_back(-model.parameters.k_2 * load);
    friction.push_back(arm > 0 ? 1 : -1);
    weight.push_back(1);
  }
  const std::optional<FittedBlocks> found = FitBlocks({pressed, friction, weight}, force);
  if (!found.has_value()) return std::nullopt;
  const double share = found->value[0];
  std::string text = "arm_force is " + WithHalfWidth(share, found->half[0]) + " times what " +
                     (areas == 0 ? "k_2 (p2 - p1)" : "k_2 (c_2 p2 - c_1 p1)/c") +
                     " holds against it, beside a friction of " +
                     WithHalfWidth(found->value[1], found->half[1]) + " " + unit + " and a constant of " +
                     WithHalfWidth(found->value[2], found->half[2]) + " " + unit;
  if (share < 0) return text + ": it pushes with the pressures, not against them: scale = -1 on its column?";
  if (std::abs(share - 1) > kOff + kSurely * found->half[0])
    text += ": k_2, a pressure's scale or the cell's is off by as much";
  return text;
}

std::optional<std::string> Winding(const std::vector<Run>& runs) {
  std::vector<double> voltage, current, speed;
  for (const RunBlock& block : BlocksOf(runs)) {
    if (!block.run->motor_voltage.measured()) continue;
    const double u = block.Mean(block.run->motor_voltage), i = block.Mean(block.run->voltage),
                 w = MotorSpeed(block);
    if (std::isnan(u) || std::isnan(i) || std::isnan(w)) continue;
    voltage.push_back(u);
    current.push_back(i);
    speed.push_back(w);
  }
  const std::optional<FittedBlocks> found = FitBlocks({current, speed}, voltage);
  if (!found.has_value()) return std::nullopt;
  return "the voltage is R current + k_e motor_speed with R = " +
         WithHalfWidth(found->value[0], found->half[0]) +
         " ohm and k_e = " + WithHalfWidth(found->value[1], found->half[1]) +
         " V s/rad, which in N m/A is the motor's torque constant";
}

}  // namespace

std::vector<std::string> RatioRemarks(const model::ModelDescription& model, const std::vector<Run>& runs) {
  const std::vector<RunBlock> blocks = BlocksOf(runs);
  std::vector<std::string> remarks;
  for (const std::optional<std::string>& one :
       {RatioOfSpeeds(model, blocks), RatioOfForces(model, blocks), Winding(runs)}) {
    if (one.has_value()) remarks.push_back(*one);
  }
  return remarks;
}

}  // namespace hydro::diagnose
