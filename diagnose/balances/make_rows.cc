#include "diagnose/balances/make_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "base/parallel.h"
#include "base/word_list.h"
#include "diagnose/balances/latent_pressures.h"
#include "diagnose/balances/rows_to_read.h"
#include "diagnose/balances/test_functions.h"
#include "model/balances.h"
#include "model/terms/model_error.h"

namespace hydro::diagnose {
namespace {

// The arm moves more slowly, and its balance has a second derivative.
constexpr double kArmPart = 0.5;
// Levels are constants, so a few test functions in each tile suffice.
constexpr double kLevelTiles = 2;
// Motion of a held side's pressure, which is not completely still, as a fraction of the largest pressure.
constexpr double kLevelNoise = 5e-4;
// s, error of the timing between samples of different signals; for a slow recorder, a tenth of a sample.
constexpr double kClock = 2e-4, kClockPart = 0.1;
constexpr uint64_t kNoiseSeed = 5;

double HighestOf(const RunMotion& run, BalanceKind balance, double tile, double most) {
  double interval = run.step;
  for (const GridSignal& signal : run.signals) {
    if (signal.measured()) interval = std::max(interval, signal.interval);
  }
  const double highest = std::min(most, kOfTheRate / interval);
  if (balance == BalanceKind::kArm) return kArmPart * highest;
  const bool level = balance == BalanceKind::kLevel1 || balance == BalanceKind::kLevel2;
  return level ? std::min(highest, kLevelTiles / tile) : highest;
}

// The variance, at a frequency, that the sensors' noise causes in what a balance leaves.
double SensorVariance(const RunMotion& run, const model::Parameters& p, BalanceKind balance, double frequency,
                      double largest_pressure) {
  const double omega = 2 * std::numbers::pi * frequency;
  const auto noise = [&](GridChannel signal) { return run.Of(signal).measured() ? run.Of(signal).noise : 0; };
  const double speed = run.from_angle ? noise(GridChannel::kAngle) * omega : noise(GridChannel::kSpeed);
  const double p1 = noise(GridChannel::kP1), p2 = noise(GridChannel::kP2),
               arm = run.arm_moves ? noise(GridChannel::kArm) : 0;
  const double passed = std::exp(-std::pow(omega * SmoothingOf(run.step), 2));
  switch (balance) {
    case BalanceKind::kTorque:
      return passed * (std::pow(p.J * omega * speed, 2) + std::pow(p.b * speed, 2) +
                       (run.pressures ? p.D * p.D * (p1 * p1 + p2 * p2) : 0) +
                       (run.slopes.empty() ? 0 : std::pow(p.D * p.D * speed * p.beta / (p.V_ms * omega), 2)));
    case BalanceKind::kFlow1:
    case BalanceKind::kFlow2:
      return passed * (std::pow(p.V_ms / p.beta * omega * std::max(p1, p2), 2) + std::pow(p.D * speed, 2) +
                       std::pow(p.c * omega * arm, 2));
    case BalanceKind::kArm:
      return passed * (std::pow(p.J_a * omega * omega * arm, 2) + p.k_2 * p.k_2 * (p1 * p1 + p2 * p2));
    case BalanceKind::kLevel1:
    case BalanceKind::kLevel2:
      break;
  }
  return p1 * p1 + std::pow(kLevelNoise * largest_pressure, 2);
}

// Base values are relative to the one term of their balance that keeps its value, so all of them share its
// uncertainty.
void SetPrior(const ColumnSetup& setup, const std::vector<ColumnMeaning>& meaning, Rows* rows) {
  const auto count = static_cast<Eigen::Index>(rows->columns.size());
  rows->prior = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double sd = rows->columns[static_cast<size_t>(i)].sd;
    rows->prior(i, i) = sd * sd * (1 + 1e-9);
  }
  using model::Parameters;
  const auto yardstick = [](double Parameters::*member) -> double Parameters::* {
    for (double Parameters::*one : {&Parameters::J, &Parameters::b, &Parameters::T_s, &Parameters::f,
                                    &Parameters::T_pmax, &Parameters::D}) {
      if (one == member) return &Parameters::k_1;
    }
    if (member == &Parameters::J_a || member == &Parameters::mgl) return &Parameters::k_2;
    return member == &Parameters::p_3 ? nullptr : &Parameters::D;
  };
  const auto member_of = [](const ColumnMeaning& one) { return model::BaseParameters()[one.base].member; };
  for (Eigen::Index i = 0; i < count; ++i) {
    const ColumnMeaning& a = meaning[static_cast<size_t>(i)];
    if (std::ranges::find(rows->base, static_cast<int>(i)) == rows->base.end()) continue;
    for (const int j : rows->base) {
      const ColumnMeaning& b = meaning[static_cast<size_t>(j)];
      double Parameters::*of = yardstick(member_of(a));
      if (of == nullptr || of != yardstick(member_of(b))) continue;
      if (setup.given.parameters.*member_of(a) == 0 || setup.given.parameters.*member_of(b) == 0) continue;
      size_t place = 0;
      while (model::BaseParameters()[place].member != of) ++place;
      const double known = model::UncertaintyOf(setup.given, place);
      // A bulk modulus divides, so its sign is opposite.
      const bool opposite = (member_of(a) == &Parameters::beta) != (member_of(b) == &Parameters::beta);
      rows->prior(i, j) += (opposite ? -1 : 1) * known * known;
    }
  }
}

void NameBase(const std::vector<ColumnMeaning>& meaning, Rows* rows) {
  using model::Parameters;
  for (size_t i = 0; i < meaning.size(); ++i) {
    const ColumnMeaning& one = meaning[i];
    if (one.kind != ColumnMeaning::Kind::kBase || one.run >= 0) continue;
    double Parameters::*member = model::BaseParameters()[one.base].member;
    const bool always = rows->columns[i].set.empty();
    if (always) rows->base.push_back(static_cast<int>(i));
    if (member == &Parameters::J) rows->inertia.push_back(static_cast<int>(i));
    if (always && (member == &Parameters::b || member == &Parameters::D))
      rows->other_torques.push_back(static_cast<int>(i));
  }
}

int MainColumn(const Rows& rows, BalanceKind balance) {
  const char* name = balance == BalanceKind::kTorque                                    ? "J"
                     : balance == BalanceKind::kFlow1 || balance == BalanceKind::kFlow2 ? "beta"
                     : balance == BalanceKind::kArm                                     ? "J_a"
                                                                                        : "";
  for (const int i : rows.base) {
    if (rows.columns[static_cast<size_t>(i)].name == name) return i;
  }
  return -1;
}

// The position of a column's values in a block; null: the column is 0 there.
const double* ColumnIn(const RowBlock& block, int column) {
  const auto found = std::ranges::lower_bound(block.columns, column);
  if (found == block.columns.end() || *found != column) return nullptr;
  return block.X.col(found - block.columns.begin()).data();
}

// Whether a column is another one times a number, in all rows. `apart` is the share of its square by which it
// may differ.
bool IsDouble(const Rows& rows, int column, int other, double apart) {
  double aa = 0, ab = 0, bb = 0;
  for (const RowBlock& block : rows.blocks) {
    const double* a = ColumnIn(block, column);
    const double* b = ColumnIn(block, other);
    const double size = std::max(block.y.squaredNorm(), std::numeric_limits<double>::min());
    for (Eigen::Index i = 0; i < block.y.size(); ++i) {
      const double x = a == nullptr ? 0 : a[i], y = b == nullptr ? 0 : b[i];
      aa += x * x / size;
      ab += x * y / size;
      bb += y * y / size;
    }
  }
  return aa > 0 && bb > 0 && ab * ab > (1 - apart) * aa * bb;
}

void SetToZero(int column, Rows* rows) {
  for (RowBlock& block : rows->blocks) {
    const auto found = std::ranges::lower_bound(block.columns, column);
    if (found == block.columns.end() || *found != column) continue;
    block.X.col(found - block.columns.begin()).setZero();
    block.noise_X.col(found - block.columns.begin()).setZero();
  }
}

// Whether the motors turn one way only. What they turn the other way by may be an overshoot.
bool TurnOneWay(const std::vector<RunMotion>& runs) {
  constexpr double kOvershoot = 0.01;  // of the whole path
  double forward = 0, backward = 0;
  for (const RunMotion& run : runs) {
    if (!run.speed_known) continue;
    for (const model::KnownMotion& at : run.at)
      (at.motor_speed > 0 ? forward : backward) += std::abs(at.motor_speed) * run.step;
  }
  return std::min(forward, backward) < kOvershoot * std::max(forward, backward);
}

// Removes effects that change all balances as base parameters do, because wrong values are the likelier
// cause: those of one number that are exactly a parameter's column, and, where the motors turn one way only,
// those of which each number is a parameter's column but for starts and overshoots (a constant torque and
// friction that differs between the directions).
std::vector<std::pair<std::string, std::string>> TakeOutDoubles(bool one_way, Rows* rows) {
  constexpr double kSame = 1e-6;  // of the squared size: difference due to rounding and smoothing
  constexpr double kSameOneWay = 0.02;
  std::vector<std::pair<std::string, std::string>> doubles;
  std::map<std::string, std::vector<int>> sets;
  for (size_t i = 0; i < rows->columns.size(); ++i) {
    const std::string& set = rows->columns[i].set;
    if (!set.empty() && !set.starts_with("value.") && !set.starts_with("run."))
      sets[set].push_back(static_cast<int>(i));
  }
  for (const auto& [set, columns] : sets) {
    if (columns.size() != 1 && !one_way) continue;
    std::vector<std::string> values;
    for (const int column : columns) {
      const auto base = std::ranges::find_if(rows->base, [&](int one) {
        // The torque limit acts in the few rows at the limit, and stands for no other effect.
        if (rows->columns[static_cast<size_t>(one)].name == "T_pmax") return false;
        return IsDouble(*rows, column, one, one_way ? kSameOneWay : kSame);
      });
      if (base == rows->base.end()) break;
      values.push_back(rows->columns[static_cast<size_t>(*base)].name);
    }
    if (values.size() != columns.size()) continue;
    doubles.emplace_back(set, Enumerated(values));
    for (const int column : columns) SetToZero(column, rows);
  }
  return doubles;
}

// Whether the model may have the effect where the runs hold the arm: a line leaves less of a side's volume to
// the stroke.
bool CanStand(const model::ModelDescription& given, const EffectVariant& variant,
              const std::vector<RunMotion>& runs) {
  if (variant.kind != EffectVariant::Kind::kWhole) return true;
  model::ModelDescription with = given;
  with.effects.push_back(variant.at);
  try {
    for (const RunMotion& run : runs) model::BalanceEquations(with, run.options);
  } catch (const model::ModelError&) {
    return false;
  }
  return true;
}

}  // namespace

ScanRuns::ScanRuns(const model::ModelDescription& given, const std::vector<const RunData*>& runs,
                   const ScanOptions& options)
    : jobs_(options.jobs), highest_(options.highest) {
  setup_.given = given;
  setup_.allowed = options.allowed;
  setup_.only_always = options.only_always;
  setup_.curves = options.curves;
  setup_.per_run = options.per_run;
  setup_.hold_effects = options.hold_effects;
  setup_.variants = VariantsOf(options.changes, SizesOf(given, runs));
  motions_.resize(runs.size());
  noisy_.resize(runs.size());
  base_.resize(runs.size());
  noisy_base_.resize(runs.size());
  const RowsRead read = RowsToRead(runs);
  const std::vector<std::array<double, kGridChannels>> noises = LeastNoises(runs);
  ParallelFor(runs.size(), jobs_, [&](size_t r) {
    const ReadAs as = {options.inverted, read.every, noises[r]};
    motions_[r] = BusiestPart(MotionOf(*runs[r], given.parameters, as), read.part);
    if (MayMarch(motions_[r])) MarchPressures(options.marched.value_or(given), &motions_[r]);
    noisy_[r] = WithNoiseAgain(motions_[r], given.parameters, kNoiseSeed + r);
    base_[r] = SeriesOf(given, motions_[r]);
    noisy_base_[r] = SeriesOf(given, noisy_[r]);
  });
  std::erase_if(setup_.variants,
                [&](const EffectVariant& variant) { return !CanStand(given, variant, motions_); });
  std::vector<double> durations;
  for (const RunMotion& run : motions_) durations.push_back(run.step * static_cast<double>(run.size()));
  std::nth_element(durations.begin(), durations.begin() + static_cast<std::ptrdiff_t>(durations.size() / 2),
                   durations.end());
  tile_ = options.tile > 0 ? options.tile : TileLength(durations[durations.size() / 2]);
  setup_.sizes = SizesOfBalances(motions_, base_, given.parameters);
  const HeldPressure held = FindHeldPressure(motions_, given.parameters);
  for (size_t r = 0; r < motions_.size(); ++r)
    masks_.push_back(MasksOf(motions_[r], base_[r].left, held, given.parameters));
  clean_ = MakeColumns(&setup_, motions_, base_, jobs_);
  noisy_table_ = MakeColumns(&setup_, noisy_, noisy_base_, jobs_, &clean_);
}

void ScanRuns::Project(const ColumnTable& clean, const ColumnTable& noisy, Rows* rows) const {
  struct Place {
    size_t run;
    BalanceKind balance;
  };
  std::vector<Place> places;
  for (size_t r = 0; r < motions_.size(); ++r) {
    for (const BalanceKind balance : kAllBalances) {
      if (CanForm(motions_[r], balance)) places.push_back({r, balance});
    }
  }
  std::vector<RowBlock> blocks(places.size());
  ParallelFor(places.size(), jobs_, [&](size_t b) {
    const auto [r, balance] = places[b];
    const auto kind = static_cast<size_t>(balance);
    const RunMotion& motion = motions_[r];
    RowBlock& block = blocks[b];
    block.run = r;
    block.balance = balance;
    block.main_column = MainColumn(*rows, balance);
    const auto& series = clean.series[r][kind];
    const auto& again = noisy.series[r][kind];
    const Eigen::Index count = base_[r].left[kind].size();
    // The columns, then the residual. The second half of the matrix holds the noise alone.
    Eigen::MatrixXd all(count, 2 * static_cast<Eigen::Index>(series.size() + 1));
    const Eigen::Index half = all.cols() / 2;
    for (const auto& [column, values] : series) {
      const auto c = static_cast<Eigen::Index>(block.columns.size());
      block.columns.push_back(column);
      all.col(c) = values;
      const auto found = again.find(column);
      all.col(half + c) =
          found == again.end() ? Eigen::VectorXd::Zero(count) : Eigen::VectorXd(found->second - values);
    }
    const BalanceSeries clean_left = AfterPressures(motion, base_[r].left);
    all.col(half - 1) = clean_left[kind];
    all.col(all.cols() - 1) = AfterPressures(motion, noisy_base_[r].left)[kind] - clean_left[kind];
    const double step = motion.step * static_cast<double>(motion.stride);
    const std::vector<TestFunctions> functions =
        TestFunctionsOf(masks_[r][kind], step, tile_, HighestOf(motion, balance, tile_, highest_));
    Eigen::Index total = 0;
    for (const TestFunctions& one : functions) total += one.frequency.size();
    block.X.resize(total, half - 1);
    block.noise_X.resize(total, half - 1);
    block.y.resize(total);
    block.noise_y.resize(total);
    block.frequency.resize(total);
    block.sensor_variance.resize(total);
    Eigen::Index row = 0;
    for (const TestFunctions& one : functions) {
      const Eigen::MatrixXd weighed = one.values * all.middleRows(one.first, one.values.cols());
      const Eigen::Index n = weighed.rows();
      if (half > 1) block.X.middleRows(row, n) = weighed.leftCols(half - 1);
      block.y.segment(row, n) = weighed.col(half - 1);
      if (half > 1) block.noise_X.middleRows(row, n) = weighed.middleCols(half, half - 1);
      block.noise_y.segment(row, n) = weighed.col(all.cols() - 1);
      block.frequency.segment(row, n) = one.frequency;
      row += n;
    }
    for (Eigen::Index i = 0; i < total; ++i) {
      block.band.push_back(BandOf(block.frequency[i], tile_));
      block.sensor_variance[i] =
          SensorVariance(motion, setup_.given.parameters, balance, block.frequency[i], setup_.sizes.pressure);
    }
  });
  for (RowBlock& block : blocks) {
    if (block.y.size() > 0) rows->blocks.push_back(std::move(block));
  }
}

bool ScanRuns::HasLatent() const {
  return std::ranges::any_of(motions_, [](const RunMotion& run) { return !run.slopes.empty(); });
}

std::set<std::string> ScanRuns::OilOnly() const {
  std::set<std::string> oil, direct;
  for (size_t i = 0; i < clean_.columns.size(); ++i) {
    const bool somewhere = std::ranges::any_of(clean_.series, [&](const auto& run) {
      return std::ranges::any_of(run,
                                 [&](const auto& balance) { return balance.contains(static_cast<int>(i)); });
    });
    if (somewhere && !clean_.columns[i].set.empty())
      (clean_.direct[i] ? direct : oil).insert(clean_.columns[i].set);
  }
  for (const std::string& set : direct) oil.erase(set);
  return oil;
}

void ScanRuns::Append(const ColumnTable& more, ColumnTable* table) {
  const int first = static_cast<int>(table->columns.size());
  table->columns.insert(table->columns.end(), more.columns.begin(), more.columns.end());
  table->meaning.insert(table->meaning.end(), more.meaning.begin(), more.meaning.end());
  for (size_t r = 0; r < table->series.size(); ++r) {
    for (size_t b = 0; b < kBalanceKinds; ++b) {
      for (const auto& [column, values] : more.series[r][b]) table->series[r][b][first + column] = values;
    }
  }
}

Rows ScanRuns::MakeRows(const std::vector<int>& periods) {
  ColumnTable clean = clean_, noisy = noisy_table_;
  if (!periods.empty()) {
    ColumnSetup waves = setup_;
    waves.periods = periods;
    waves.units.clear();
    Append(MakeWaveColumns(&waves, motions_, base_, jobs_), &clean);
    Append(MakeWaveColumns(&waves, noisy_, noisy_base_, jobs_), &noisy);
  }
  meaning_ = clean.meaning;
  Rows rows;
  rows.columns = clean.columns;
  NameBase(meaning_, &rows);
  SetPrior(setup_, meaning_, &rows);
  double step = 0;
  for (const RunMotion& run : motions_) step = std::max(step, run.interval);
  rows.clock = std::max(kClock, kClockPart * step);
  Project(clean, noisy, &rows);
  doubles_ = TakeOutDoubles(TurnOneWay(motions_), &rows);
  return rows;
}

Rows ScanRuns::MakeWaveRows(const std::vector<int>& periods) const {
  ColumnSetup waves = setup_;
  waves.periods = periods;
  waves.units.clear();
  const ColumnTable table = MakeWaveColumns(&waves, motions_, base_, jobs_);
  Rows rows;
  rows.columns = table.columns;
  Project(table, table, &rows);
  return rows;
}

}  // namespace hydro::diagnose
