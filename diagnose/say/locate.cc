#include "diagnose/say/locate.h"

#include <utility>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "diagnose/say/seen.h"

namespace hydro::diagnose {
namespace {

constexpr BalanceKind kPlaces[] = {BalanceKind::kTorque, BalanceKind::kFlow1, BalanceKind::kFlow2,
                                   BalanceKind::kArm};

// As a fraction of the disagreement: a smaller share is not worth a line.
constexpr double kSmallestShare = 0.02;

using AllSeen = std::array<Seen, std::size(kPlaces)>;

AllSeen LookAtAll(const std::vector<LackingRun>& runs, const UnitSystem& units) {
  AllSeen seen;
  for (size_t i = 0; i < seen.size(); ++i) seen[i] = LookAt(runs, kPlaces[i], units);
  return seen;
}

double TotalOf(const AllSeen& seen) {
  double total = 0;
  for (const Seen& one : seen) total += one.energy;
  return total;
}

// The index in kPlaces of the largest.
size_t Largest(const AllSeen& seen) {
  const auto less = [](const Seen& a, const Seen& b) { return a.energy < b.energy; };
  return static_cast<size_t>(std::ranges::max_element(seen, less) - seen.begin());
}

// Adds up the shares of one place that was found in several ways. The largest share says where.
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

// The median of what the pressures read above the level at which one-way valves hold them. Both are 0 where
// the two agree, because the level itself, p_3, may then be wrong.
PressureOffsets OffsetsOf(const std::vector<LackingRun>& runs) {
  double offset[2] = {}, noise = 0;
  for (int side = 0; side < 2; ++side) {
    const auto level = static_cast<size_t>(side == 0 ? BalanceKind::kLevel1 : BalanceKind::kLevel2);
    std::vector<double> held;
    for (const LackingRun& run : runs) {
      for (size_t i = 0; i < run.masks[level].size(); ++i) {
        if (run.masks[level][i] == 0) held.push_back(run.base.left[level][static_cast<Eigen::Index>(i)]);
      }
      noise = std::max(noise, run.motion.Of(side == 0 ? GridChannel::kP1 : GridChannel::kP2).noise);
    }
    if (held.empty()) return {};
    offset[side] = maths::Median(held);
  }
  if (std::abs(offset[0] - offset[1]) < 3 * noise) return {};
  return {offset[0], offset[1]};
}

// The disagreement, and how much of it has been assigned a place.
struct Placement {
  UnitSystem units;
  std::vector<LackingRun> runs;
  AllSeen seen;
  double all = 0;  // the total of `seen` before any correction
  Localisation result = {};
};

// The sensors' share is what correcting their offsets removes, if that is most of the disagreement. The
// remainder is then placed.
void CorrectOffsets(const model::ModelDescription& model, const std::vector<const RunData*>& runs, int jobs,
                    Placement* placement) {
  const PressureOffsets offsets = OffsetsOf(placement->runs);
  if (offsets.p1 == 0 && offsets.p2 == 0) return;
  std::vector<LackingRun> corrected = LackingIn(model, runs, jobs, offsets);
  AllSeen left = LookAtAll(corrected, placement->units);
  if (TotalOf(left) >= kFarLess * placement->all) return;
  const std::string unit = " " + model.units.UnitFor("psi");
  const std::string where = "where the valves hold p_3, p1 reads " + WithSign(offsets.p1) + unit +
                            " and p2 " + WithSign(offsets.p2) + unit + " against the model";
  placement->result.location.push_back(
      {"sensor", 1 - TotalOf(left) / placement->all, where,
       WindowsOf(placement->seen[Largest(placement->seen)].when, placement->runs)});
  placement->runs = std::move(corrected);
  placement->seen = std::move(left);
}

// Places the disagreement of one balance: with the balance itself, with the command or with a sensor.
void PlaceBalance(size_t place, Placement* placement) {
  const std::vector<LackingRun>& runs = placement->runs;
  const BalanceKind balance = kPlaces[place];
  Seen& seen = placement->seen[place];
  const double share = seen.energy / placement->all;
  if (share < kSmallestShare) return;
  std::vector<Location>& location = placement->result.location;
  const std::vector<Window> windows = WindowsOf(seen.when, runs);
  double own = share;
  // Moves to `to` the share that its variables explain clearly better than the balance's own.
  const auto move_share = [&](const char* to, std::vector<Variable> variables) {
    if (variables.empty() || own < share) return;
    const Dependence other = Ranked(seen.where, std::move(variables), runs, balance).front();
    if (1 - other.explained > kFarLess * (1 - seen.ranked.front().explained)) return;
    const double part = share * std::min(1.0, other.explained);
    own -= part;
    AddShare(&location, {to, part, WhereOf(other), windows});
    seen.ranked.insert(seen.ranked.begin(), other);
  };
  if (balance == BalanceKind::kTorque) move_share("command", CommandVariables(runs));
  move_share("sensor", LateVariables(runs, balance, placement->units));
  if (own < kSmallestShare) return;
  location.push_back({NameOf(balance), own, WhereOf(seen.ranked.front()), windows});
}

// Tabulates the lack over the two variables that explain most.
void Tabulate(size_t place, Placement* placement) {
  const std::vector<Dependence>& ranked = placement->seen[place].ranked;
  for (size_t i = 0; i < std::min<size_t>(2, ranked.size()); ++i) {
    const BinnedCurve& curve = ranked[i].curve;
    if (curve.size() == 0 || (i > 0 && ranked[i].explained == 0)) continue;
    placement->result.missing.push_back({.balance = NameOf(kPlaces[place]),
                                         .unit = UnitOf(kPlaces[place], placement->units),
                                         .against = ranked[i].variable.name,
                                         .against_unit = ranked[i].variable.unit,
                                         .at = curve.at,
                                         .measured = curve.measured,
                                         .error = curve.error});
  }
}

// The stretch from the first to the last instant at which the signal's error exceeds half of its largest, and
// that largest error.
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
  if (placement.all == 0) return {};
  CorrectOffsets(model, runs, jobs, &placement);
  for (size_t place = 0; place < std::size(kPlaces); ++place) PlaceBalance(place, &placement);
  std::vector<Location>& location = placement.result.location;
  std::ranges::stable_sort(location, [](const Location& a, const Location& b) { return a.share > b.share; });
  if (!location.empty() && location.front().balance != "sensor")
    Tabulate(Largest(placement.seen), &placement);
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
    // Runs with a smaller error are not named beside it.
    if (error > 0.5 * largest) location.windows.push_back(window);
  }
  return {location};
}

}  // namespace hydro::diagnose
