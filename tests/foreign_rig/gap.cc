#include "gap.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "loops.h"

namespace foreign_rig {

namespace {

constexpr double kRate = 500;  // Hz, of comparison
const int kStepsATick = static_cast<int>(std::lround(1 / (kRate * kStep)));
constexpr int kEvery = 2;  // of this many windows one is compared
constexpr double kInfinite = std::numeric_limits<double>::infinity();

double RootMeanSquare(const std::vector<double>& all) {
  double sum = 0;
  for (const double value : all) sum += value * value;
  return std::sqrt(sum / static_cast<double>(all.size()));
}

void TakeOff(const std::vector<double>& direction, std::vector<double>* from) {
  double along = 0;
  for (size_t i = 0; i < from->size(); ++i) along += direction[i] * (*from)[i];
  for (size_t i = 0; i < from->size(); ++i) (*from)[i] -= along * direction[i];
}

}  // namespace

GapMeter::GapMeter(std::vector<Plan> plans, const std::array<double, kChannels>& noise, double seconds)
    : plans_(std::move(plans)), noise_(noise), seconds_(seconds) {}

void GapMeter::Append(const Reading& a, const Reading& b, const Plan& plan, std::vector<double>* to) const {
  to->push_back((a.speed - b.speed) / noise_[kSpeed]);
  to->push_back((a.p1 - b.p1) / noise_[kSide1]);
  to->push_back((a.p2 - b.p2) / noise_[kSide2]);
  if (!plan.day.clamped) to->push_back((a.arm - b.arm) / noise_[kArmAngle]);
}

// The rig with everything runs through the plan with its loops; the others follow its commands from its
// states.
std::vector<std::vector<double>> GapMeter::AllDifferences(const Rig& with,
                                                          const std::vector<Rig>& others) const {
  std::vector<std::vector<double>> all(others.size());
  const int ticks_a_window = static_cast<int>(std::lround(kWindow * kRate));
  for (const Plan& plan : plans_) {
    Machine whole(with, plan.day);
    std::vector<Machine> lacking;
    for (const Rig& other : others) lacking.emplace_back(other, plan.day);
    Loops loops(plan, with.values, kRate);
    const int ticks = static_cast<int>(seconds_ * kRate);
    for (int k = -static_cast<int>(plan.day.prelude * kRate); k < ticks; ++k) {
      const bool compares = k >= 0 && k / ticks_a_window % kEvery == 0;
      if (compares && k % ticks_a_window == 0) {
        for (Machine& machine : lacking) machine.ContinueFrom(whole);
      }
      const double volts = loops.Volts(k / kRate, whole.Read());
      for (int i = 0; i < kStepsATick; ++i) whole.Step(volts);
      if (!compares) continue;
      for (size_t m = 0; m < lacking.size(); ++m) {
        for (int i = 0; i < kStepsATick; ++i) lacking[m].Step(volts);
        Append(whole.Read(), lacking[m].Read(), plan, &all[m]);
      }
    }
  }
  return all;
}

double GapMeter::Between(const Rig& with, const Rig& without) const {
  try {
    return RootMeanSquare(AllDifferences(with, {without})[0]);
  } catch (const std::runtime_error&) {
    return kInfinite;
  }
}

GapMeter::Parts GapMeter::BeyondValues(const Rig& with, const Rig& without) const {
  std::vector<Rig> others = {without};
  for (const ValueForm& form : ValueForms()) {
    // Friction by pressure is an effect where the model has none.
    if (without.values.*form.value == 0) continue;
    others.push_back(without);
    others.back().values.*form.value *= 1.001;
  }
  try {
    std::vector<std::vector<double>> all = AllDifferences(with, others);
    std::vector<double> rest = all[0];
    const double gap = RootMeanSquare(rest);
    std::vector<std::vector<double>> directions;  // orthonormal
    for (size_t m = 1; m < all.size(); ++m) {
      std::vector<double> direction = all[m];
      for (size_t i = 0; i < direction.size(); ++i) direction[i] -= all[0][i];
      const double before = RootMeanSquare(direction);
      for (int pass = 0; pass < 2; ++pass) {
        for (const auto& other : directions) TakeOff(other, &direction);
      }
      const double length = RootMeanSquare(direction);
      if (length < 1e-4 * before || length == 0) continue;  // as good as a combination of the others
      for (double& d : direction) d /= length * std::sqrt(static_cast<double>(direction.size()));
      TakeOff(direction, &rest);
      directions.push_back(std::move(direction));
    }
    return {gap, RootMeanSquare(rest)};
  } catch (const std::runtime_error&) {
    return {kInfinite, kInfinite};
  }
}

}  // namespace foreign_rig
