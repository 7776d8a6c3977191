// Columns of closures: a smooth curve over one variable, added to one element of the machine, for what no effect explains.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnose/balances/column_maker.h"

namespace hydro::diagnose {

namespace {

// Sines of a curve, and how fast their amplitudes may fall: a curve is as smooth as a Gaussian of a seventh of its range.
constexpr int kSpeedSines = 10, kOtherSines = 8;
constexpr double kSmooth = 0.15;
// An amount of the first sine, in usual parts of the balance.
constexpr double kFirst = 1.5;
constexpr double kUsual = 0.15;
// Curves reach beyond what was seen by so much.
constexpr double kBeyond = 1.15;

double SpreadOf(int sine) { return kFirst * std::exp(-0.5 * std::pow(kSmooth * std::numbers::pi * sine, 2)); }

// A curve on one element: a factor for each balance it acts in, and its variable in -1 to 1 (odd) or 0 to 1.
struct Element {
  std::string set;
  int sines = kOtherSines;
  // The balance's term where the curve is 1, and where on the curve the instant lies, in units of half a range.
  std::function<double(const model::KnownMotion&, BalanceKind)> term, at;
  std::vector<BalanceKind> balances;
  bool free_arm = false, moving = false;
};

void AddElement(ColumnMaker* maker, const Element& element) {
  std::vector<int> columns;
  for (int sine = 1; sine <= element.sines; ++sine)
    columns.push_back(
        maker->Add({element.set + ":" + std::to_string(sine), element.set, SpreadOf(sine), false}));
  maker->works.back().push_back([maker, element, columns](size_t run) {
    const RunMotion& motion = maker->Motion(run);
    if (element.free_arm && !CanForm(motion, BalanceKind::kArm)) return;
    if (element.moving && !motion.arm_moves) return;
    for (const BalanceKind balance : element.balances) {
      if (!CanForm(motion, balance)) continue;
      const Eigen::Index count = (*maker->base)[run].left[static_cast<size_t>(balance)].size();
      for (size_t s = 0; s < columns.size(); ++s) {
        Eigen::VectorXd series(count);
        for (Eigen::Index i = 0; i < count; ++i) {
          const model::KnownMotion& at = motion.at[static_cast<size_t>(i) * motion.stride];
          series[i] = element.term(at, balance) *
                      std::sin(std::numbers::pi * static_cast<double>(s + 1) * element.at(at, balance));
        }
        maker->Put(columns[s], run, balance, std::move(series));
      }
    }
  });
}

double Side(BalanceKind balance) { return balance == BalanceKind::kFlow1 ? -1 : 1; }
double OwnPressure(const model::KnownMotion& at, BalanceKind balance) {
  return balance == BalanceKind::kFlow1 ? at.p1 : at.p2;
}

void AddOilElements(ColumnMaker* maker, bool moves) {
  const BalanceSizes& sizes = maker->setup->sizes;
  const double torque = kUsual * maker->Size(BalanceKind::kTorque),
               flow = kUsual * maker->Size(BalanceKind::kFlow1);
  const double p_3 = maker->given().p_3;
  const double reach = kBeyond * std::max(sizes.pressure - p_3, 1e-3 * std::abs(sizes.pressure) + 1e-300);
  const std::vector<BalanceKind> flows = {BalanceKind::kFlow1, BalanceKind::kFlow2};
  const auto difference = [reach](const model::KnownMotion& at, BalanceKind) {
    return (at.p2 - at.p1) / reach;
  };
  AddElement(maker, {.set = "closure.pump_torque(p2 - p1)",
                     .term = [torque](const auto&, BalanceKind) { return torque; },
                     .at = difference,
                     .balances = {BalanceKind::kTorque}});
  AddElement(maker, {.set = "closure.cross_flow(p2 - p1)",
                     .term = [flow](const auto&, BalanceKind balance) { return Side(balance) * flow; },
                     .at = difference,
                     .balances = flows});
  AddElement(maker, {.set = "closure.outer_flow(p)",
                     .term = [flow](const auto&, BalanceKind) { return flow; },
                     .at =
                         [reach, p_3](const model::KnownMotion& at, BalanceKind balance) {
                           return (OwnPressure(at, balance) - p_3 + 0.1 * reach) / (1.2 * reach);
                         },
                     .balances = flows});
  if (!moves) return;
  const double dp = std::max(sizes.difference, 1e-300);
  const double middle = 0.5 * (sizes.arm_low + sizes.arm_high);
  const double half = std::max(0.6 * (sizes.arm_high - sizes.arm_low), 1e-300);
  AddElement(maker,
             {.set = "closure.cross_flow(arm_angle)",
              .term = [flow, dp](const model::KnownMotion& at,
                                 BalanceKind balance) { return Side(balance) * flow * (at.p2 - at.p1) / dp; },
              .at = [middle, half](const model::KnownMotion& at,
                                   BalanceKind) { return (at.arm_angle - middle + half) / (2 * half); },
              .balances = flows,
              .moving = true});
}

void AddArmElements(ColumnMaker* maker) {
  const BalanceSizes& sizes = maker->setup->sizes;
  const double torque = kUsual * maker->Size(BalanceKind::kArm);
  const double middle = 0.5 * (sizes.arm_low + sizes.arm_high);
  const double half = std::max(0.6 * (sizes.arm_high - sizes.arm_low), 1e-300);
  const double fast = 4 * std::max(sizes.arm_speed, 1e-300);
  const auto term = [torque](const auto&, BalanceKind) { return torque; };
  AddElement(maker,
             {.set = "closure.arm_torque(arm_angle)",
              .term = term,
              .at = [middle, half](const model::KnownMotion& at,
                                   BalanceKind) { return (at.arm_angle - middle + half) / (2 * half); },
              .balances = {BalanceKind::kArm},
              .free_arm = true});
  AddElement(maker, {.set = "closure.arm_torque(arm_speed)",
                     .term = term,
                     .at =
                         [fast](const model::KnownMotion& at, BalanceKind) {
                           return (std::clamp(at.arm_speed, -fast, fast) + fast) / (2 * fast);
                         },
                     .balances = {BalanceKind::kArm},
                     .free_arm = true});
}

}  // namespace

void AddClosureColumns(ColumnMaker* maker) {
  bool oil = false, arm = false, moves = false;
  for (const RunMotion& run : *maker->runs) {
    oil |= run.pressures;
    arm |= CanForm(run, BalanceKind::kArm);
    moves |= run.arm_moves && run.pressures;
  }
  const double torque = kUsual * maker->Size(BalanceKind::kTorque);
  const double fast = kBeyond * std::max(maker->setup->sizes.largest_speed, 1e-300);
  AddElement(maker,
             {.set = "closure.pump_torque(motor_speed)",
              .sines = kSpeedSines,
              .term = [torque](const auto&, BalanceKind) { return torque; },
              .at = [fast](const model::KnownMotion& at, BalanceKind) { return at.motor_speed / fast; },
              .balances = {BalanceKind::kTorque}});
  if (oil) AddOilElements(maker, moves);
  if (arm) AddArmElements(maker);
}

}  // namespace hydro::diagnose
