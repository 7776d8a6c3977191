#include "diagnose/locate/locate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "diagnose/data/observed_mode.h"
#include "diagnose/locate/dependence.h"
#include "diagnose/locate/disagreement.h"
#include "diagnose/locate/disturbance_smoother.h"
#include "diagnose/locate/explanations.h"
#include "diagnose/locate/pressure_offsets.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

namespace {

constexpr std::array<const char*, kBalances> kNames = {"pump_torque", "flow_1", "flow_2", "arm_torque"};

constexpr double kSmallestShare = 0.02;
// The extra share of the variance that a variable must explain to be preferred to a simpler one.
constexpr double kPlainly = 0.06;
// A dependence that explains less does not count.
constexpr double kDependence = 0.05;
constexpr double kQuick = 0.005;  // s: longer blocks miss what repeats within a turn
constexpr double kMostlyOffsets = 0.5;
constexpr double kReversal = 0.02;  // s on either side of a reversal

struct Found {
  std::array<Blocks, kBalances> blocks;
  std::array<double, kBalances> energy{};  // 0: nothing beyond noise
  double total = 0;
};

Found Weigh(const std::vector<SmoothedRun>& smoothed, const std::vector<const RunData*>& runs) {
  Found found;
  for (size_t b = 0; b < kBalances; ++b) {
    Disagreement d = LargestDisagreement(smoothed, runs, static_cast<Balance>(b));
    found.blocks[b] = std::move(d.blocks);
    if (!d.beyond_noise) continue;
    found.energy[b] = d.energy;
    found.total += d.energy;
  }
  return found;
}

std::vector<SmoothedRun> SmoothAll(const model::ModelDescription& model,
                                   const std::vector<const RunData*>& runs, const PressureOffsets& offsets) {
  std::vector<SmoothedRun> smoothed;
  smoothed.reserve(runs.size());
  for (const RunData* run : runs) smoothed.push_back(SmoothDisturbances(model, *run, offsets));
  return smoothed;
}

struct Dependence {
  Variable variable;
  std::vector<double> averages;
  double explained = 0;
  size_t simplicity = 0;  // position in the list: simple variables come first
};

// Ordered by how much they explain.
std::vector<Dependence> Rank(const Blocks& blocks, std::vector<Variable> variables,
                             const std::vector<SmoothedRun>& smoothed, Balance balance) {
  std::vector<Dependence> ranked;
  for (Variable& variable : variables) {
    Dependence d;
    d.averages = Average(variable, blocks, smoothed, balance);
    d.explained = Explained(blocks, d.averages, variable.linear_only);
    d.variable = std::move(variable);
    d.simplicity = ranked.size();
    ranked.push_back(std::move(d));
  }
  const auto more = [](const Dependence& a, const Dependence& b) { return a.explained > b.explained; };
  std::stable_sort(ranked.begin(), ranked.end(), more);
  // Of those that explain nearly as much as the best, choose the simplest.
  const double best = ranked.front().explained;
  auto simplest = ranked.begin();
  for (auto d = ranked.begin(); d != ranked.end() && d->explained >= best - kPlainly; ++d) {
    if (d->simplicity < simplest->simplicity) simplest = d;
  }
  std::rotate(ranked.begin(), simplest, simplest + 1);
  return ranked;
}

// "at reversals" if most of the energy but little of the time lies near reversals of the motor; else "".
std::string AtReversals(const Blocks& blocks, const std::vector<const RunData*>& runs) {
  std::vector<std::vector<double>> reversals(runs.size());
  for (size_t r = 0; r < runs.size(); ++r) {
    const ObservedMode observed = ObserveMode(*runs[r]);
    int last = 0;
    for (size_t k = 0; k < observed.turns.size(); ++k) {
      const int now = observed.turns[k];
      if (now == last || now == 0) continue;
      if (last != 0) reversals[r].push_back(runs[r]->stimulus.time[k]);
      last = now;
    }
  }
  double near = 0, all = 0;
  size_t near_blocks = 0;
  for (const Blocks::Block& block : blocks.blocks) {
    const std::vector<double>& time = runs[block.run]->stimulus.time;
    const double ratio = block.value / block.noise;
    const auto next = std::lower_bound(reversals[block.run].begin(), reversals[block.run].end(),
                                       time[block.first] - kReversal);
    const bool at = next != reversals[block.run].end() && *next <= time[block.end - 1] + kReversal;
    all += ratio * ratio - 1;
    if (!at) continue;
    near += ratio * ratio - 1;
    ++near_blocks;
  }
  const bool here = near > 0.6 * all && 3 * near_blocks < blocks.blocks.size();
  return here ? "at reversals" : "";
}

std::string WhereOf(const Blocks& blocks, const std::vector<Dependence>& ranked,
                    const std::vector<const RunData*>& runs) {
  std::string where = "the same everywhere";
  if (ranked.front().explained > kDependence) {
    where = RangeOf(blocks, ranked.front().variable, ranked.front().averages);
  }
  const std::string reversals = AtReversals(blocks, runs);
  if (!reversals.empty()) where += ", " + reversals;
  return where;
}

// A thousandth of all values lies below the first, and above the second.
std::pair<double, double> ReachOf(const Variable& variable) {
  std::vector<double> all;
  for (const std::vector<double>& values : variable.values) {
    std::copy_if(values.begin(), values.end(), std::back_inserter(all),
                 [](double value) { return std::isfinite(value); });
  }
  if (all.empty()) return {0, 0};
  const size_t edge = all.size() / 1000;
  const auto low = all.begin() + static_cast<std::ptrdiff_t>(edge);
  const auto high = all.end() - 1 - static_cast<std::ptrdiff_t>(edge);
  std::nth_element(all.begin(), low, all.end());
  const double lowest = *low;
  std::nth_element(all.begin(), high, all.end());
  return {lowest, *high};
}

MissingTerm TableOfBalance(const Blocks& blocks, const Dependence& d, size_t balance,
                           const UnitSystem& units) {
  MissingTerm table = TableOf(blocks, d.variable, d.averages);
  table.balance = kNames[balance];
  table.unit = UnitOf(static_cast<Balance>(balance), units);
  return table;
}

// The balance's tables over what a closure may depend on. `share` is the balance's of the disagreement.
void AddPossible(const Blocks& blocks, const std::vector<Dependence>& ranked, size_t balance, double share,
                 const UnitSystem& units, std::vector<PossibleTerm>* possible) {
  const model::EffectInfo* closure = model::FindEffect(std::string("closure.") + kNames[balance]);
  const std::vector<std::string>& allowed = closure->parameters.front().names;
  for (const Dependence& d : ranked) {
    if (std::find(allowed.begin(), allowed.end(), d.variable.name) == allowed.end()) continue;
    if (d.variable.linear_only || !(d.explained > kDependence)) continue;
    const auto [low, high] = ReachOf(d.variable);
    possible->push_back(
        {TableOfBalance(blocks, d, balance, units), low, high, share * std::min(1.0, d.explained)});
  }
}

// Tabulates over the variable that explains most, and over the next one that explains anything.
void Tabulate(const Blocks& blocks, const std::vector<Dependence>& ranked, size_t balance,
              const UnitSystem& units, std::vector<MissingTerm>* missing) {
  for (const Dependence& d : ranked) {
    if (missing->size() == 2 || (!missing->empty() && d.explained < kDependence)) break;
    missing->push_back(TableOfBalance(blocks, d, balance, units));
  }
}

// Adds up the shares of one balance found in several ways; the largest names the place.
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

size_t LargestBalance(const Found& found) {
  return static_cast<size_t>(std::max_element(found.energy.begin(), found.energy.end()) -
                             found.energy.begin());
}

// The disagreement, and how much of it has been given a place.
struct Placement {
  UnitSystem units;
  std::vector<SmoothedRun> smoothed;
  Found found;
  double all = 0;  // the total of `found` before any correction
  std::array<std::vector<Dependence>, kBalances> ranked;
  Localisation result;
};

// The sensors' share is what correcting their offsets removes, if that is most of the disagreement; what is
// left is then placed.
void CorrectOffsets(const model::ModelDescription& model, const std::vector<const RunData*>& runs,
                    Placement* placement) {
  const PressureOffsets offsets = RestOffsets(model, runs);
  if (offsets.p1 == 0 && offsets.p2 == 0) return;
  std::vector<SmoothedRun> corrected = SmoothAll(model, runs, offsets);
  Found left = Weigh(corrected, runs);
  if (left.total >= kMostlyOffsets * placement->all) return;
  const std::string unit = " " + model.units.UnitFor("psi");
  // The model says what the valves hold, so this is a difference from it: p_3 may be what is wrong.
  const std::string where = "where the valves hold p_3, p1 reads " + WithSign(offsets.p1) + unit +
                            " and p2 " + WithSign(offsets.p2) + unit + " against the model";
  placement->result.location.push_back(
      {"sensor", 1 - left.total / placement->all, where,
       WindowsOf(placement->found.blocks[LargestBalance(placement->found)], runs)});
  placement->smoothed = std::move(corrected);
  placement->found = std::move(left);
}

// Places the disagreement of one balance: with the balance itself, with the command or with a sensor.
void Place(const Explanations& explanations, const std::vector<const RunData*>& runs, size_t b,
           Placement* placement) {
  const double share = placement->found.energy[b] / placement->all;
  if (share < kSmallestShare) return;
  const Balance balance = static_cast<Balance>(b);
  const Blocks& blocks = placement->found.blocks[b];
  std::vector<Location>& location = placement->result.location;
  std::vector<Dependence>& ranked = placement->ranked[b];
  ranked = Rank(blocks, explanations.States(balance, blocks.duration < kQuick), placement->smoothed, balance);
  AddPossible(blocks, ranked, b, share, placement->units, &placement->result.possible);
  double own = share;
  // Moves to `to` the share that its variables explain clearly better than the balance's own do.
  const auto move_share = [&](const char* to, std::vector<Variable> variables) {
    if (variables.empty() || own < share) return;
    const std::vector<Dependence> others = Rank(blocks, std::move(variables), placement->smoothed, balance);
    AddPossible(blocks, others, b, share, placement->units, &placement->result.possible);
    const double explained = others.front().explained;
    if (explained <= ranked.front().explained + kPlainly) return;
    const double part = share * std::min(1.0, explained);
    own -= part;
    AddShare(&location, {to, part, WhereOf(blocks, {others.front()}, runs), WindowsOf(blocks, runs)});
    ranked.insert(ranked.begin(), others.front());
  };
  if (balance == Balance::kPumpTorque) move_share("command", explanations.Commands());
  move_share("sensor", explanations.Lateness(balance));
  if (own < kSmallestShare) return;
  location.push_back({kNames[b], own, WhereOf(blocks, ranked, runs), WindowsOf(blocks, runs)});
}

}  // namespace

std::string NameOf(Balance balance) { return kNames[static_cast<size_t>(balance)]; }

std::string UnitOf(Balance balance, const UnitSystem& units) {
  if (balance == Balance::kFlow1 || balance == Balance::kFlow2) return units.UnitFor("in^3/s");
  return units.UnitFor("in-lbf", balance == Balance::kArmTorque ? -1 : 0);
}

Localisation Locate(const model::ModelDescription& model, const std::vector<const RunData*>& runs) {
  Placement placement;
  placement.units = model.units;
  placement.smoothed = SmoothAll(model, runs, {});
  placement.found = Weigh(placement.smoothed, runs);
  placement.all = placement.found.total;
  if (placement.all == 0) return {};
  CorrectOffsets(model, runs, &placement);
  const Explanations explanations(placement.smoothed, runs, model.units);
  for (size_t b = 0; b < kBalances; ++b) Place(explanations, runs, b, &placement);
  std::vector<Location>& location = placement.result.location;
  std::stable_sort(location.begin(), location.end(),
                   [](const Location& a, const Location& b) { return a.share > b.share; });
  std::stable_sort(placement.result.possible.begin(), placement.result.possible.end(),
                   [](const PossibleTerm& a, const PossibleTerm& b) { return a.explained > b.explained; });
  if (!location.empty() && location.front().balance != "sensor") {
    const size_t b = LargestBalance(placement.found);
    Tabulate(placement.found.blocks[b], placement.ranked[b], b, model.units, &placement.result.missing);
  }
  return std::move(placement.result);
}

}  // namespace hydro::diagnose
