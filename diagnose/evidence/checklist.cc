#include "diagnose/evidence/checklist.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/units.h"
#include "diagnose/evidence/run_mistakes.h"
#include "diagnose/recording/contradictions.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/recording/sparse_columns.h"
#include "diagnose/recording/vacuum.h"
#include "model/sides.h"
#include "runs/measured/measured_run.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using State = ChecklistLine::State;
using runs::MeasuredRun;
using runs::MeasuredSignal;

// Standard deviations of the noise, beyond the lowest of thousands of samples.
constexpr double kBelowLowest = 6;

using maths::Range;
using maths::RangeOf;

std::string Text(const Range& range, const std::string& unit, size_t missing) {
  std::string text = ShortNumber(range.low) + " to " + ShortNumber(range.high) + " " + unit;
  if (missing > 0) text += ", " + std::to_string(missing) + " missing";
  return text;
}

size_t MissingIn(const std::vector<double>& values) {
  return static_cast<size_t>(std::ranges::count_if(values, [](double value) { return std::isnan(value); }));
}

class RunChecklist {
 public:
  RunChecklist(const model::ModelDescription& model, const MeasuredRun& run, bool si)
      : model_(model), p_(model.parameters), units_(model.units), si_(si), run_(run), mistakes_(model, run) {}

  std::vector<ChecklistLine> Lines() {
    AddSamples();
    for (const runs::SignalName& name : runs::kSignals) AddSignal(name);
    AddPressures();
    AddShaft();
    AddSigns();
    return std::move(lines_);
  }

 private:
  void Add(State state, const std::string& item, const std::string& text) {
    lines_.push_back({state, item, text});
  }
  std::optional<SiUnit> InSi(const std::string& unit, double size) const {
    return si_ ? FindSiUnit(unit, size) : std::nullopt;
  }

  void AddSamples() {
    const double seconds = run_.time.back() - run_.time.front();
    double longest = 0;
    for (size_t i = 1; i < run_.samples(); ++i) longest = std::max(longest, run_.time[i] - run_.time[i - 1]);
    const double interval = seconds / static_cast<double>(run_.samples() - 1);
    const bool even = longest < 1.5 * interval;
    const bool slow = interval > runs::kSlowestSamples, fast = interval < runs::kFastestSamples;
    Add(even && !slow && !fast ? State::kGood : State::kLook, "samples",
        std::to_string(run_.samples()) + " in " + ShortNumber(seconds) + " s, one each " +
            ShortNumber(1e3 * interval) + " ms" +
            (even ? "" : ", but once none for " + ShortNumber(1e3 * longest) + " ms") +
            (slow ? ": too slow for such a machine" : "") +
            (fast ? ": faster than any recorder of such a machine" : "") +
            runs::TimeUnitHint(interval, run_.time_source.scale));
  }

  void AddSignal(const runs::SignalName& name) {
    const MeasuredSignal& signal = run_.*name.signal;
    if (!signal.measured()) {
      // Signals that few machines record are not reported as missing.
      if (name.signal != &MeasuredRun::pressure_ref && name.exported != nullptr)
        Add(State::kAbsent, name.ours, "not recorded");
      return;
    }
    Range range = RangeOf(signal.values);
    std::string unit = units_.UnitFor(name.unit, name.arm);
    double factor = 1;
    if (const auto shown = InSi(unit, std::max(std::abs(range.low), std::abs(range.high)))) {
      factor = shown->factor;
      range = {range.low * factor, range.high * factor};
      unit = shown->to;
    }
    const bool command = name.signal == &MeasuredRun::voltage;
    if (command) unit = runs::UnitIn(run_, name) + " (the command that k_1 takes)";
    const std::string doubt = DoubtOf(name, factor, unit);
    Add(doubt.empty() ? State::kGood : State::kLook, runs::KeyIn(run_, name),
        Text(range, unit, MissingIn(command ? run_.written_commands : signal.values)) + doubt);
  }

  // What is worth a look in a signal; "": nothing. The text has what is `factor` times the signal, in `unit`.
  std::string DoubtOf(const runs::SignalName& name, double factor, const std::string& unit) const {
    const MeasuredSignal& signal = run_.*name.signal;
    const Range range = RangeOf(signal.values);
    // A valve's state is that of a whole run.
    const bool may_rest = range.high > range.low || name.signal == &MeasuredRun::bypass_valve;
    std::string doubt = may_rest ? "" : ": it never changes";
    if (name.signal == &MeasuredRun::p1 || name.signal == &MeasuredRun::p2) {
      const std::optional<BelowVacuum> below = FindBelowVacuum(model_, signal);
      if (below) doubt = "; " + diagnose::Text(*below, factor, unit);
    }
    const Range& oil = kOilTemperatures;
    if (name.signal == &MeasuredRun::temperature && (range.low < oil.low || range.high > oil.high))
      doubt = ": no oil is as cold or as hot";
    const std::string uneven = name.signal == &MeasuredRun::voltage ? UnevenCommands(run_)
                               : name.standard_deviation != nullptr
                                   ? UnevenlyMissing(run_.time, signal.values, kSlowerSensor)
                                   : "";
    if (!uneven.empty()) doubt += (doubt.empty() ? ": " : "; ") + uneven;
    return doubt;
  }

  // The lowest pressure of a closed circuit is its charge pressure, whatever moves.
  void AddPressures() {
    if (!run_.p1.measured() || !run_.p2.measured()) return;
    const double low1 = RangeOf(run_.p1.values).low, low2 = RangeOf(run_.p2.values).low;
    std::string unit = units_.UnitFor("psi");
    double factor = 1;
    if (const auto shown = InSi(unit, std::max({low1, low2, p_.p_3}))) {
      factor = shown->factor;
      unit = shown->to;
    }
    const ChargeFit fit = FitOf(low1, low2, 1, 1);
    // Values of 4 to 20 bar that fit the model are pressures.
    const bool currents = !fit.good() && LooksLikeCurrents();
    const std::string in_unit = fit.good() ? "" : UnitThatFits(low1, low2);
    Add(fit.good() ? State::kGood : State::kLook, "charge pressure",
        "the lowest p1 is " + ShortNumber(low1 * factor) + " " + unit + ", the lowest p2 " +
            ShortNumber(low2 * factor) + " " + unit + ", the model's p_3 is " + ShortNumber(p_.p_3 * factor) +
            " " + unit +
            (fit.good() ? ""
             : currents ? ": " + (in_unit.empty() ? "another unit" : in_unit) +
                              ", or currents of 4 to 20 mA that want a scale and an offset?"
             : !in_unit.empty() ? ": " + in_unit + "?"
             : !fit.near        ? ": another unit, gauge against absolute, or another charge?"
                                : ": is one side under load all the time, or its sensor's scale another?"));
  }

  // How well the lowest pressures agree with the model's charge pressure.
  struct ChargeFit {
    bool near = false, same = false;
    bool good() const { return near && same; }
  };

  // Except for their noise, the one-way valves keep both sides above the charge pressure. Gauges of a charge
  // of 5 bar read a fifth less than that. The factors convert each pressure from another unit.
  ChargeFit FitOf(double low1, double low2, double factor1, double factor2) const {
    const double first = low1 * factor1, second = low2 * factor2, low = std::min(first, second);
    const double noise = kBelowLowest * std::max(factor1 * EstimateNoise(run_.p1.values),
                                                 factor2 * EstimateNoise(run_.p2.values));
    return {.near = low > 0.85 * p_.p_3 - ValveDrop() - noise && low < 3 * p_.p_3 + noise,
            .same = std::max(first, second) < 1.5 * low + SteadyLoad() + noise};
  }

  // How far a side falls below the charge pressure until the valve that feeds it is wide open.
  double ValveDrop() const {
    double drop = 0;
    for (const model::EffectDescription& effect : model_.effects) {
      if (effect.id != "valve.check" && effect.id != "valve.pilot_check") continue;
      for (const model::ParameterInfo& number : model::FindEffect(effect)->parameters) {
        if (number.name == "cracking" || number.name == "range") drop += NumberOf(effect, number, p_);
      }
    }
    return drop;
  }

  // By how much the weight along the path of a linear arm keeps one side above the other at all times.
  double SteadyLoad() const { return units_.linear_arm ? std::abs(p_.mgl) / p_.k_2 : 0; }

  // "p1 and p2 are in mbar, not in bar": of all units that a sidecar can name, the one in which the pressures
  // agree best with the charge pressure. "" where there is none. Unlike the balances, this needs no motion.
  std::string UnitThatFits(double low1, double low2) const {
    std::string best;
    double nearest = std::numeric_limits<double>::infinity();
    for (const RecordingMistake& mistake : PossibleMistakes(run_)) {
      double factor1 = 1, factor2 = 1;
      bool other = mistake.unit.empty() || mistake.factors.empty();
      for (const auto& [signal, factor] : mistake.factors) {
        other = other || (signal != &MeasuredRun::p1 && signal != &MeasuredRun::p2);
        (signal == &MeasuredRun::p1 ? factor1 : factor2) = factor;
      }
      if (other || !FitOf(low1, low2, factor1, factor2).good()) continue;
      const double away = std::abs(std::log(std::min(low1 * factor1, low2 * factor2) / p_.p_3));
      if (away < nearest) {
        nearest = away;
        best = mistake.what;
      }
    }
    return best;
  }

  // Looks at the columns' own numbers, before any unit: sensors with a live zero that nobody scaled.
  bool LooksLikeCurrents() const {
    for (const MeasuredSignal* signal : {&run_.p1, &run_.p2}) {
      const Range range = RangeOf(signal->values);
      const double low = (range.low - signal->source.offset) / signal->source.scale,
                   high = (range.high - signal->source.offset) / signal->source.scale;
      if (!(low > 3.8 && low < 8 && high < 20.5)) return false;
    }
    return true;
  }

  void AddShaft() {
    if (!run_.arm_angle.measured() || run_.shaft == model::Shaft::kDriven) return;
    const Range range = RangeOf(run_.arm_angle.values);
    const double travel = ArmTravel(run_, p_);
    if (run_.shaft == model::Shaft::kClamped && travel > kHeldArmMoves) {
      Add(State::kLook, "shaft",
          "clamped, as is said, but the arm moves by " + ShortNumber(range.high - range.low));
    } else if (run_.shaft == model::Shaft::kFree && travel < 1e-4) {
      Add(State::kLook, "shaft", "free, as is said, but the arm hardly moves");
    }
    const model::Travel allowed = model::TravelOf(model_);
    if (range.low <= allowed.least || range.high >= allowed.most)
      Add(State::kLook, "arm's travel",
          "beyond the model's " + ShortNumber(allowed.least) + " to " + ShortNumber(allowed.most) +
              ": one side would have no volume");
  }

  using IsMistake = std::function<bool(const RecordingMistake&)>;

  // How much better the balances close with a mistake undone; nothing where the mistake is not possible.
  std::optional<double> GainOf(const IsMistake& is_mistake) const {
    const std::vector<RecordingMistake> possible = PossibleMistakes(run_);
    const auto mistake = std::ranges::find_if(possible, is_mistake);
    if (mistake == possible.end()) return std::nullopt;
    return mistakes_.Try({*mistake}).gain;
  }

  // `turned` is the text for balances that close far better with these mistakes undone. If they close far
  // worse, the sign is good.
  void AddSign(const std::string& item, const IsMistake& is_mistake, const std::string& good,
               const std::string& turned) {
    const std::optional<double> gain = GainOf(is_mistake);
    if (!gain.has_value()) return;
    const std::string number = " (log odds " + ShortNumber(*gain, 2) + ")";
    if (std::abs(*gain) < ClearGain()) {
      Add(State::kLook, item,
          *gain != 0          ? "not clear from this run" + number
          : mistakes_.moves() ? "what was recorded of the run does not suffice to tell"
                              : "the run moves too little to tell");
    } else {
      Add(*gain < 0 ? State::kGood : State::kLook, item, (*gain < 0 ? good : turned) + number);
    }
  }
  static bool IsSignOf(const RecordingMistake& mistake, SignalOfRun signal) {
    return mistake.IsSign() && mistake.factors.size() == 1 && mistake.factors[0].first == signal;
  }

  void AddSigns() {
    if (!run_.motor_speed.measured()) return;
    const bool pressures = run_.p1.measured() && run_.p2.measured() && !run_.bypass;
    const IsMistake are_exchanged = [](const RecordingMistake& one) { return one.pressures_exchanged; };
    const double exchanged = GainOf(are_exchanged).value_or(0);
    AddSign(
        "sign of the command",
        [](const RecordingMistake& one) { return IsSignOf(one, &MeasuredRun::voltage); },
        pressures && exchanged < -ClearGain()
            ? "a positive command turns the motor forward and raises p2 over p1"
            : "a positive command turns the motor forward",
        pressures ? "a positive command goes with a falling speed or p2 - p1: turn its sign, the speed's, or "
                    "exchange p1 and p2"
                  : "a positive command goes with a falling speed: turn the sign of one of them");
    if (run_.bypass) return;
    const bool clamped = run_.shaft == model::Shaft::kClamped;
    if (pressures && (clamped || exchanged > ClearGain())) {
      AddSign("sign of the pressures", are_exchanged, "p2 - p1 rises while the motor turns forward",
              std::string(clamped ? "p2 - p1 falls while the motor turns forward"
                                  : "p1 and p2 go far better with the motor the other way round") +
                  ": exchange p1 and p2, or turn the sign of the speed");
    }
    const SignalOfRun arm = run_.arm_angle.measured() ? &MeasuredRun::arm_angle : &MeasuredRun::arm_speed;
    AddSign(
        "sign of the arm", [arm](const RecordingMistake& one) { return IsSignOf(one, arm); },
        "the arm moves up while the motor turns forward",
        "the arm moves down while the motor turns forward: turn the sign of one of them");
  }

  const model::ModelDescription& model_;
  const model::Parameters& p_;
  const UnitSystem& units_;
  bool si_;
  const MeasuredRun& run_;
  RunMistakes mistakes_;
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
