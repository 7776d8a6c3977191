#include "diagnose/data/recording_mistake.h"

#include <cmath>
#include <numbers>

#include "base/number_text.h"
#include "base/units.h"
#include "base/word_list.h"
#include "runs/measured_signals.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

constexpr double kPi = std::numbers::pi;
constexpr double kBar = 1e5 / kPsi;  // psi

// A unit in which a column may have been recorded, and what brings it to ours.
struct UnitFactor {
  double factor;
  const char* recorded;  // in words; "" for a factor without a name
  const char* unit;      // as a sidecar's line names it; "" if it cannot
};

constexpr UnitFactor kPressureUnits[] = {{kBar, "bar", "bar"},
                                         {kBar / 100, "kPa", "kPa"},
                                         {kBar * 10, "MPa", "MPa"},
                                         {kBar / 1e5, "Pa", "Pa"},
                                         {1 / kBar, "", ""},
                                         {100 / kBar, "", ""},
                                         {0.1 / kBar, "", ""},
                                         {1e5 / kBar, "", ""},
                                         {1e3, "", ""},
                                         {1e-3, "", ""},
                                         {1e5, "", ""},
                                         {1e-5, "", ""},
                                         {1e6, "", ""},
                                         {1e-6, "", ""}};
constexpr UnitFactor kSpeedUnits[] = {{kRpm, "rpm", "rpm"},   {kDegree, "deg/s", "deg/s"},
                                      {2 * kPi, "rev/s", ""}, {1 / kRpm, "", ""},
                                      {1 / kDegree, "", ""},  {0.5 / kPi, "", ""}};
constexpr UnitFactor kAngleUnits[] = {
    {kDegree, "deg", "deg"}, {2 * kPi, "revolutions", ""}, {1 / kDegree, "", ""}, {0.5 / kPi, "", ""}};
constexpr UnitFactor kCommandUnits[] = {{1e-3, "mV", ""}, {1e3, "kV", ""}};
constexpr UnitFactor kTimeUnits[] = {{1e-3, "ms", "ms"}, {1e-6, "us", "us"}, {60, "min", "min"}};

const char* NameOf(SignalOfRun signal) {
  for (const runs::SignalName& one : runs::kSignals) {
    if (one.signal == signal) return one.ours;
  }
  return "";
}

std::string NamesOf(const std::vector<SignalOfRun>& signals) {
  std::vector<std::string> names;
  names.reserve(signals.size());
  for (const SignalOfRun signal : signals) names.emplace_back(NameOf(signal));
  return Enumerated(names) + (names.size() > 1 ? " are" : " is");
}

// The signals of these that the run has.
std::vector<SignalOfRun> Measured(const Run& run, const std::vector<SignalOfRun>& signals) {
  std::vector<SignalOfRun> measured;
  for (const SignalOfRun signal : signals) {
    if ((run.*signal).measured()) measured.push_back(signal);
  }
  return measured;
}

class MistakeList {
 public:
  explicit MistakeList(const Run& run) : run_(run) {}

  template <size_t n>
  void AddUnits(const std::vector<SignalOfRun>& signals, const UnitFactor (&units)[n]) {
    const std::vector<SignalOfRun> measured = Measured(run_, signals);
    if (measured.empty()) return;
    for (const UnitFactor& unit : units) {
      RecordingMistake mistake;
      mistake.what = NamesOf(measured) + (*unit.recorded != '\0' ? std::string(" in ") + unit.recorded
                                                                 : " in another unit, off by a factor of " +
                                                                       ShortNumber(unit.factor, 4));
      for (const SignalOfRun signal : measured) mistake.factors.emplace_back(signal, unit.factor);
      // A reference is in the unit of the pressures; no simulation depends on it.
      mistake.unit = unit.unit;
      list_.push_back(std::move(mistake));
    }
  }
  void AddTimes() {
    for (const UnitFactor& unit : kTimeUnits) {
      RecordingMistake mistake;
      mistake.what = std::string("time is in ") + unit.recorded;
      mistake.time_factor = unit.factor;
      mistake.unit = unit.unit;
      list_.push_back(std::move(mistake));
    }
  }
  void AddSign(const std::vector<SignalOfRun>& signals) {
    const std::vector<SignalOfRun> measured = Measured(run_, signals);
    if (measured.size() < signals.size()) return;
    RecordingMistake mistake;
    std::vector<std::string> names;
    for (const SignalOfRun signal : measured) {
      names.emplace_back(NameOf(signal));
      mistake.factors.emplace_back(signal, -1.0);
    }
    mistake.what = Enumerated(names) + (names.size() > 1 ? " have" : " has") + " the wrong sign";
    list_.push_back(std::move(mistake));
  }
  // With the voltage's sign or without.
  void AddExchange(bool voltage) {
    if (!run_.p1.measured() || !run_.p2.measured() || run_.bypass) return;
    RecordingMistake mistake;
    mistake.what = "p1 and p2 are exchanged";
    if (voltage) {
      mistake.what += " and voltage has the wrong sign";
      mistake.factors.emplace_back(&Run::voltage, -1.0);
    }
    mistake.pressures_exchanged = true;
    list_.push_back(std::move(mistake));
  }
  std::vector<RecordingMistake> Take() { return std::move(list_); }

 private:
  const Run& run_;
  std::vector<RecordingMistake> list_;
};

void Multiply(double factor, runs::MeasuredSignal* signal) {
  for (double& value : signal->values) value *= factor;
  if (signal->noise.has_value()) *signal->noise *= std::abs(factor);
  signal->source.scale *= factor;
  signal->source.offset *= factor;
}

std::string SidecarLine(const std::string& name, const runs::ColumnSource& before,
                        const runs::ColumnSource& after, const std::string& column, const std::string& unit) {
  std::string line = name + " = { column = \"" + column + "\"";
  // A unit says it best, if nothing else is said of the column.
  const bool plain = before.column == after.column && before.scale == 1 && before.offset == 0;
  if (plain && !unit.empty()) {
    line += ", unit = \"" + unit + "\"";
  } else {
    if (after.scale != 1) line += ", scale = " + ShortNumber(after.scale, 8);
    if (after.offset != 0) line += ", offset = " + ShortNumber(after.offset, 8);
  }
  if (after.delay != 0) line += ", delay = " + ShortestNumber(after.delay);
  return line + " }";
}

bool Same(const runs::ColumnSource& a, const runs::ColumnSource& b) {
  return a.column == b.column && a.scale == b.scale && a.offset == b.offset;
}

// The unit that alone is wrong with a signal (null: the times); "" if there is none or more is wrong.
std::string UnitOf(const std::vector<RecordingMistake>& mistakes, const SignalOfRun* signal) {
  std::string unit;
  int concerned = 0;
  for (const RecordingMistake& mistake : mistakes) {
    bool concerns = signal == nullptr ? mistake.time_factor != 1 : false;
    for (const auto& [of, factor] : mistake.factors)
      concerns = concerns || (signal != nullptr && of == *signal);
    if (!concerns) continue;
    ++concerned;
    unit = mistake.unit;
  }
  return concerned == 1 ? unit : "";
}

}  // namespace

std::string RecordingMistake::InvertedSensor() const {
  const bool sensor = factors.size() == 1 && factors[0].second == -1 && factors[0].first != &Run::voltage;
  return sensor && !pressures_exchanged && time_factor == 1 ? NameOf(factors[0].first) : "";
}

std::vector<RecordingMistake> PossibleMistakes(const Run& run) {
  MistakeList list(run);
  list.AddTimes();
  list.AddSign({&Run::voltage});
  list.AddExchange(false);
  list.AddSign({&Run::motor_speed});
  list.AddSign({&Run::motor_angle});
  list.AddSign({&Run::motor_speed, &Run::motor_angle});
  list.AddExchange(true);
  if (run.shaft != model::Shaft::kClamped) {
    list.AddSign({&Run::arm_angle});
    list.AddSign({&Run::arm_speed});
    list.AddSign({&Run::arm_angle, &Run::arm_speed});
    list.AddUnits({&Run::arm_angle}, kAngleUnits);
    list.AddUnits({&Run::arm_speed}, kSpeedUnits);
  }
  list.AddUnits({&Run::motor_speed}, kSpeedUnits);
  list.AddUnits({&Run::motor_angle}, kAngleUnits);
  list.AddUnits({&Run::p1, &Run::p2}, kPressureUnits);
  list.AddUnits({&Run::voltage}, kCommandUnits);
  return list.Take();
}

void Correct(const RecordingMistake& mistake, Run* run) {
  for (double& time : run->time) time *= mistake.time_factor;
  if (run->begun.has_value()) *run->begun *= mistake.time_factor;
  run->time_source.scale *= mistake.time_factor;
  run->time_source.offset *= mistake.time_factor;
  for (const auto& [signal, factor] : mistake.factors) Multiply(factor, &(run->*signal));
  if (mistake.pressures_exchanged) std::swap(run->p1, run->p2);
}

std::string SidecarLines(const std::vector<RecordingMistake>& mistakes, const Run& run) {
  // Only what the sidecar says of the columns matters here.
  Run before;
  before.time_source = run.time_source;
  for (const runs::SignalName& one : runs::kSignals) {
    (before.*one.signal).source = (run.*one.signal).source;
    if ((before.*one.signal).source.column.empty()) (before.*one.signal).source.column = one.exported;
  }
  if (before.time_source.column.empty()) before.time_source.column = "time_s";
  Run after = before;
  for (const RecordingMistake& mistake : mistakes) Correct(mistake, &after);
  std::vector<std::string> lines;
  const auto add = [&](const char* name, const runs::ColumnSource& from, const runs::ColumnSource& to,
                       const SignalOfRun* signal) {
    if (Same(from, to)) return;
    lines.push_back(SidecarLine(name, from, to, to.column, UnitOf(mistakes, signal)));
  };
  add("time", before.time_source, after.time_source, nullptr);
  for (const runs::SignalName& one : runs::kSignals) {
    add(one.ours, (before.*one.signal).source, (after.*one.signal).source, &one.signal);
  }
  return Joined(lines, "; ");
}

}  // namespace hydro::diagnose
