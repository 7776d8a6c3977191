#include "diagnose/say/locate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "diagnose/say/dependence.h"
#include "diagnose/say/seen.h"

namespace hydro::diagnose {

namespace {

constexpr std::array<BalanceKind, 4> kPlaces = {BalanceKind::kTorque, BalanceKind::kFlow1,
                                                BalanceKind::kFlow2, BalanceKind::kArm};

// Of the disagreement: less is not worth a line.
constexpr double kSmallestShare = 0.02;
// A dependence that explains less does not count.
constexpr double kDependence = 0.05;
// A command or a late sensor is said to be the cause where it explains so much, and leaves less than this part of what the
// balance's own variables leave.
constexpr double kMostOfLack = 0.5, kFarLess = 0.4;
constexpr double kMostlyOffsets = 0.5;
// The least instants at which a valve passes oil that show what a transducer reads there.
constexpr size_t kEnoughHeld = 25;

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

}  // namespace hydro::diagnose
