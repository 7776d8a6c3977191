#include "diagnose/balances/balance_series.h"

#include <algorithm>
#include <limits>

namespace hydro::diagnose {
namespace {

size_t Place(BalanceKind balance) { return static_cast<size_t>(balance); }

template <class T>
const T& Part(const model::BalancesOf<T>& left, BalanceKind balance) {
  switch (balance) {
    case BalanceKind::kFlow1:
      return left.flow_1;
    case BalanceKind::kFlow2:
      return left.flow_2;
    case BalanceKind::kArm:
      return left.arm;
    case BalanceKind::kLevel1:
      return left.level_1;
    case BalanceKind::kLevel2:
      return left.level_2;
    case BalanceKind::kTorque:
      break;
  }
  return left.torque;
}

Eigen::Index Count(const RunMotion& run) {
  return static_cast<Eigen::Index>((run.size() + run.stride - 1) / run.stride);
}

BalanceSeries Empty(const RunMotion& run) {
  BalanceSeries series;
  for (const BalanceKind balance : kAllBalances) {
    if (IsComputed(run, balance)) series[Place(balance)] = Eigen::VectorXd::Zero(Count(run));
  }
  return series;
}

std::vector<double> SmoothDrive(const std::vector<double>& middle, double step) {
  return Smoothed(middle, SmoothingOf(step) / step);
}

// What a filter sees of the motor's torque at an instant at which it may jump: the mean of both sides. A jump
// before the instant, where a command acts late by part of a sample, is spread over both samples beside it,
// so that its time is kept.
void SetMiddle(const model::BalanceEquations& equations, const RunMotion& run, size_t k, double drive,
               std::vector<double>* middle) {
  (*middle)[k] = drive;
  if (k == 0) return;
  if (!equations.acted_late() && run.at[k].voltage == run.at[k - 1].voltage) return;
  const double jump = drive - equations.DriveBefore(run.at[k], run.at[k - 1].voltage);
  (*middle)[k] -= 0.5 * (1 - equations.early()) * jump;
  (*middle)[k - 1] += 0.5 * equations.early() * jump;
}

// Calls visit(k, balances) at every instant in order. The effects' states follow the motion.
template <class Visit>
void WalkAlong(const model::ModelDescription& model, const RunMotion& run, size_t stride, Visit visit,
               size_t last = std::numeric_limits<size_t>::max()) {
  model::BalanceEquations equations(model, run.options);
  const bool remembers = equations.remembers();
  if (remembers) equations.Start(run.at.front(), true);  // a recording begins in motion
  for (size_t k = 0; k < std::min(last, run.size()); ++k) {
    if (remembers && k > 0) equations.Advance(run.at[k - 1], run.at[k]);
    if (k % stride == 0) visit(k, equations);
  }
}

// Whether the first samples already show that the model gives another motor torque.
bool DriveChangesEarly(const model::ModelDescription& model, const RunMotion& run, const BaseSeries& base) {
  constexpr size_t kSamples = 256;
  bool changes = false;
  WalkAlong(
      model, run, 1,
      [&](size_t k, const model::BalanceEquations& equations) {
        changes = changes || equations.Values(run.at[k]).drive != base.drive.raw[k];
      },
      kSamples);
  return changes;
}

}  // namespace

bool CanForm(const RunMotion& run, BalanceKind balance) {
  const bool flows =
      run.pressures && run.speed_known && (run.options.shaft == model::Shaft::kClamped || run.arm_moves);
  switch (balance) {
    case BalanceKind::kTorque:
      return run.speed_known && (run.options.bypass || run.pressures);
    case BalanceKind::kFlow1:
    case BalanceKind::kLevel1:
      return flows && !run.IsLatent(GridChannel::kP1);
    case BalanceKind::kFlow2:
    case BalanceKind::kLevel2:
      return flows && !run.IsLatent(GridChannel::kP2);
    case BalanceKind::kArm:
      return run.pressures && run.arm_moves && run.options.shaft == model::Shaft::kFree;
  }
  return false;
}

bool IsComputed(const RunMotion& run, BalanceKind balance) {
  const bool flow = balance == BalanceKind::kFlow1 || balance == BalanceKind::kFlow2;
  return CanForm(run, balance) || (flow && !run.slopes.empty());
}

BaseSeries SeriesOf(const model::ModelDescription& model, const RunMotion& run) {
  BaseSeries base;
  base.left = Empty(run);
  base.drive.raw.resize(run.size());
  base.drive.middle.resize(run.size());
  WalkAlong(model, run, 1, [&](size_t k, const model::BalanceEquations& equations) {
    const model::BalancesOf<double> left = equations.Values(run.at[k]);
    base.drive.raw[k] = left.drive;
    SetMiddle(equations, run, k, left.drive, &base.drive.middle);
    if (k % run.stride != 0) return;
    for (const BalanceKind balance : kAllBalances) {
      Eigen::VectorXd& series = base.left[Place(balance)];
      if (series.size() > 0) series[static_cast<Eigen::Index>(k / run.stride)] = Part(left, balance);
    }
  });
  base.drive.smooth = SmoothDrive(base.drive.middle, run.step);
  Eigen::VectorXd& torque = base.left[Place(BalanceKind::kTorque)];
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    const auto k = static_cast<size_t>(i) * run.stride;
    torque[i] += base.drive.smooth[k] - base.drive.raw[k];
  }
  return base;
}

BalanceSeries Beyond(const model::ModelDescription& model, const RunMotion& run, const BaseSeries& base) {
  BalanceSeries beyond = Empty(run);
  std::vector<double> raw(run.size(), 0.0), middle(run.size(), 0.0);
  const auto pass = [&](size_t stride) {
    bool driven = false;
    WalkAlong(model, run, stride, [&](size_t k, const model::BalanceEquations& equations) {
      const model::BalancesOf<double> left = equations.Values(run.at[k]);
      raw[k] = left.drive - base.drive.raw[k];
      driven |= raw[k] != 0;
      if (stride == 1) SetMiddle(equations, run, k, left.drive, &middle);
      if (k % run.stride != 0) return;
      for (const BalanceKind balance : kAllBalances) {
        Eigen::VectorXd& series = beyond[Place(balance)];
        const auto i = static_cast<Eigen::Index>(k / run.stride);
        if (series.size() > 0) series[i] = Part(left, balance) - base.left[Place(balance)][i];
      }
    });
    return driven;
  };
  // Where the motor's torque is the same, every stride-th instant suffices.
  const bool likely = run.stride > 1 && DriveChangesEarly(model, run, base);
  bool driven = pass(likely ? 1 : run.stride);
  if (driven && !likely && run.stride > 1) driven = pass(1);
  Eigen::VectorXd& torque = beyond[Place(BalanceKind::kTorque)];
  if (torque.size() == 0) return beyond;
  for (size_t k = 0; k < middle.size() && driven; ++k) middle[k] -= base.drive.middle[k];
  const std::vector<double> smooth = driven ? SmoothDrive(middle, run.step) : std::vector<double>{};
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    const auto k = static_cast<size_t>(i) * run.stride;
    torque[i] += base.drive.smooth[k] - base.drive.raw[k];
    if (driven) torque[i] += smooth[k] - raw[k];
  }
  return beyond;
}

bool DependsOnCommandAlone(const model::ModelDescription& model, const RunMotion& run,
                           const BaseSeries& base) {
  constexpr size_t kSamples = 512;
  const model::BalanceEquations probe(model, run.options);
  if (!probe.remembers()) return false;
  RunMotion still = run;
  still.at.resize(std::min(kSamples, run.size()));
  RunMotion moving = still;
  for (model::KnownMotion& at : still.at) {
    const model::KnownMotion moved = at;
    at = {.time = moved.time,
          .voltage = moved.voltage,
          .p1 = 0.9 * moved.p1,
          .p2 = 1.1 * moved.p2,
          .around = moved.around,
          .pump_direction = moved.pump_direction};
  }
  std::vector<double> drives[2];
  bool only_drive = true;
  for (const RunMotion* one : {&still, &moving}) {
    WalkAlong(model, *one, 1, [&](size_t k, const model::BalanceEquations& equations) {
      const model::BalancesOf<double> left = equations.Values(one->at[k]);
      drives[one == &moving ? 1 : 0].push_back(left.drive);
      if (one != &moving || k % run.stride != 0) return;
      const auto i = static_cast<Eigen::Index>(k / run.stride);
      for (const BalanceKind balance : kAllBalances) {
        const Eigen::VectorXd& series = base.left[Place(balance)];
        if (series.size() == 0 || balance == BalanceKind::kTorque) continue;
        only_drive = only_drive && Part(left, balance) == series[i];
      }
    });
  }
  return only_drive && drives[0] == drives[1];
}

std::vector<BalanceSeries> DerivativesOf(const model::ModelDescription& model, const RunMotion& run,
                                         const std::vector<model::Unknown>& unknowns) {
  std::vector<BalanceSeries> all(unknowns.size(), Empty(run));
  const model::BalanceEquations equations(model, run.options, unknowns);
  for (size_t k = 0; k < run.size(); k += run.stride) {
    const model::BalancesOf<model::Jet> left = equations.At(run.at[k]);
    const auto i = static_cast<Eigen::Index>(k / run.stride);
    for (size_t u = 0; u < unknowns.size(); ++u) {
      const int direction = static_cast<int>(u);
      if (left.drive.v[direction] != 0) return {};
      for (const BalanceKind balance : kAllBalances) {
        Eigen::VectorXd& series = all[u][Place(balance)];
        if (series.size() > 0) series[i] = Part(left, balance).v[direction];
      }
    }
  }
  return all;
}

SignalErrors ErrorsOf(const model::ModelDescription& model, const RunMotion& run) {
  SignalErrors errors;
  for (std::vector<double>& of : errors.of) of.assign(run.size(), 0.0);
  WalkAlong(model, run, 1, [&](size_t k, const model::BalanceEquations& equations) {
    const model::ReadingErrors read = equations.Errors(run.at[k]);
    const double values[kGridChannels] = {read.motor_speed, read.motor_angle, read.arm_angle, read.p1,
                                          read.p2};
    for (size_t s = 0; s < kGridChannels; ++s) errors.of[s][k] = values[s];
  });
  for (std::vector<double>& of : errors.of) {
    if (std::ranges::all_of(of, [](double value) { return value == 0; })) of.clear();
  }
  return errors;
}

}  // namespace hydro::diagnose
