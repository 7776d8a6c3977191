#include "diagnose/data/contradictions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/data/interval_means.h"
#include "diagnose/data/recording_mistake.h"
#include "maths/median.h"
#include "runs/measured_signals.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLikeATurn = 0.05;   // relative
constexpr double kLikeAUnit = 0.05;   // relative
constexpr double kSmallStep = 1;      // rad: samples that follow a motion are nearer to each other
constexpr double kFollows = 0.9;      // correlation of a speed with the rate of its angle
constexpr double kOtherUnit = 1.5;    // ratio; no sensor's gain is as wrong as any unit
constexpr double kTakesTorque = 0.5;  // share that what is left of the flow through a bypass never takes

// Sums of a line through the origin.
struct Pairing {
  double xx = 0, xy = 0, yy = 0;
  void Add(double x, double y) {
    if (std::isnan(x) || std::isnan(y)) return;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  double correlation() const { return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 0; }
};

// How often the angle jumps by a turn and stays there; 0 where it moves so fast that a turn could be motion.
size_t JumpsByATurn(const std::vector<double>& angle) {
  std::vector<double> steps;
  for (size_t i = 1; i < angle.size(); ++i) {
    if (const double step = angle[i] - angle[i - 1]; !std::isnan(step)) steps.push_back(std::abs(step));
  }
  const double usual = steps.empty() ? kTurn : maths::Median(steps);
  if (usual > kSmallStep) return 0;
  // The motion goes on while it jumps.
  const double apart = std::max(kLikeATurn * kTurn, 2 * usual);
  size_t jumps = 0;
  for (size_t i = 1; i < angle.size(); ++i) {
    const double step = angle[i] - angle[i - 1];
    if (!(std::abs(std::abs(step) - kTurn) < apart)) continue;
    // A single wrong sample jumps back.
    const bool back = i + 1 < angle.size() && std::abs(angle[i + 1] - angle[i] + step) < 2 * apart;
    if (back) {
      ++i;
    } else {
      ++jumps;
    }
  }
  return jumps;
}

// "as degrees are to radians"
std::string LikeUnits(double ratio) {
  static constexpr struct {
    double ratio;
    const char* units;
  } kKnown[] = {{180 / std::numbers::pi, "degrees are to radians"},
                {kTurn, "radians are to turns"},
                {60 / kTurn, "rpm are to rad/s"},
                {360, "degrees are to turns"},
                {60, "minutes are to seconds"},
                {1000, "mm are to m"}};
  for (const auto& known : kKnown) {
    if (std::abs(std::max(ratio, 1 / ratio) / known.ratio - 1) < kLikeAUnit)
      return std::string(", as ") + known.units;
  }
  return "";
}

// Root mean square about the mean.
double Spread(const std::vector<double>& values) {
  double sum = 0, squares = 0, count = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    squares += value * value;
    ++count;
  }
  return count > 0 ? std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count))) : 0;
}

class ContradictionList {
 public:
  explicit ContradictionList(const Run& run) : run_(run), intervals_(run) {}

  void AddTurns(SignalOfRun angle) {
    if (!(run_.*angle).measured()) return;
    const size_t jumps = JumpsByATurn((run_.*angle).values);
    if (jumps == 0) return;
    wrapped_ = true;
    Add(std::string(NameOf(angle)) + " jumps by a turn, " + std::to_string(jumps) +
        (jumps == 1 ? " time" : " times") + ": it starts again after each; record it with the turns counted");
  }

  void AddRate(SignalOfRun angle, SignalOfRun speed) {
    if (wrapped_ || !(run_.*angle).measured() || !(run_.*speed).measured()) return;
    const std::vector<double> angles = intervals_.Means((run_.*angle).values),
                              speeds = intervals_.Means((run_.*speed).values);
    Pairing pairing;
    for (size_t i = 0; i + 1 < angles.size(); ++i) {
      const double rate = (angles[i + 1] - angles[i]) / (intervals_.times()[i + 1] - intervals_.times()[i]);
      pairing.Add(rate, (speeds[i] + speeds[i + 1]) / 2);
    }
    const double correlation = pairing.correlation();
    if (std::abs(correlation) < kFollows) return;
    const double ratio = std::sqrt(pairing.yy / pairing.xx);
    const std::string name = NameOf(speed), of = NameOf(angle);
    if (ratio > kOtherUnit || ratio < 1 / kOtherUnit) {
      Add(name + " is " + ShortNumber(ratio, 3) + " times the rate of " + of + LikeUnits(ratio) +
          ": one of the two, or the time, is in another unit than the sidecar says");
    } else if (correlation < 0) {
      Add(name + " falls where " + of + " rises: one of the two has the wrong sign", true);
    }
  }

  void AddBypass(const model::Parameters& model) {
    if (!run_.bypass || !run_.p1.measured() || !run_.p2.measured()) return;
    const std::vector<double> p1 = intervals_.Means(run_.p1.values), p2 = intervals_.Means(run_.p2.values),
                              command = intervals_.Means(run_.voltage.values);
    // With and against the torque, as the pump's inertia has it; a difference that never changes is that of the sensors.
    std::vector<double> torque, taken;
    for (size_t i = 0; i < p1.size(); ++i) {
      torque.push_back(std::clamp(model.k_1 * command[i], -model.T_pmax, model.T_pmax));
      taken.push_back(model.D * (p2[i] - p1[i]));
    }
    if (!(Spread(taken) > kTakesTorque * Spread(torque))) return;
    Add("bypass = true, but p2 - p1 takes the motor's torque: it was closed; this mends it: bypass = false");
  }

  std::vector<Contradiction> Take() { return std::move(list_); }

 private:
  void Add(const std::string& text, bool only_sign = false) {
    list_.push_back({RunNamed(run_.name) + ": " + text, only_sign});
  }

  const Run& run_;
  IntervalMeans intervals_;
  bool wrapped_ = false;
  std::vector<Contradiction> list_;
};

}  // namespace

std::vector<Contradiction> Contradictions(const model::ModelDescription& model, const Run& run) {
  ContradictionList list(run);
  list.AddTurns(&Run::motor_angle);
  if (!model.units.linear_arm) list.AddTurns(&Run::arm_angle);
  list.AddRate(&Run::motor_angle, &Run::motor_speed);
  list.AddRate(&Run::arm_angle, &Run::arm_speed);
  list.AddBypass(model.parameters);
  return list.Take();
}

}  // namespace hydro::diagnose
