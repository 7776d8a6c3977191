#include "diagnose/say/locate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "diagnose/say/dependence.h"

namespace hydro::diagnose {

namespace {

constexpr std::array<BalanceKind, 4> kPlaces = {BalanceKind::kTorque, BalanceKind::kFlow1,
                                                BalanceKind::kFlow2, BalanceKind::kArm};

// Of the disagreement: less is not worth a line.
constexpr double kSmallestShare = 0.02;
// The extra share of the variance that a variable must explain to be preferred to a simpler one.
constexpr double kPlainly = 0.06;
// A dependence that explains less does not count.
constexpr double kDependence = 0.05;
// The least energy of a curve over a variable, of means over 12 bins: by chance it is 0 with a standard deviation of 5, and the
// best of a dozen variables is taken.
constexpr double kSignificant = 40;
// The least energy, for each block, where no variable shows anything: sensors that count and differences of slow signals
// make as much as this.
constexpr double kPlain = 3;
// s: in shorter blocks the derivatives of measured signals are mostly noise.
constexpr double kSlow = 0.03;
constexpr size_t kEnoughBlocks = 60;  // to see a dependence
// s: longer blocks miss what repeats within a turn.
constexpr double kQuick = 0.005;
// A command or a late sensor is said to be the cause where it explains so much, and leaves less than this part of what the
// balance's own variables leave.
constexpr double kMostOfLack = 0.5, kFarLess = 0.4;
constexpr double kMostlyOffsets = 0.5;
// Of the largest error of a signal: runs with less are not named beside it.
constexpr double kOtherRun = 0.5;
// The least instants at which a valve passes oil that show what a transducer reads there.
constexpr size_t kEnoughHeld = 25;

struct Dependence {
  Variable variable;
  std::vector<double> averages;
  double explained = 0;
  size_t simplicity = 0;  // place in the list: simple variables come first
};

// By how much they explain; of those that explain nearly as much as the best, the simplest comes first.
std::vector<Dependence> Ranked(const Blocks& blocks, std::vector<Variable> variables,
                               const std::vector<LackingRun>& runs, BalanceKind balance) {
  std::vector<Dependence> ranked;
  for (Variable& variable : variables) {
    if (variable.only_names && blocks.duration < kSlow) continue;
    Dependence d;
    d.averages = Average(variable, blocks, runs, balance);
    d.explained = Explained(blocks, d.averages, variable.linear_only);
    d.variable = std::move(variable);
    d.simplicity = ranked.size();
    ranked.push_back(std::move(d));
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Dependence& a, const Dependence& b) { return a.explained > b.explained; });
  const double best = ranked.front().explained;
  auto simplest = ranked.begin();
  for (auto d = ranked.begin(); d != ranked.end() && d->explained >= best - kPlainly; ++d) {
    if (d->simplicity < simplest->simplicity) simplest = d;
  }
  std::rotate(ranked.begin(), simplest, simplest + 1);
  return ranked;
}

// What means over bins show beyond their scatter; of a line, what it takes of the blocks' scatter.
double EnergyOf(const Blocks& blocks, const Dependence& d) {
  if (d.variable.linear_only) {
    double squares = 0;
    for (const Blocks::Block& block : blocks.blocks) squares += std::pow(block.value / block.noise, 2);
    const double count = static_cast<double>(blocks.blocks.size());
    return d.explained * (squares - count) * count / squares;
  }
  const MissingTerm table = TableOf(blocks, d.variable, d.averages);
  double energy = 0;
  for (size_t i = 0; i < table.at.size(); ++i) energy += std::pow(table.mean[i] / table.error[i], 2) - 1;
  return energy;
}

// What is seen of one balance.
struct Seen {
  Blocks when;  // of the length at which most shows
  Blocks
      where;  // of the length at which a variable explains most, of those that leave enough blocks to see that
  std::vector<Dependence> ranked;  // of `where`
  double energy = 0;               // 0: nothing beyond noise
};

// The largest energy of a curve over any variable.
double LargestCurve(const Blocks& blocks, const std::vector<Dependence>& ranked) {
  double energy = 0;
  for (const Dependence& d : ranked) {
    if (!d.variable.only_names) energy = std::max(energy, EnergyOf(blocks, d));
  }
  return energy;
}

Seen LookAt(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units) {
  Seen seen;
  seen.when = LargestBlocks(runs, balance);
  if (seen.when.blocks.empty()) return seen;
  double curve = 0, explained = 0;
  for (const double duration : kBlockLengths) {
    Blocks blocks = BlocksOf(runs, balance, duration);
    if (blocks.blocks.size() < kEnoughBlocks && !seen.ranked.empty()) break;
    std::vector<Dependence> ranked =
        Ranked(blocks, MotionVariables(runs, balance, units, duration < kQuick), runs, balance);
    curve = std::max(curve, LargestCurve(blocks, ranked));
    const double here = ranked.front().explained * std::max(0.0, EnergyOf(blocks));
    if (!seen.ranked.empty() && here <= explained) continue;
    explained = here;
    seen.where = std::move(blocks);
    seen.ranked = std::move(ranked);
  }
  const double all = EnergyOf(seen.when);
  const bool plain = all > kPlain * static_cast<double>(seen.when.blocks.size());
  if (plain || curve > kSignificant) seen.energy = std::max(all, curve);
  return seen;
}

using AllSeen = std::array<Seen, kBalanceKinds>;

AllSeen LookAtAll(const std::vector<LackingRun>& runs, const UnitSystem& units) {
  AllSeen seen;
  for (const BalanceKind balance : kPlaces) seen[static_cast<size_t>(balance)] = LookAt(runs, balance, units);
  return seen;
}

double TotalOf(const AllSeen& seen) {
  double total = 0;
  for (const Seen& one : seen) total += one.energy;
  return total;
}

std::string WhereOf(const Blocks& blocks, const Dependence& d) {
  return d.explained > kDependence ? RangeOf(blocks, d.variable, d.averages) : "the same everywhere";
}

// Adds up the shares of one place found in several ways; the largest says where.
void AddShare(std::vector<Location>* locations, Location more) {
  for (Location& location : *locations) {
    if (location.balance != more.balance) continue;
    const double share = location.share + more.share;
    if (more.share > location.share) location = std::move(more);
    location.share = share;
    return;
  }
  locations->push_back(std::move(more));
}

std::string WithSign(double value) { return (value < 0 ? "" : "+") + ShortNumber(value, 3); }

// The middle of what the pressures read beyond the level at which one-way valves hold them. Both are 0 where the two agree:
// then the level itself, p_3, may be what is wrong.
PressureOffsets OffsetsOf(const std::vector<LackingRun>& runs) {
  double offset[2] = {}, noise = 0;
  for (int side = 0; side < 2; ++side) {
    const BalanceKind level = side == 0 ? BalanceKind::kLevel1 : BalanceKind::kLevel2;
    std::vector<double> held;
    for (const LackingRun& run : runs) {
      const Eigen::VectorXd& left = run.base.left[static_cast<size_t>(level)];
      for (size_t i = 0; i < run.size(); ++i) {
        if (run.Says(level, i)) held.push_back(left[static_cast<Eigen::Index>(i)]);
      }
      noise = std::max(noise, run.motion.Of(side == 0 ? GridChannel::kP1 : GridChannel::kP2).noise);
    }
    if (held.size() < kEnoughHeld) return {};
    const auto middle = held.begin() + static_cast<std::ptrdiff_t>(held.size() / 2);
    std::nth_element(held.begin(), middle, held.end());
    offset[side] = *middle;
  }
  if (std::abs(offset[0] - offset[1]) < 3 * noise) return {};
  return {offset[0], offset[1]};
}

// The disagreement, and how much of it has been given a place.
struct Placement {
  UnitSystem units;
  std::vector<LackingRun> runs;
  AllSeen seen;
  double all = 0;  // the total of `seen` before any correction
  Localisation result = {};

  size_t Largest() const {
    const auto less = [](const Seen& a, const Seen& b) { return a.energy < b.energy; };
    return static_cast<size_t>(std::max_element(seen.begin(), seen.end(), less) - seen.begin());
  }
};

// The sensors' share is what correcting their offsets removes, if that is most of the disagreement; what is
// left is then placed.
void CorrectOffsets(const model::ModelDescription& model, const std::vector<const RunData*>& runs, int jobs,
                    Placement* placement) {
  const PressureOffsets offsets = OffsetsOf(placement->runs);
  if (offsets.p1 == 0 && offsets.p2 == 0) return;
  std::vector<LackingRun> corrected = LackingIn(model, runs, jobs, offsets);
  AllSeen left = LookAtAll(corrected, placement->units);
  if (TotalOf(left) >= kMostlyOffsets * placement->all) return;
  const std::string unit = " " + model.units.UnitFor("psi");
  const std::string where = "where the valves hold p_3, p1 reads " + WithSign(offsets.p1) + unit +
                            " and p2 " + WithSign(offsets.p2) + unit + " against the model";
  placement->result.location.push_back(
      {"sensor", 1 - TotalOf(left) / placement->all, where,
       WindowsOf(placement->seen[placement->Largest()].when, placement->runs)});
  placement->runs = std::move(corrected);
  placement->seen = std::move(left);
}

// Places the disagreement of one balance: with the balance itself, with the command or with a sensor.
void PlaceBalance(BalanceKind balance, Placement* placement) {
  const std::vector<LackingRun>& runs = placement->runs;
  Seen& seen = placement->seen[static_cast<size_t>(balance)];
  const double share = seen.energy / placement->all;
  if (share < kSmallestShare) return;
  std::vector<Location>& location = placement->result.location;
  const std::vector<Window> windows = WindowsOf(seen.when, runs);
  double own = share;
  // Moves to `to` the share that its variables explain clearly better than the balance's own do.
  const auto move_share = [&](const char* to, std::vector<Variable> variables) {
    if (variables.empty() || own < share) return;
    const Dependence other = Ranked(seen.where, std::move(variables), runs, balance).front();
    const double left = 1 - seen.ranked.front().explained;
    if (other.explained < kMostOfLack || 1 - other.explained > kFarLess * left) return;
    const double part = share * std::min(1.0, other.explained);
    own -= part;
    AddShare(&location, {to, part, WhereOf(seen.where, other), windows});
    seen.ranked.insert(seen.ranked.begin(), other);
  };
  if (balance == BalanceKind::kTorque) move_share("command", CommandVariables(runs));
  move_share("sensor", LateVariables(runs, balance, placement->units));
  if (own < kSmallestShare) return;
  location.push_back({NameOf(balance), own, WhereOf(seen.where, seen.ranked.front()), windows});
}

// Tabulates over the variable that explains most, and over the next one that explains anything.
void Tabulate(BalanceKind balance, Placement* placement) {
  const Seen& seen = placement->seen[static_cast<size_t>(balance)];
  std::vector<MissingTerm>& missing = placement->result.missing;
  for (const Dependence& d : seen.ranked) {
    if (missing.size() == 2 || (!missing.empty() && d.explained < kDependence)) break;
    missing.push_back(TableOf(seen.where, d.variable, d.averages));
    missing.back().balance = NameOf(balance);
    missing.back().unit = UnitOf(balance, placement->units);
  }
}

// From the first to the last instant at which the signal's error is more than half of its largest, and that.
std::pair<Window, double> WorstStretch(const RunCurves& run, model::Channel channel, bool after) {
  Window window{run.run, 0, 0};
  double largest = 0;
  for (const RunCurves::Curve& curve : run.curves) {
    const std::vector<double>& simulated = after ? curve.after : curve.before;
    if (curve.channel != channel || simulated.size() != curve.measured.size()) continue;
    const auto error = [&](size_t k) { return std::abs(curve.measured[k] - simulated[k]); };
    for (size_t k = 0; k < simulated.size(); ++k) {
      if (std::isfinite(error(k))) largest = std::max(largest, error(k));
    }
    bool inside = false;
    for (size_t k = 0; k < simulated.size(); ++k) {
      if (!(error(k) > 0.5 * largest)) continue;
      if (!inside) window.from = run.time[k];
      window.to = run.time[k];
      inside = true;
    }
  }
  return {window, largest};
}

}  // namespace

Localisation Locate(const model::ModelDescription& model, const std::vector<const RunData*>& runs, int jobs) {
  Placement placement{model.units, LackingIn(model, runs, jobs), {}};
  placement.seen = LookAtAll(placement.runs, model.units);
  placement.all = TotalOf(placement.seen);
  for (const Seen& seen : placement.seen) placement.result.judged |= !seen.when.blocks.empty();
  if (placement.all == 0) return std::move(placement.result);
  CorrectOffsets(model, runs, jobs, &placement);
  for (const BalanceKind balance : kPlaces) PlaceBalance(balance, &placement);
  std::vector<Location>& location = placement.result.location;
  std::stable_sort(location.begin(), location.end(),
                   [](const Location& a, const Location& b) { return a.share > b.share; });
  if (!location.empty() && location.front().balance != "sensor") {
    Tabulate(static_cast<BalanceKind>(placement.Largest()), &placement);
  }
  return std::move(placement.result);
}

std::vector<Location> WorstSignal(const std::vector<SignalGap>& signals, const std::vector<RunCurves>& curves,
                                  bool after) {
  double all = 0, most = 0;
  const SignalGap* worst = nullptr;
  for (const SignalGap& signal : signals) {
    const double gap = after ? signal.fit.after : signal.fit.before;
    const double energy = signal.noise > 0 ? std::pow(gap / signal.noise, 2) - 1 : 0;
    if (!(energy > 0)) continue;
    all += energy;
    if (energy > most) most = energy, worst = &signal;
  }
  if (worst == nullptr) return {};
  Location location{ChannelName(worst->channel),
                    most / all,
                    "no balance shows where; of the signals, this is predicted worst",
                    {}};
  double largest = 0;
  for (const RunCurves& run : curves)
    largest = std::max(largest, WorstStretch(run, worst->channel, after).second);
  for (const RunCurves& run : curves) {
    const auto [window, error] = WorstStretch(run, worst->channel, after);
    if (error > kOtherRun * largest) location.windows.push_back(window);
  }
  return {location};
}

}  // namespace hydro::diagnose
