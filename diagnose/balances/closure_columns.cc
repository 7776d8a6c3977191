// Columns of closures: a smooth curve over one variable, added to one element of the machine, for what no
// effect explains.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnose/balances/closure_elements.h"
#include "diagnose/balances/column_maker.h"

namespace hydro::diagnose {
namespace {

using ElementPart = ClosureElement::Part;

// The number of sines in a curve. Their amplitudes fall so fast that a curve is as smooth as a Gaussian of a
// seventh of its range.
constexpr int kSpeedSines = 10, kOtherSines = 8;
constexpr double kSmooth = 0.15;
// The amount of the first sine, in usual parts of the balance.
constexpr double kFirst = 1.5;
// How far curves reach beyond the range that was seen.
constexpr double kBeyond = 1.15, kALittle = 0.1, kFastArm = 4;
// Turns of a motor: what it repeats in each of two turns or more is a wave.
constexpr double kTurnsOfACurve = 2;

double SpreadOf(int sine) { return kFirst * std::exp(-0.5 * std::pow(kSmooth * std::numbers::pi * sine, 2)); }

double VariableOf(const std::string& name, const model::KnownMotion& at) {
  if (name == "motor_speed") return at.motor_speed;
  if (name == "motor_angle") return at.motor_angle;
  if (name == "p1") return at.p1;
  if (name == "p2") return at.p2;
  if (name == "p2 - p1") return at.p2 - at.p1;
  return name == "arm_angle" ? at.arm_angle : at.arm_speed;
}

void AddElement(ColumnMaker* maker, const ClosureElement& element) {
  std::vector<int> columns;
  for (int sine = 1; sine <= element.sines; ++sine)
    columns.push_back(
        maker->Add({element.set + ":" + std::to_string(sine), element.set, SpreadOf(sine), false}));
  maker->works.back().push_back([maker, element, columns](size_t run) {
    const RunMotion& motion = maker->Motion(run);
    for (const ElementPart& part : element.parts) {
      if (!IsComputed(motion, part.balance)) continue;
      const bool arm = part.variable == "arm_angle" || part.variable == "arm_speed";
      if (arm && !motion.arm_moves) continue;
      const Eigen::Index count = (*maker->base)[run].left[static_cast<size_t>(part.balance)].size();
      for (size_t s = 0; s < columns.size(); ++s) {
        Eigen::VectorXd series(count);
        for (Eigen::Index i = 0; i < count; ++i) {
          const model::KnownMotion& at = motion.at[static_cast<size_t>(i) * motion.stride];
          const double value = std::clamp(VariableOf(part.variable, at), element.low, element.high);
          const double load = element.times_difference > 0 ? (at.p2 - at.p1) / element.times_difference : 1;
          series[i] = part.factor * element.unit * load *
                      std::sin(std::numbers::pi * static_cast<double>(s + 1) * element.PlaceOf(value));
        }
        maker->Put(columns[s], run, part.balance, std::move(series));
      }
    }
  });
}

double UsualOf(const BalanceSizes& sizes, BalanceKind balance) {
  return kUsualPart * sizes.of[static_cast<size_t>(balance)];
}

ClosureElement Odd(const std::string& set, int sines, double unit, double reach,
                   std::vector<ElementPart> parts) {
  return {.set = set,
          .sines = sines,
          .parts = std::move(parts),
          .unit = unit,
          .low = -reach,
          .high = reach,
          .odd = true};
}

void AddOilElements(const ColumnSetup& setup, bool moves, std::vector<ClosureElement>* elements) {
  const BalanceSizes& sizes = setup.sizes;
  const double torque = UsualOf(sizes, BalanceKind::kTorque), flow = UsualOf(sizes, BalanceKind::kFlow1);
  const double p_3 = setup.given.parameters.p_3;
  const double reach = kBeyond * std::max(sizes.pressure - p_3, 1e-3 * std::abs(sizes.pressure) + 1e-300);
  elements->push_back(Odd("closure.pump_torque(p2 - p1)", kOtherSines, torque, reach,
                          {{BalanceKind::kTorque, 1, "closure.pump_torque", "p2 - p1"}}));
  elements->push_back(Odd("closure.cross_flow(p2 - p1)", kOtherSines, flow, reach,
                          {{BalanceKind::kFlow1, -1, "closure.flow_1", "p2 - p1"},
                           {BalanceKind::kFlow2, 1, "closure.flow_2", "p2 - p1"}}));
  elements->push_back({.set = "closure.outer_flow(p)",
                       .sines = kOtherSines,
                       .parts = {{BalanceKind::kFlow1, 1, "closure.flow_1", "p1"},
                                 {BalanceKind::kFlow2, 1, "closure.flow_2", "p2"}},
                       .unit = flow,
                       .low = p_3 - kALittle * reach,
                       .high = p_3 + (1 + kALittle) * reach});
  if (!moves) return;
  const double beyond = kALittle * (sizes.arm_high - sizes.arm_low);
  elements->push_back({.set = "closure.cross_flow(arm_angle)",
                       .sines = kOtherSines,
                       .parts = {{BalanceKind::kFlow1, -1, "closure.flow_1", "arm_angle"},
                                 {BalanceKind::kFlow2, 1, "closure.flow_2", "arm_angle"}},
                       .unit = flow,
                       .low = sizes.arm_low - beyond,
                       .high = sizes.arm_high + beyond,
                       .times_difference = std::max(sizes.difference, 1e-300)});
}

void AddArmElements(const ColumnSetup& setup, std::vector<ClosureElement>* elements) {
  const BalanceSizes& sizes = setup.sizes;
  const double torque = UsualOf(sizes, BalanceKind::kArm),
               fast = kFastArm * std::max(sizes.arm_speed, 1e-300);
  const double beyond = kALittle * (sizes.arm_high - sizes.arm_low);
  elements->push_back({.set = "closure.arm_torque(arm_angle)",
                       .sines = kOtherSines,
                       .parts = {{BalanceKind::kArm, 1, "closure.arm_torque", "arm_angle"}},
                       .unit = torque,
                       .low = sizes.arm_low - beyond,
                       .high = sizes.arm_high + beyond});
  elements->push_back({.set = "closure.arm_torque(arm_speed)",
                       .sines = kOtherSines,
                       .parts = {{BalanceKind::kArm, 1, "closure.arm_torque", "arm_speed"}},
                       .unit = torque,
                       .low = -fast,
                       .high = fast});
}

// A bare motor that swings, as a robot's joint does, carries a load that may depend on its angle.
void AddShaftElement(const ColumnSetup& setup, const std::vector<RunMotion>& runs,
                     std::vector<ClosureElement>* elements) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const RunMotion& run : runs) {
    if (!run.Of(GridChannel::kAngle).measured()) return;  // it begins anywhere
    for (const model::KnownMotion& at : run.at) {
      low = std::min(low, at.motor_angle);
      high = std::max(high, at.motor_angle);
    }
  }
  const double range = high - low;
  if (!(range > 0) || range >= kTurnsOfACurve * 2 * std::numbers::pi) return;
  elements->push_back({.set = "closure.pump_torque(motor_angle)",
                       .sines = kOtherSines,
                       .parts = {{BalanceKind::kTorque, 1, "closure.pump_torque", "motor_angle"}},
                       .unit = UsualOf(setup.sizes, BalanceKind::kTorque),
                       .low = low - kALittle * range,
                       .high = high + kALittle * range});
}

}  // namespace

std::vector<ClosureElement> ClosureElements(const ColumnSetup& setup, const std::vector<RunMotion>& runs) {
  bool oil = false, arm = false, moves = false, bare = true;
  for (const RunMotion& run : runs) {
    oil |= run.pressures;
    bare &= run.options.bypass;
    arm |= CanForm(run, BalanceKind::kArm);
    moves |= run.arm_moves && run.pressures;
  }
  const double fast = kBeyond * std::max(setup.sizes.largest_speed, 1e-300);
  std::vector<ClosureElement> elements = {
      Odd("closure.pump_torque(motor_speed)", kSpeedSines, UsualOf(setup.sizes, BalanceKind::kTorque), fast,
          {{BalanceKind::kTorque, 1, "closure.pump_torque", "motor_speed"}})};
  if (bare) AddShaftElement(setup, runs, &elements);
  if (oil) AddOilElements(setup, moves, &elements);
  if (arm) AddArmElements(setup, &elements);
  return elements;
}

void AddClosureColumns(ColumnMaker* maker) {
  for (const ClosureElement& element : ClosureElements(*maker->setup, *maker->runs))
    AddElement(maker, element);
}

}  // namespace hydro::diagnose
