#include "diagnose/balances/columns.h"

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"
#include "base/parallel.h"
#include "diagnose/balances/column_maker.h"
#include "diagnose/balances/latent_pressures.h"

namespace hydro::diagnose {
namespace {

// The quantile that counts as the largest speed: a motor reaches it now and then, not just once.
constexpr double kTopQuantile = 0.995;
// The quantile that counts as the largest pressure.
constexpr double kTopPressureQuantile = 0.998;
// A command whose torque is less than a tenth of what moves is none: the motor coasts, or its load drives it.
constexpr double kCommanded = 0.1;
// A whole effect is next to nothing if it would take this many times its size to make the usual part.
constexpr double kNextToNothing = 1e3;
// A column that seldom acts is measured where it acts: by the root of sum x^4 over sum x^2.
double SizeWhereItActs(const std::vector<const Eigen::VectorXd*>& series) {
  double second = 0, fourth = 0;
  for (const Eigen::VectorXd* one : series) {
    second += one->squaredNorm();
    fourth += one->array().square().square().sum();
  }
  return second > 0 ? std::sqrt(fourth / second) : 0;
}

double Quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<size_t>(at)];
}

double RootMean(double sum, double count) { return count > 0 ? std::sqrt(sum / count) : 0; }

// An amount of 1 makes the column the usual part of its balance; with several balances, of the one in which
// the column is largest.
double UnitOf(const ColumnMaker& maker, int column) {
  double largest = 0;
  for (size_t b = 0; b < kBalanceKinds; ++b) {
    const double size = maker.setup->sizes.of[b];
    std::vector<const Eigen::VectorXd*> series;
    for (const auto& run : maker.table.series) {
      const auto found = run[b].find(column);
      if (found != run[b].end()) series.push_back(&found->second);
    }
    if (!series.empty() && size > 0) largest = std::max(largest, SizeWhereItActs(series) / size);
  }
  return largest > 0 ? kUsualPart / largest : 0;
}

}  // namespace

void ColumnMaker::Put(int column, size_t run, const BalanceSeries& all, double factor) {
  for (size_t b = 0; b < kBalanceKinds; ++b) {
    if (all[b].size() == 0 || all[b].squaredNorm() == 0) continue;
    table.series[run][b][column] = factor * all[b];
  }
}

const Eigen::VectorXd* ColumnMaker::Find(int column, size_t run, BalanceKind balance) const {
  const auto& all = table.series[run][static_cast<size_t>(balance)];
  const auto found = all.find(column);
  return found == all.end() ? nullptr : &found->second;
}

std::optional<int> ColumnMaker::Named(const std::string& name) const {
  for (size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

int ColumnMaker::AddAlias(ScanColumn column, ColumnMeaning meaning, int of, int only_run) {
  const int alias = Add(std::move(column), std::move(meaning));
  works.back().push_back([this, alias, of, only_run](size_t run) {
    if (only_run >= 0 && static_cast<size_t>(only_run) != run) return;
    for (auto& balance : table.series[run]) {
      const auto found = balance.find(of);
      if (found != balance.end()) balance[alias] = found->second;
    }
  });
  return alias;
}

BalanceSeries ReadingColumn(const ColumnMaker& maker, size_t run, const SignalErrors& errors) {
  const RunMotion& motion = maker.Motion(run);
  // A thousandth of the signals' own ranges: there the balances are practically linear, and rounding is far
  // away.
  double largest = 0;
  for (size_t s = 0; s < kGridChannels; ++s) {
    if (errors.of[s].empty() || !motion.signals[s].measured()) continue;
    const double range = maths::RangeOf(motion.signals[s].values).size();
    for (const double error : errors.of[s])
      largest = std::max(largest, std::abs(error) / std::max(range, 1e-300));
  }
  if (largest == 0) return {};
  const double part = 1e-3 / largest;
  BalanceSeries change = Beyond(maker.setup->given, Without(motion, errors, part), (*maker.base)[run]);
  for (Eigen::VectorXd& series : change) series /= part;
  return change;
}

BalanceSizes SizesOfBalances(const std::vector<RunMotion>& runs, const std::vector<BaseSeries>& base,
                             const model::Parameters& given) {
  BalanceSizes sizes;
  double torque = 0, inertia = 0, speed = 0, n = 0, flow = 0, difference = 0, oil = 0, arm = 0, arm_sum = 0,
         arm_n = 0, arm_speed = 0;
  std::vector<double> speeds, pressures;
  sizes.arm_low = 1e300, sizes.arm_high = -1e300;
  for (size_t r = 0; r < runs.size(); ++r) {
    const RunMotion& run = runs[r];
    for (size_t k = 0; k < run.size(); k += run.stride) {
      const model::KnownMotion& at = run.at[k];
      torque += std::pow(base[r].drive.smooth[k], 2);
      inertia += std::pow(given.J * at.motor_acceleration, 2);
      speed += std::pow(at.motor_speed, 2);
      speeds.push_back(std::abs(at.motor_speed));
      ++n;
      if (run.arm_moves) {
        sizes.arm_low = std::min(sizes.arm_low, at.arm_angle);
        sizes.arm_high = std::max(sizes.arm_high, at.arm_angle);
      }
      if (!run.pressures) continue;
      flow += std::pow(given.D * at.motor_speed, 2);
      difference += std::pow(at.p2 - at.p1, 2);
      pressures.push_back(std::max(at.p1, at.p2));
      ++oil;
      if (!CanForm(run, BalanceKind::kArm)) continue;
      const double push = given.k_2 * (at.p2 - at.p1);
      arm += push * push;
      arm_sum += push;
      arm_speed += std::pow(at.arm_speed, 2);
      ++arm_n;
    }
  }
  const auto set = [&](BalanceKind balance, double value) { sizes.of[static_cast<size_t>(balance)] = value; };
  sizes.speed = RootMean(speed, n);
  sizes.largest_speed = Quantile(std::move(speeds), kTopQuantile);
  sizes.difference = RootMean(difference, oil);
  sizes.pressure = Quantile(std::move(pressures), kTopPressureQuantile);
  sizes.arm_speed = RootMean(arm_speed, arm_n);
  const double largest = std::max(inertia, given.D * given.D * difference);
  set(BalanceKind::kTorque, RootMean(torque > kCommanded * kCommanded * largest ? torque : largest, n));
  set(BalanceKind::kFlow1, RootMean(flow, oil));
  set(BalanceKind::kFlow2, RootMean(flow, oil));
  const double mean = arm_n > 0 ? arm_sum / arm_n : 0;
  set(BalanceKind::kArm,
      arm_n > 0 ? std::max(RootMean(arm - arm_n * mean * mean, arm_n), 0.3 * std::abs(given.mgl)) : 0);
  set(BalanceKind::kLevel1, sizes.difference);
  set(BalanceKind::kLevel2, sizes.difference);
  return sizes;
}

namespace {

// Adds the effect of flow columns on the torque balance through pressures that were not measured.
void FollowPressures(ColumnMaker* maker, int jobs) {
  // Rounding errors where an effect does not act, as a fraction of the squared column.
  constexpr double kNothing = 1e-18;
  const size_t runs = maker->runs->size(), count = maker->table.columns.size();
  std::vector<std::vector<bool>> direct(runs, std::vector<bool>(count, false));
  ParallelFor(runs, jobs, [&](size_t r) {
    const RunMotion& motion = maker->Motion(r);
    auto& all = maker->table.series[r];
    for (size_t i = 0; i < count; ++i) {
      BalanceSeries change;
      double within = 0;
      for (const BalanceKind balance : kAllBalances) {
        const auto b = static_cast<size_t>(balance);
        const auto found = all[b].find(static_cast<int>(i));
        const bool there = found != all[b].end();
        if (there && CanForm(motion, balance)) within = std::max(within, found->second.squaredNorm());
        if (motion.slopes.empty()) continue;
        change[b] = there ? found->second : Eigen::VectorXd::Zero((*maker->base)[r].left[b].size());
        if (there) all[b].erase(found);
      }
      direct[r][i] = within > 0;
      if (motion.slopes.empty()) continue;
      change = AfterPressures(motion, std::move(change));
      maker->Put(static_cast<int>(i), r, change);
      double whole = 0;
      for (const Eigen::VectorXd& series : change) whole = std::max(whole, series.squaredNorm());
      direct[r][i] = within > kNothing * whole;
    }
  });
  for (size_t i = 0; i < count; ++i) {
    bool any = false;
    for (size_t r = 0; r < runs; ++r) any = any || direct[r][i];
    maker->table.direct.push_back(any);
  }
}

ColumnTable Make(ColumnSetup* setup, const std::vector<RunMotion>& runs, const std::vector<BaseSeries>& base,
                 int jobs, const ColumnTable* again, const std::vector<void (*)(ColumnMaker*)>& kinds) {
  ColumnMaker maker;
  maker.setup = setup;
  maker.runs = &runs;
  maker.base = &base;
  maker.again = again;
  maker.table.series.resize(runs.size());
  for (const auto add : kinds) {
    maker.works.emplace_back();
    add(&maker);
  }
  ParallelFor(runs.size(), jobs, [&](size_t run) {
    for (const std::vector<ColumnWork>& stage : maker.works) {
      for (const ColumnWork& work : stage) work(run);
    }
  });
  FollowPressures(&maker, jobs);
  const size_t count = maker.table.columns.size();
  const bool first = setup->units.empty();
  if (first) setup->units.assign(count, 1.0);
  for (size_t i = 0; i < count; ++i) {
    ColumnMeaning& meaning = maker.table.meaning[i];
    if (first) setup->units[i] = meaning.unit != 0 ? meaning.unit : UnitOf(maker, static_cast<int>(i));
    meaning.unit = setup->units[i];
    // A whole effect that does next to nothing at its grid point cannot be judged there.
    const bool whole =
        meaning.kind == ColumnMeaning::Kind::kWhole || meaning.kind == ColumnMeaning::Kind::kMoved;
    if (first && whole && UnitOf(maker, static_cast<int>(i)) > kNextToNothing) setup->units[i] = 0;
    const double unit = setup->units[i];
    if (meaning.kind == ColumnMeaning::Kind::kEffect) {
      const model::EffectDescription& effect = setup->variants[meaning.variant].at;
      maker.table.columns[i].most = ParameterOf(effect, meaning.parameter).max / unit;
    }
    if (unit == 1) continue;
    for (auto& run : maker.table.series) {
      for (auto& balance : run) {
        const auto found = balance.find(static_cast<int>(i));
        if (found != balance.end()) found->second *= unit;
      }
    }
  }
  return std::move(maker.table);
}

}  // namespace

ColumnTable MakeColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                        const std::vector<BaseSeries>& base, int jobs, const ColumnTable* again) {
  if (setup->only_always) return Make(setup, runs, base, jobs, again, {AddBaseColumns, AddNuisanceColumns});
  std::vector<void (*)(ColumnMaker*)> kinds = {AddBaseColumns, AddEffectColumns, AddNuisanceColumns};
  if (setup->curves) kinds.push_back(AddClosureColumns);
  kinds.push_back(AddValueColumns);
  return Make(setup, runs, base, jobs, again, kinds);
}

ColumnTable MakeEffectColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                              const std::vector<BaseSeries>& base, int jobs, const ColumnTable* again) {
  return Make(setup, runs, base, jobs, again, {AddEffectColumns});
}

ColumnTable MakeWaveColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                            const std::vector<BaseSeries>& base, int jobs) {
  return Make(setup, runs, base, jobs, nullptr, {AddWaveColumns});
}

}  // namespace hydro::diagnose
