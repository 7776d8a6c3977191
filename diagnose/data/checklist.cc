#include "diagnose/data/checklist.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/number_text.h"
#include "base/units.h"
#include "diagnose/data/interval_means.h"
#include "diagnose/data/run_data.h"
#include "runs/measured_signals.h"

namespace hydro::diagnose {
namespace {

using State = ChecklistLine::State;
using runs::MeasuredRun;
using runs::MeasuredSignal;

// A balance that holds correlates by 0.8 and more; one with a wrong sign by the same, negative.
constexpr double kClear = 0.5;
constexpr double kFarOff =
    6;  // standard deviations of the noise: the lowest of thousands of samples is nearer

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  size_t missing = 0;
};

Range RangeIn(const std::vector<double>& values) {
  Range range;
  for (const double value : values) {
    if (std::isnan(value)) {
      ++range.missing;
      continue;
    }
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

std::string Text(const Range& range, const std::string& unit) {
  std::string text = ShortNumber(range.low) + " to " + ShortNumber(range.high) + " " + unit;
  if (range.missing > 0) text += ", " + std::to_string(range.missing) + " missing";
  return text;
}

// Of the pairs in which both are known; nothing where too few are, or one is constant.
std::optional<double> Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double n = 0, sum_a = 0, sum_b = 0;
  const auto each = [&](auto&& use) {
    for (size_t i = 0; i < a.size(); ++i) {
      if (std::isfinite(a[i]) && std::isfinite(b[i])) use(a[i], b[i]);
    }
  };
  each([&](double x, double y) { ++n, sum_a += x, sum_b += y; });
  if (n < 10) return std::nullopt;
  double aa = 0, bb = 0, ab = 0;
  each([&](double x, double y) {
    const double u = x - sum_a / n, v = y - sum_b / n;
    aa += u * u, bb += v * v, ab += u * v;
  });
  if (aa == 0 || bb == 0) return std::nullopt;
  return ab / std::sqrt(aa * bb);
}

ChecklistLine SignLine(const std::string& item, const std::optional<double>& correlation,
                       const std::string& good, const std::string& turned) {
  if (!correlation.has_value()) return {State::kLook, item, "the run moves too little to tell"};
  const std::string number = " (correlation " + ShortNumber(*correlation, 2) + ")";
  if (*correlation > kClear) return {State::kGood, item, good + number};
  if (*correlation < -kClear) return {State::kLook, item, turned + number};
  return {State::kLook, item,
          "not clear from this run" + number + ": " + good + " where the model fits the rig"};
}

class RunChecklist {
 public:
  RunChecklist(const model::ModelDescription& model, const MeasuredRun& run, bool si)
      : p_(model.parameters), units_(model.units), si_(si), run_(run), intervals_(run) {}

  std::vector<ChecklistLine> Lines() {
    AddSamples();
    for (const runs::SignalName& name : runs::kSignals) AddSignal(name);
    AddPressures();
    AddShaft();
    AddTorqueSign();
    AddFlowSigns();
    return std::move(lines_);
  }

 private:
  void Add(State state, const std::string& item, const std::string& text) {
    lines_.push_back({state, item, text});
  }
  std::optional<SiUnit> InSi(const std::string& unit, double size) const {
    return si_ ? FindSiUnit(unit, size) : std::nullopt;
  }
  std::vector<double> MeansOf(const MeasuredSignal& signal) const { return intervals_.Means(signal.values); }

  void AddSamples() {
    const double seconds = run_.time.back() - run_.time.front();
    double longest = 0;
    for (size_t i = 1; i < run_.samples(); ++i) longest = std::max(longest, run_.time[i] - run_.time[i - 1]);
    const double interval = seconds / static_cast<double>(run_.samples() - 1);
    const bool even = longest < 1.5 * interval;
    Add(even ? State::kGood : State::kLook, "samples",
        std::to_string(run_.samples()) + " in " + ShortNumber(seconds) + " s, one each " +
            ShortNumber(1e3 * interval) + " ms" +
            (even ? "" : ", but once none for " + ShortNumber(1e3 * longest) + " ms"));
  }

  void AddSignal(const runs::SignalName& name) {
    const MeasuredSignal& signal = run_.*name.signal;
    if (!signal.measured()) {
      if (name.signal != &MeasuredRun::pressure_ref) Add(State::kAbsent, name.ours, "not recorded");
      return;
    }
    Range range = RangeIn(signal.values);
    std::string unit = units_.UnitFor(name.unit, name.arm);
    if (const auto shown = InSi(unit, std::max(std::abs(range.low), std::abs(range.high)))) {
      range = {range.low * shown->factor, range.high * shown->factor};
      unit = shown->to;
    }
    if (name.signal == &MeasuredRun::voltage) unit = "V (the command that k_1 takes)";
    const bool moves = range.high > range.low;
    Add(moves ? State::kGood : State::kLook, name.ours,
        Text(range, unit) + (moves ? "" : ": it never changes"));
  }

  // The lowest pressure of a closed circuit is its charge pressure, whatever moves.
  void AddPressures() {
    if (!run_.p1.measured() || !run_.p2.measured()) return;
    const double low1 = RangeIn(run_.p1.values).low, low2 = RangeIn(run_.p2.values).low;
    std::string unit = units_.UnitFor("psi");
    double factor = 1;
    if (const auto shown = InSi(unit, std::max({low1, low2, p_.p_3}))) {
      factor = shown->factor;
      unit = shown->to;
    }
    // The one-way valves keep both sides above it, but for their noise; gauges of a charge of 5 bar read a fifth less than it.
    const double low = std::min(low1, low2);
    const double noise = kFarOff * std::max(EstimateNoise(run_.p1.values), EstimateNoise(run_.p2.values));
    const bool near = low > 0.85 * p_.p_3 - noise && low < 3 * p_.p_3 + noise;
    const bool same = std::max(low1, low2) < 1.5 * low + noise;
    Add(near && same && !LooksLikeCurrents() ? State::kGood : State::kLook, "charge pressure",
        "the lowest p1 is " + ShortNumber(low1 * factor) + " " + unit + ", the lowest p2 " +
            ShortNumber(low2 * factor) + " " + unit + ", the model's p_3 is " + ShortNumber(p_.p_3 * factor) +
            " " + unit +
            (LooksLikeCurrents()
                 ? ": another unit, or currents of 4 to 20 mA that want a scale and an offset?"
             : !near ? ": another unit, gauge against absolute, or another charge?"
             : same  ? ""
                     : ": is one side under load all the time, or its sensor's scale another?"));
  }

  // The columns' own numbers, before any unit: sensors with a live zero that nobody scaled.
  bool LooksLikeCurrents() const {
    for (const MeasuredSignal* signal : {&run_.p1, &run_.p2}) {
      const Range range = RangeIn(signal->values);
      const double low = (range.low - signal->source.offset) / signal->source.scale,
                   high = (range.high - signal->source.offset) / signal->source.scale;
      if (!(low > 3.8 && low < 8 && high < 20.5)) return false;
    }
    return true;
  }

  void AddShaft() {
    if (!run_.arm_angle.measured() || run_.shaft == model::Shaft::kDriven) return;
    const Range range = RangeIn(run_.arm_angle.values);
    const double travel = p_.c * (range.high - range.low) / p_.V_ms;
    if (run_.shaft == model::Shaft::kClamped && travel > 0.02) {
      Add(State::kLook, "shaft",
          "clamped, as is said, but the arm moves by " + ShortNumber(range.high - range.low));
    } else if (run_.shaft == model::Shaft::kFree && travel < 1e-4) {
      Add(State::kLook, "shaft", "free, as is said, but the arm hardly moves");
    }
    const double reach = p_.c * std::max(std::abs(range.low), std::abs(range.high)) / p_.V_ms;
    if (reach >= 1)
      Add(State::kLook, "arm's travel",
          "c times the arm's angle exceeds V_ms: one side would have no volume");
  }

  void AddTorqueSign() {
    if (!run_.motor_speed.measured()) return;
    const bool pressures = run_.p1.measured() && run_.p2.measured() && !run_.bypass;
    const std::vector<double> command = MeansOf(run_.voltage), speed = MeansOf(run_.motor_speed);
    const std::vector<double> acceleration = intervals_.Rates(speed);
    std::vector<double> needed(command.size());
    const std::vector<double> p1 = pressures ? MeansOf(run_.p1) : std::vector<double>(command.size(), 0);
    const std::vector<double> p2 = pressures ? MeansOf(run_.p2) : p1;
    for (size_t i = 0; i < needed.size(); ++i) {
      const double friction = std::isnan(speed[i]) ? 0 : (speed[i] > 0) - (speed[i] < 0);
      needed[i] = p_.J * acceleration[i] + p_.b * speed[i] + p_.D * (p2[i] - p1[i]) + p_.T_s * friction;
    }
    std::vector<double> torque(command);
    for (double& value : torque) value = std::clamp(p_.k_1 * value, -p_.T_pmax, p_.T_pmax);
    Add("sign of the command", Correlation(torque, needed),
        pressures ? "a positive command turns the motor forward and raises p2 over p1"
                  : "a positive command turns the motor forward",
        pressures ? "a positive command goes with a falling speed or p2 - p1: turn its sign, the speed's, or "
                    "exchange p1 and p2"
                  : "a positive command goes with a falling speed: turn the sign of one of them");
  }

  void AddFlowSigns() {
    if (!run_.motor_speed.measured() || run_.bypass) return;
    const std::vector<double> speed = MeansOf(run_.motor_speed);
    const bool arm_moves = run_.shaft != model::Shaft::kClamped;
    if (arm_moves && (run_.arm_speed.measured() || run_.arm_angle.measured())) {
      const std::vector<double> arm =
          run_.arm_speed.measured() ? MeansOf(run_.arm_speed) : intervals_.Rates(MeansOf(run_.arm_angle));
      Add("sign of the arm", Correlation(speed, arm), "the arm moves up while the motor turns forward",
          "the arm moves down while the motor turns forward: turn the sign of one of them");
    } else if (!arm_moves && run_.p1.measured() && run_.p2.measured()) {
      std::vector<double> dp = MeansOf(run_.p2);
      const std::vector<double> p1 = MeansOf(run_.p1);
      for (size_t i = 0; i < dp.size(); ++i) dp[i] -= p1[i];
      Add("sign of the pressures", Correlation(speed, intervals_.Rates(dp)),
          "p2 - p1 rises while the motor turns forward",
          "p2 - p1 falls while the motor turns forward: exchange p1 and p2, or turn the sign of the speed");
    }
  }

  void Add(const std::string& item, const std::optional<double>& correlation, const std::string& good,
           const std::string& turned) {
    lines_.push_back(SignLine(item, correlation, good, turned));
  }

  const model::Parameters& p_;
  const UnitSystem& units_;
  bool si_;
  const MeasuredRun& run_;
  IntervalMeans intervals_;
  std::vector<ChecklistLine> lines_;
};

}  // namespace

std::vector<ChecklistLine> Checklist(const model::ModelDescription& model, const MeasuredRun& run, bool si) {
  return RunChecklist(model, run, si).Lines();
}

std::string Written(const ChecklistLine& line) {
  const char* const states[] = {"ok", "look", "absent"};
  std::string text = states[static_cast<int>(line.state)];
  text.resize(8, ' ');
  text += line.item;
  text.resize(std::max<size_t>(text.size() + 1, 31), ' ');
  return text + line.text;
}

}  // namespace hydro::diagnose
