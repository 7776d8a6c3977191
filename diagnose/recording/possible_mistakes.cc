#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/recording/recording_mistake.h"
#include "runs/measured/measured_run.h"
#include "runs/measured/sample_times.h"
#include "runs/measured/signal_columns.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

// Units in which newcomers record, as a sidecar names them. Units of another quantity than a signal's are
// skipped.
constexpr const char* kUnits[] = {"bar",   "mbar",  "kPa",  "MPa", "Pa",   "psi", "rpm", "deg/s",
                                  "rev/s", "rad/s", "deg",  "rev", "rad",  "mm",  "cm",  "m",
                                  "in",    "mm/s",  "cm/s", "m/s", "in/s", "mV",  "V"};
constexpr const char* kTimeUnits[] = {"ms", "us", "ns", "min", "s"};
constexpr double kShortestRun = 0.1;  // s
// Upper limits of the largest reading in a run in which something moves.
struct Possible {
  const char* unit;
  double least, most;
};
constexpr Possible kPossible[] = {
    {"Pa", 1e3, 3e8}, {"rad/s", 1e-3, 1e5}, {"m/s", 1e-7, 100}, {"rad", 1e-5, 1e9}, {"m", 1e-7, 100}};
constexpr double kSameScale = 1e-4;  // relative: scales are written with few digits

bool IsNear(double a, double b) { return std::abs(a - b) <= kSameScale * std::abs(b); }

// The signal's name in the run's sidecar.
std::string NameIn(const Run& run, SignalOfRun signal) { return runs::KeyIn(run, runs::RowOf(signal)); }

std::string NamesOf(const Run& run, const std::vector<SignalOfRun>& signals) {
  std::vector<std::string> names;
  names.reserve(signals.size());
  for (const SignalOfRun signal : signals) names.emplace_back(NameIn(run, signal));
  return Enumerated(names) + (names.size() > 1 ? " are" : " is");
}

// Those of the given signals that the run has.
std::vector<SignalOfRun> Measured(const Run& run, const std::vector<SignalOfRun>& signals) {
  std::vector<SignalOfRun> measured;
  for (const SignalOfRun signal : signals) {
    if ((run.*signal).measured()) measured.push_back(signal);
  }
  return measured;
}

// The signal's unit in the model.
std::string UnitOf(const Run& run, SignalOfRun signal) { return runs::UnitIn(run, runs::RowOf(signal)); }

// The stated unit of a column: the model's where nothing is stated; "" where its scale belongs to no unit.
template <size_t n>
std::string StatedUnit(const runs::ColumnSource& source, const std::string& ours,
                       const char* const (&units)[n]) {
  if (source.scale == 1) return ours;
  for (const char* unit : units) {
    const std::optional<double> factor = runs::UnitFactor(unit, ours);
    if (factor.has_value() && IsNear(source.scale, *factor)) return unit;
  }
  return "";
}

// The factor from a column in `unit` that is stated to be in `stated` to the model's unit; empty where both
// are the same.
std::optional<double> FactorBetween(const std::string& unit, const std::string& ours,
                                    const std::string& stated) {
  const std::optional<double> factor = runs::UnitFactor(unit, ours);
  if (!factor.has_value()) return std::nullopt;
  const double said = stated.empty() ? 1 : runs::UnitFactor(stated, ours).value_or(1);
  if (IsNear(*factor, said)) return std::nullopt;
  return *factor / said;
}

// If the values are counts of an integer of some size with the top bit set, which would be the sign bit of a
// signed integer, returns that size; otherwise 0.
int BitsOfUnsigned(const runs::MeasuredSignal& signal) {
  constexpr double kWhole = 1e-6;
  double largest = 0;
  for (const double value : signal.values) {
    if (std::isnan(value)) continue;
    const double counts = (value - signal.source.offset) / signal.source.scale;
    if (counts < 0 || std::abs(counts - std::round(counts)) > kWhole) return 0;
    largest = std::max(largest, counts);
  }
  for (const int bits : {8, 10, 12, 14, 16, 18, 20, 24, 32}) {
    if (largest < std::exp2(bits)) return largest >= std::exp2(bits - 1) ? bits : 0;
  }
  return 0;
}

std::string ShaftName(model::Shaft shaft) {
  for (const auto& [name, one] : runs::kShafts) {
    if (one == shaft) return name;
  }
  return "";
}

std::string NotIn(const std::string& stated, const std::string& ours) {
  return stated.empty() || stated == ours ? "" : ", not in " + stated;
}

class MistakeList {
 public:
  explicit MistakeList(const Run& run) : run_(run) {}

  void AddUnits(const std::vector<SignalOfRun>& signals) {
    const std::vector<SignalOfRun> measured = Measured(run_, signals);
    if (measured.size() < signals.size()) return;
    const std::string ours = UnitOf(run_, measured.front());
    const std::string stated = StatedUnit((run_.*measured.front()).source, ours, kUnits);
    for (const char* unit : kUnits) {
      const std::optional<double> factor = FactorBetween(unit, ours, stated);
      if (!factor.has_value() || !IsPlausible(measured, ours, *factor)) continue;
      RecordingMistake mistake;
      mistake.what = NamesOf(run_, measured) + " in " + unit + NotIn(stated, ours);
      // A reference has the pressures' unit. No simulation depends on it.
      for (const SignalOfRun signal : measured) mistake.factors.emplace_back(signal, *factor);
      mistake.unit = unit;
      list_.push_back(std::move(mistake));
    }
  }
  void AddTimes() {
    const std::string stated = StatedUnit(run_.time_source, "s", kTimeUnits);
    for (const char* unit : kTimeUnits) {
      const std::optional<double> factor = FactorBetween(unit, "s", stated);
      if (!factor.has_value() || !IsPlausibleTime(*factor)) continue;
      RecordingMistake mistake;
      mistake.what = std::string("time is in ") + unit + NotIn(stated, "s");
      mistake.time_factor = *factor;
      mistake.unit = unit;
      list_.push_back(std::move(mistake));
    }
  }
  void AddUnsigned(SignalOfRun signal) {
    const int bits = BitsOfUnsigned(run_.*signal);
    if (bits == 0) return;
    RecordingMistake mistake;
    const double counts = std::exp2(bits);
    mistake.what = NameIn(run_, signal) + " jumps by " + ShortNumber(counts, 10) +
                   " counts between values above 0 and below the top: a signed number read as unsigned (" +
                   std::to_string(bits) + " bits)";
    mistake.unsigned_signal = signal;
    mistake.span = counts * (run_.*signal).source.scale;
    list_.push_back(std::move(mistake));
  }
  void AddSign(const std::vector<SignalOfRun>& signals) {
    const std::vector<SignalOfRun> measured = Measured(run_, signals);
    if (measured.size() < signals.size()) return;
    RecordingMistake mistake;
    std::vector<std::string> names;
    for (const SignalOfRun signal : measured) {
      names.emplace_back(NameIn(run_, signal));
      mistake.factors.emplace_back(signal, -1.0);
    }
    mistake.what = Enumerated(names) + (names.size() > 1 ? " have" : " has") + " the wrong sign";
    list_.push_back(std::move(mistake));
  }
  void AddExchange() {
    if (!run_.p1.measured() || !run_.p2.measured() || run_.bypass) return;
    RecordingMistake mistake;
    mistake.what = "p1 and p2 are exchanged";
    mistake.pressures_exchanged = true;
    list_.push_back(std::move(mistake));
  }
  std::vector<RecordingMistake> Take() { return std::move(list_); }

 private:
  // A factor that makes a run last a tenth of a second or less is not plausible, unless the stated times are
  // not either because the samples are too far apart.
  bool IsPlausibleTime(double factor) const {
    const double seconds = run_.time.back() - run_.time.front();
    const double interval = seconds / static_cast<double>(run_.samples() - 1);
    return factor > 1 || factor * seconds > kShortestRun || interval > runs::kSlowestSamples;
  }
  // Whether a machine can produce the values that the signals would have. Where the stated values are already
  // as impossible, any change may correct them.
  bool IsPlausible(const std::vector<SignalOfRun>& signals, const std::string& ours, double factor) const {
    for (const Possible& one : kPossible) {
      const std::optional<double> size = runs::UnitFactor(ours, one.unit);
      if (!size.has_value()) continue;
      double largest = 0;
      for (const SignalOfRun signal : signals) {
        const maths::Range range = maths::RangeOf((run_.*signal).values);
        largest = std::max({largest, std::abs(range.low), std::abs(range.high)});
      }
      const double before = *size * largest, after = factor * before;
      const auto inside = [&](double value) { return value > one.least && value < one.most; };
      return inside(after) || !inside(before);
    }
    return true;
  }

  const Run& run_;
  std::vector<RecordingMistake> list_;
};

void AddSignals(const Run& run, MistakeList* list) {
  list->AddSign({&Run::voltage});
  list->AddExchange();
  list->AddSign({&Run::motor_speed});
  list->AddSign({&Run::motor_angle});
  list->AddSign({&Run::motor_speed, &Run::motor_angle});
  if (run.shaft != model::Shaft::kClamped) {
    list->AddSign({&Run::arm_angle});
    list->AddSign({&Run::arm_speed});
    list->AddSign({&Run::arm_angle, &Run::arm_speed});
    list->AddUnits({&Run::arm_angle});
    list->AddUnits({&Run::arm_speed});
  }
  if (!run.bypass) {
    list->AddSign({&Run::p1});
    list->AddSign({&Run::p2});
  }
  list->AddUnits({&Run::motor_speed});
  list->AddUnits({&Run::motor_angle});
  list->AddUnits({&Run::p1, &Run::p2});
  list->AddUnits({&Run::p1});
  list->AddUnits({&Run::p2});
  list->AddUnits({&Run::voltage});
}

}  // namespace

std::vector<RecordingMistake> PossibleMistakes(const Run& run) {
  MistakeList list(run);
  list.AddTimes();
  for (const SignalOfRun signal :
       Measured(run, {&Run::voltage, &Run::motor_speed, &Run::arm_speed, &Run::p1, &Run::p2}))
    list.AddUnsigned(signal);
  AddSignals(run, &list);
  return list.Take();
}

double ArmTravel(const Run& run, const model::Parameters& model) {
  if (!run.arm_angle.measured()) return 0;
  return model.c * maths::RangeOf(run.arm_angle.values).size() / model.V_ms;
}

std::vector<RecordingMistake> OtherShafts(const Run& run, const model::Parameters& parameters) {
  std::vector<RecordingMistake> others;
  for (const auto& [name, shaft] : runs::kShafts) {
    const bool possible = shaft != model::Shaft::kDriven && run.shaft != model::Shaft::kDriven;
    if (!possible || shaft == run.shaft || run.bypass) continue;
    if (shaft == model::Shaft::kClamped && ArmTravel(run, parameters) > kHeldArmMoves) continue;
    RecordingMistake mistake;
    mistake.what = "the shaft is " + name + ", not " + ShaftName(run.shaft);
    mistake.shaft = shaft;
    others.push_back(std::move(mistake));
  }
  return others;
}

RecordingMistake UnknownUnit(const std::vector<SignalOfRun>& signals, double factor) {
  RecordingMistake mistake;
  mistake.what = NamesOf(Run{}, signals) + " about " + ShortNumber(factor < 1 ? 1 / factor : factor, 2) +
                 " times too " + (factor < 1 ? "large" : "small") + "; no known unit";
  for (const SignalOfRun signal : signals) mistake.factors.emplace_back(signal, factor);
  return mistake;
}

}  // namespace hydro::diagnose
