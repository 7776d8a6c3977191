#include "diagnose/locate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "diagnose/disagreement.h"
#include "diagnose/disturbance_smoother.h"
#include "diagnose/observed_mode.h"

namespace hydro {

namespace {

constexpr std::array<const char*, kBalances> kNames = {"pump_torque", "flow_1", "flow_2", "arm_torque"};
constexpr std::array<const char*, kBalances> kUnits = {"in-lbf", "in^3/s", "in^3/s", "in-lbf"};

// Nothing is located below these: so many standard deviations of what noise does, and a disturbance of so
// much against it at its best scale. The smoother linearises and holds each mode over a sample; what that
// costs stays below.
constexpr double kSignificant = 8;
constexpr double kMaterial = 0.1;
constexpr double kSmallestShare = 0.02;
// A variable must explain so much more of the variance than a simpler one to be preferred to it.
constexpr double kPlainly = 0.03;
// A dependence that explains less is none.
constexpr double kDependence = 0.05;
constexpr double kQuick = 0.005;  // s: longer blocks do not see what repeats within a turn
constexpr int kMostPeriods = 24;
constexpr double kReversal = 0.02;  // s on either side of one

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
    if (d.significance < kSignificant || d.per_block < kMaterial) continue;
    found.energy[b] = d.energy;
    found.total += d.energy;
  }
  return found;
}

std::vector<SmoothedRun> SmoothAll(const ModelDescription& model, const std::vector<const RunData*>& runs,
                                   const PressureOffsets& offsets) {
  std::vector<SmoothedRun> smoothed;
  for (const RunData* run : runs) smoothed.push_back(SmoothDisturbances(model, *run, offsets));
  return smoothed;
}

// The lowest pressure that a side rests at: where the one-way valve holds it. NaN when it does not show.
double Floor(const std::vector<const RunData*>& runs, Channel channel) {
  double floor = NAN;
  for (const RunData* run : runs) {
    const SignalData* const signal = run->Find(channel);
    if (signal == nullptr) continue;
    const ObservedMode observed = ObserveMode(*run);
    std::vector<double> values = channel == Channel::kP1 ? observed.p1 : observed.p2;
    std::erase_if(values, [](double value) { return std::isnan(value); });
    if (values.size() < 100) continue;
    std::sort(values.begin(), values.end());
    // A plateau: a twentieth of the samples within the noise of each other.
    const double margin = 2 * (channel == Channel::kP1 ? observed.p1_margin : observed.p2_margin);
    const size_t low = values.size() / 100;
    const size_t high = values.size() / 20;
    if (values[high] - values[low] > margin) continue;
    const auto end = std::upper_bound(values.begin(), values.end(), values[low] + margin);
    const double middle = values[static_cast<size_t>(end - values.begin()) / 2];
    floor = std::isnan(floor) ? middle : std::min(floor, middle);
  }
  return floor;
}

// What the transducers read at the valves' pressure tells an offset of theirs from a wrong p_3, when they
// do not agree with each other.
PressureOffsets OffsetsOf(const ModelDescription& model, const std::vector<const RunData*>& runs) {
  const double floor_1 = Floor(runs, Channel::kP1), floor_2 = Floor(runs, Channel::kP2);
  double noise = 0;
  for (const RunData* run : runs) {
    for (const Channel channel : {Channel::kP1, Channel::kP2}) {
      if (const SignalData* signal = run->Find(channel)) noise = std::max(noise, signal->noise);
    }
  }
  if (std::isnan(floor_1) || std::isnan(floor_2) || std::abs(floor_1 - floor_2) < 3 * noise) return {};
  return {floor_1 - model.parameters.p_3, floor_2 - model.parameters.p_3};
}

using Series = std::vector<std::vector<double>>;

class Signals {
 public:
  Signals(const std::vector<SmoothedRun>& smoothed, const std::vector<const RunData*>& runs)
      : smoothed_(smoothed), runs_(runs) {}

  template <class F>
  Variable Make(const std::string& name, const std::string& unit, const F& f) const {
    Variable variable{name, unit, {}, false};
    for (size_t r = 0; r < runs_.size(); ++r) {
      std::vector<double> values(runs_[r]->samples());
      for (size_t k = 0; k < values.size(); ++k) values[k] = f(smoothed_[r], *runs_[r], k);
      variable.values.push_back(std::move(values));
    }
    return variable;
  }

  std::vector<Variable> States(Balance balance, bool quick) const {
    using R = const SmoothedRun&;
    using D = const RunData&;
    const auto sign = [](double x) { return static_cast<double>((x > 0) - (x < 0)); };
    std::vector<Variable> all;  // plain ones first
    if (balance == Balance::kArmTorque) {
      all.push_back(Make("arm_speed", "rad/s", [](R s, D, size_t k) { return s.arm_speed[k]; }));
      all.push_back(Make("arm_angle", "rad", [](R s, D, size_t k) { return s.arm_angle[k]; }));
      all.push_back(Make("p2 - p1", "psi", [](R s, D, size_t k) { return s.p2[k] - s.p1[k]; }));
    } else {
      all.push_back(Make("motor_speed", "rad/s", [](R s, D, size_t k) { return s.motor_speed[k]; }));
      if (balance == Balance::kPumpTorque) {
        all.push_back(Make("p1 + p2", "psi", [](R s, D, size_t k) { return s.p1[k] + s.p2[k]; }));
        all.push_back(Make("(p1 + p2) sgn(motor_speed)", "psi",
                           [&](R s, D, size_t k) { return (s.p1[k] + s.p2[k]) * sign(s.motor_speed[k]); }));
        all.push_back(Make("motor_acceleration", "rad/s^2", [](R s, D d, size_t k) {
          const size_t first = k == 0 ? 0 : k - 1, last = std::min(k + 1, d.samples() - 1);
          return (s.motor_speed[last] - s.motor_speed[first]) /
                 (d.stimulus.time[last] - d.stimulus.time[first]);
        }));
      } else {
        const bool one = balance == Balance::kFlow1;
        all.push_back(
            Make(one ? "p1" : "p2", "psi", [one](R s, D, size_t k) { return one ? s.p1[k] : s.p2[k]; }));
        all.push_back(Make(one ? "p1 rate" : "p2 rate", "psi/s", [one](R s, D d, size_t k) {
          const std::vector<double>& p = one ? s.p1 : s.p2;
          const size_t first = k == 0 ? 0 : k - 1, last = std::min(k + 1, d.samples() - 1);
          return (p[last] - p[first]) / (d.stimulus.time[last] - d.stimulus.time[first]);
        }));
      }
      all.push_back(Make("p2 - p1", "psi", [](R s, D, size_t k) { return s.p2[k] - s.p1[k]; }));
      all.push_back(Make("arm_angle", "rad", [](R s, D, size_t k) { return s.arm_angle[k]; }));
      all.push_back(Make("arm_speed", "rad/s", [](R s, D, size_t k) { return s.arm_speed[k]; }));
    }
    if (quick && balance != Balance::kArmTorque) {
      for (int periods = 1; periods <= kMostPeriods; ++periods) all.push_back(Turn(periods));
    }
    all.push_back(
        Make("time", "s", [](R, D d, size_t k) { return d.stimulus.time[k] - d.stimulus.time.front(); }));
    return all;
  }

  // The voltage, and how far it is ahead of itself a time constant before.
  std::vector<Variable> Commands() const {
    std::vector<Variable> all;
    all.push_back(Make("voltage", "V",
                       [](const SmoothedRun&, const RunData& d, size_t k) { return d.stimulus.voltage[k]; }));
    // A limit shows beyond some voltage only.
    double largest = 0;
    for (const RunData* run : runs_) {
      for (const double v : run->stimulus.voltage) largest = std::max(largest, std::abs(v));
    }
    for (const double part : {0.5, 0.65, 0.8, 0.9}) {
      const double from = part * largest;
      Variable beyond = Make("voltage", "V", [from](const SmoothedRun&, const RunData& d, size_t k) {
        const double v = d.stimulus.voltage[k];
        return v > from ? v - from : v < -from ? v + from : 0;
      });
      char name[48];
      std::snprintf(name, sizeof name, "voltage beyond %.3g V", from);
      beyond.name = name;
      beyond.linear_only = true;
      all.push_back(std::move(beyond));
    }
    for (const double lag : {0.001, 0.002, 0.004, 0.008, 0.016, 0.032}) {
      double behind = 0;
      Variable change = Make("change of voltage", "V", [&](const SmoothedRun&, const RunData& d, size_t k) {
        const double now = d.stimulus.voltage[k];
        if (k == 0) {
          behind = now;
        } else {
          const double before = d.stimulus.voltage[k - 1];
          behind =
              before + (behind - before) * std::exp(-(d.stimulus.time[k] - d.stimulus.time[k - 1]) / lag);
        }
        return now - behind;
      });
      change.linear_only = true;
      all.push_back(std::move(change));
    }
    return all;
  }

  // Turns of the motor: what repeats with its angle, by the number of periods in a turn that explains most.
  Variable Turn(int periods) const {
    return Make("motor_angle, " + std::to_string(periods) + " periods a turn", "rad",
                [periods](const SmoothedRun& s, const RunData&, size_t k) {
                  return std::remainder(periods * s.motor_angle[k], 2 * M_PI);
                });
  }

 private:
  const std::vector<SmoothedRun>& smoothed_;
  const std::vector<const RunData*>& runs_;
};

struct Dependence {
  Variable variable;
  std::vector<double> averages;
  double explained = 0;
  size_t simplicity = 0;  // place in the list: the plain ones come first
};

// Ordered by what they explain.
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
  // Of those that explain nearly as much as the best, the simplest.
  const double best = ranked.front().explained;
  auto simplest = ranked.begin();
  for (auto d = ranked.begin(); d != ranked.end() && d->explained >= best - kPlainly; ++d) {
    if (d->simplicity < simplest->simplicity) simplest = d;
  }
  std::rotate(ranked.begin(), simplest, simplest + 1);
  return ranked;
}

// How much more of the energy lies near reversals of the motor than time does: text, or "".
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
  std::string where = "everywhere alike";
  if (ranked.front().explained > kDependence) {
    where = RangeOf(blocks, ranked.front().variable, ranked.front().averages);
  }
  const std::string reversals = AtReversals(blocks, runs);
  if (!reversals.empty()) where += ", " + reversals;
  return where;
}

// Against the variable that explains most, and against the next that explains something.
void Tabulate(const Blocks& blocks, const std::vector<Dependence>& ranked, size_t balance,
              std::vector<MissingTerm>* missing) {
  for (const Dependence& d : ranked) {
    if (missing->size() == 2 || (!missing->empty() && d.explained < kDependence)) break;
    MissingTerm table = TableOf(blocks, d.variable, d.averages);
    table.balance = kNames[balance];
    table.unit = kUnits[balance];
    missing->push_back(std::move(table));
  }
}

}  // namespace

Localisation Locate(const ModelDescription& model, const std::vector<const RunData*>& runs) {
  Localisation result;
  std::vector<SmoothedRun> smoothed = SmoothAll(model, runs, {});
  Found found = Weigh(smoothed, runs);
  if (found.total == 0) return result;
  const double all = found.total;

  // The sensors' share is what readings at rest take away.
  double sensor = 0;
  const PressureOffsets offsets = OffsetsOf(model, runs);
  if (offsets.p1 != 0 || offsets.p2 != 0) {
    std::vector<SmoothedRun> corrected = SmoothAll(model, runs, offsets);
    Found left = Weigh(corrected, runs);
    if (left.total < all) {
      sensor = 1 - left.total / all;
      char where[96];
      std::snprintf(where, sizeof where, "p1 reads %+.3g psi, p2 %+.3g psi at the valves' pressure",
                    offsets.p1, offsets.p2);
      const size_t largest = static_cast<size_t>(std::max_element(found.energy.begin(), found.energy.end()) -
                                                 found.energy.begin());
      result.location.push_back({"sensor", sensor, where, WindowsOf(found.blocks[largest], runs)});
      smoothed = std::move(corrected);
      found = std::move(left);
    }
  }

  const Signals signals(smoothed, runs);
  std::array<std::vector<Dependence>, kBalances> ranked;
  for (size_t b = 0; b < kBalances; ++b) {
    const double share = found.energy[b] / all;
    if (share < kSmallestShare) continue;
    const Balance balance = static_cast<Balance>(b);
    const Blocks& blocks = found.blocks[b];
    ranked[b] = Rank(blocks, signals.States(balance, blocks.duration < kQuick), smoothed, balance);
    double own = share;
    if (balance == Balance::kPumpTorque) {
      const std::vector<Dependence> commands = Rank(blocks, signals.Commands(), smoothed, balance);
      const double by_command = commands.front().explained;
      if (by_command > ranked[b].front().explained + kPlainly) {
        const double part = share * std::min(1.0, by_command);
        own -= part;
        if (own < part) ranked[b].insert(ranked[b].begin(), commands.front());
        result.location.push_back(
            {"command", part, WhereOf(blocks, {commands.front()}, runs), WindowsOf(blocks, runs)});
      }
    }
    if (own < kSmallestShare) continue;
    result.location.push_back({kNames[b], own, WhereOf(blocks, ranked[b], runs), WindowsOf(blocks, runs)});
  }
  std::stable_sort(result.location.begin(), result.location.end(),
                   [](const Location& a, const Location& b) { return a.share > b.share; });
  if (!result.location.empty() && result.location.front().balance != "sensor") {
    const size_t b = static_cast<size_t>(std::max_element(found.energy.begin(), found.energy.end()) -
                                         found.energy.begin());
    Tabulate(found.blocks[b], ranked[b], b, &result.missing);
  }
  return result;
}

}  // namespace hydro
