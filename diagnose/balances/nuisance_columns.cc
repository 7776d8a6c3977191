// Columns that are part of every hypothesis, including "nothing is missing". They describe imperfections that
// every rig has and no model states. Without them, a clock that is wrong by a fraction of a sample, or a hose
// that creeps, would be taken for an effect.
#include <algorithm>
#include <cmath>

#include "diagnose/balances/column_maker.h"
#include "diagnose/balances/latent_pressures.h"

namespace hydro::diagnose {
namespace {

// s: delay of channels in addition to half a sample, due to anti-alias filters and conversion.
constexpr double kLate = 2.5e-4;
// s, and part of the compliance: hoses and seals creep over such times.
constexpr double kCreepTimes[] = {0.03, 0.15};
constexpr double kCreep = 0.04;
constexpr double kMuchCreep = 0.3;
// Friction differs by this part between runs, and over a turn.
constexpr double kFrictionByRun = 0.02;
constexpr double kLeastFriction = 0.05;  // of the motor's torque, for a pump given without friction
// As a fraction of the largest pressure: the zeros of transducers drift by a thousandth of their range, and
// the charge pressure changes with the temperature.
constexpr double kPressureByRun = 1e-3;
// As a fraction of the arm's torque: the load may differ by run, and its centre lies off the line through the
// zero of the angle.
constexpr double kLoad = 0.03;

std::string OfRun(const std::string& name, size_t run) { return name + "[" + std::to_string(run) + "]"; }

// The value of one run in the parameter of this column, which differs by `sd` between runs: relative, or for
// a parameter given as 0 in its unit.
void AddOfRun(ColumnMaker* maker, int column, const std::string& name, size_t run, double sd) {
  ColumnMeaning meaning = maker->table.meaning[static_cast<size_t>(column)];
  meaning.run = static_cast<int>(run);
  meaning.unit = 1;
  maker->AddAlias({OfRun(name, run), "", sd, false}, meaning, column, meaning.run);
}

// A first-order lag.
Eigen::VectorXd Lagged(const Eigen::VectorXd& x, double step, double time) {
  const double keep = std::exp(-step / time);
  Eigen::VectorXd y(x.size());
  double state = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    state = keep * state + (1 - keep) * x[i];
    y[i] = state;
  }
  return y;
}

// The error of a signal's reading if it is late by a second, to first order.
SignalErrors LateBySecond(const RunMotion& run, GridChannel signal) {
  double model::KnownMotion::*const rates[kGridChannels] = {
      &model::KnownMotion::motor_acceleration, &model::KnownMotion::motor_speed,
      &model::KnownMotion::arm_speed, &model::KnownMotion::p1_rate, &model::KnownMotion::p2_rate};
  const auto place = static_cast<size_t>(signal);
  SignalErrors errors;
  errors.of[place].resize(run.size());
  for (size_t k = 0; k < run.size(); ++k) errors.of[place][k] = -(run.at[k].*rates[place]);
  return errors;
}

SignalErrors Constant(const RunMotion& run, GridChannel signal) {
  SignalErrors errors;
  errors.of[static_cast<size_t>(signal)].assign(run.size(), 1.0);
  return errors;
}

void AddLateness(ColumnMaker* maker, bool oil, bool moves) {
  double step = 0;
  for (const RunMotion& run : *maker->runs) step = std::max(step, run.interval);
  const double sd = std::hypot(0.5 * step, kLate);
  const int voltage = maker->Add({"late.voltage", "", sd, false});
  maker->works.back().push_back([maker, voltage](size_t run) {
    const RunMotion& motion = maker->Motion(run);
    if (!CanForm(motion, BalanceKind::kTorque)) return;
    const std::vector<double> rate = Derivative((*maker->base)[run].drive.smooth, motion.step);
    Eigen::VectorXd series((*maker->base)[run].left[0].size());
    for (Eigen::Index i = 0; i < series.size(); ++i) series[i] = rate[static_cast<size_t>(i) * motion.stride];
    maker->Put(voltage, run, BalanceKind::kTorque, std::move(series));
  });
  const auto add = [&](const char* name, const std::vector<GridChannel>& signals) {
    const int column = maker->Add({name, "", sd, false});
    maker->works.back().push_back([maker, column, signals](size_t run) {
      const RunMotion& motion = maker->Motion(run);
      SignalErrors errors;
      for (const GridChannel signal : signals) {
        const bool speed = signal == GridChannel::kSpeed && motion.from_angle;
        const GridChannel actual = speed ? GridChannel::kAngle : signal;
        const SignalErrors one = LateBySecond(motion, actual);
        errors.of[static_cast<size_t>(actual)] = one.of[static_cast<size_t>(actual)];
      }
      maker->Put(column, run, ReadingColumn(*maker, run, errors));
    });
  };
  add("late.motor_speed", {GridChannel::kSpeed});
  if (oil) add("late.p2", {GridChannel::kP2});
  if (oil) add("late.p", {GridChannel::kP1, GridChannel::kP2});
  if (moves) add("late.arm_angle", {GridChannel::kArm});
}

// Oil and hoses yield more the longer a pressure lasts.
void AddCreep(ColumnMaker* maker) {
  const std::optional<int> beta = maker->Named("beta");
  if (!beta) return;
  for (const double time : kCreepTimes) {
    const std::string name = std::to_string(static_cast<int>(1000 * time)) + "ms";
    const int column = maker->Add({"creep." + name, "", kCreep, false});
    const int wide = maker->Add({"closure.creep:" + name, "closure.creep", kMuchCreep, false});
    maker->works.back().push_back([=](size_t run) {
      const RunMotion& motion = maker->Motion(run);
      for (const BalanceKind flow : {BalanceKind::kFlow1, BalanceKind::kFlow2}) {
        const Eigen::VectorXd* compressed = maker->Find(*beta, run, flow);
        if (compressed == nullptr) continue;
        const Eigen::VectorXd late =
            -Lagged(*compressed, motion.step * static_cast<double>(motion.stride), time);
        maker->Put(column, run, flow, late);
        maker->Put(wide, run, flow, late);
      }
    });
  }
}

// Friction that differs by run, and friction that varies once a turn.
void AddFriction(ColumnMaker* maker) {
  const std::optional<int> friction = maker->Named("T_s");
  if (!friction) return;
  const double torque = maker->Size(BalanceKind::kTorque), given = maker->given().T_s;
  const double usual = std::max(given, kLeastFriction * torque);
  const double unit = given != 0 ? given : 1;
  for (size_t r = 0; r < maker->runs->size(); ++r) {
    AddOfRun(maker, *friction, "T_s", r, kFrictionByRun * usual / unit);
    for (const bool sine : {true, false}) {
      const int column =
          maker->Add({OfRun(sine ? "turn.sin" : "turn.cos", r), "", kFrictionByRun * usual / unit, false});
      maker->works.back().push_back([=](size_t run) {
        const Eigen::VectorXd* series = maker->Find(*friction, run, BalanceKind::kTorque);
        if (run != r || series == nullptr) return;
        const RunMotion& motion = maker->Motion(run);
        Eigen::VectorXd turning = *series;
        for (Eigen::Index i = 0; i < turning.size(); ++i) {
          const double angle = motion.at[static_cast<size_t>(i) * motion.stride].motor_angle;
          turning[i] *= sine ? std::sin(angle) : std::cos(angle);
        }
        maker->Put(column, run, BalanceKind::kTorque, std::move(turning));
      });
    }
  }
  if (const std::optional<int> viscous = maker->Named("b")) {
    // Relative to the given value; for a pump given without friction, in its unit.
    const double b = maker->given().b, speed = maker->setup->sizes.speed;
    const double part = b != 0 || !(speed > 0) ? 1 : kLeastFriction * torque / speed;
    for (size_t r = 0; r < maker->runs->size(); ++r) {
      AddOfRun(maker, *viscous, "b", r, kFrictionByRun * part);
    }
  }
}

void AddPressures(ColumnMaker* maker) {
  const double sd = kPressureByRun * maker->setup->sizes.pressure;
  const std::optional<int> charge = maker->Named("p_3");
  for (size_t r = 0; r < maker->runs->size(); ++r) {
    if (!maker->Motion(r).pressures) continue;
    if (charge && maker->given().p_3 != 0)
      AddOfRun(maker, *charge, "p_3", r, sd / std::abs(maker->given().p_3));
    for (const GridChannel side : {GridChannel::kP1, GridChannel::kP2}) {
      if (maker->Motion(r).IsLatent(side)) continue;
      const std::string name = side == GridChannel::kP1 ? "p1_offset" : "p2_offset";
      const int column =
          maker->Add({OfRun(name, r), "", sd, false},
                     {.kind = ColumnMeaning::Kind::kReading, .parameter = name, .run = static_cast<int>(r)});
      maker->works.back().push_back([=](size_t run) {
        if (run == r) maker->Put(column, run, ReadingColumn(*maker, run, Constant(maker->Motion(run), side)));
      });
    }
  }
}

// The initial value of a marched pressure: only the usual size of pressures is known.
void AddStarts(ColumnMaker* maker) {
  for (size_t r = 0; r < maker->runs->size(); ++r) {
    if (maker->Motion(r).slopes.empty()) continue;
    const int column = maker->Add({OfRun("start.p", r), "", maker->setup->sizes.difference, false});
    maker->works.back().push_back([=](size_t run) {
      if (run != r) return;
      BalanceSeries still;
      for (const BalanceKind balance : kAllBalances)
        still[static_cast<size_t>(balance)] =
            Eigen::VectorXd::Zero((*maker->base)[run].left[static_cast<size_t>(balance)].size());
      maker->Put(column, run, AfterPressures(maker->Motion(run), still, 1));
    });
  }
}

void AddLoads(ColumnMaker* maker) {
  const double torque = maker->Size(BalanceKind::kArm);
  const int off = maker->Add({"gravity.sin", "", kLoad * torque, false});
  maker->works.back().push_back([maker, off](size_t run) {
    const RunMotion& motion = maker->Motion(run);
    if (!CanForm(motion, BalanceKind::kArm)) return;
    Eigen::VectorXd series((*maker->base)[run].left[static_cast<size_t>(BalanceKind::kArm)].size());
    for (Eigen::Index i = 0; i < series.size(); ++i)
      series[i] = -std::sin(motion.at[static_cast<size_t>(i) * motion.stride].arm_angle);
    maker->Put(off, run, BalanceKind::kArm, std::move(series));
  });
  // A payload has weight and inertia.
  const double weight = maker->given().mgl != 0 ? std::abs(maker->given().mgl) : 1;
  const std::pair<const char*, double> parts[] = {{"mgl", kLoad * torque / weight}, {"J_a", kLoad}};
  for (const auto& [name, sd] : parts) {
    const std::optional<int> load = maker->Named(name);
    if (!load) continue;
    for (size_t r = 0; r < maker->runs->size(); ++r) {
      if (!CanForm(maker->Motion(r), BalanceKind::kArm)) continue;
      AddOfRun(maker, *load, name, r, sd);
    }
  }
}

}  // namespace

void AddNuisanceColumns(ColumnMaker* maker) {
  bool oil = false, arm = false, moves = false;
  for (const RunMotion& run : *maker->runs) {
    oil |= run.pressures;
    arm |= CanForm(run, BalanceKind::kArm);
    moves |= run.arm_moves && run.pressures;
  }
  AddLateness(maker, oil, moves);
  AddFriction(maker);
  if (oil) AddCreep(maker);
  if (oil) AddPressures(maker);
  AddStarts(maker);
  if (arm) AddLoads(maker);
}

}  // namespace hydro::diagnose
