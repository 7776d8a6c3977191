#include "write.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "recording.h"

namespace foreign_rig {

namespace {

constexpr double kPi = 3.14159265358979323846;

std::string Text(double value, const char* format = "%.10g") {
  if (!std::isfinite(value)) return "";
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
// JSON and TOML: numbers that are none become null; floats keep a point.
std::string Number(double value) { return std::isfinite(value) ? Text(value, "%.6g") : "null"; }
std::string Float(double value) {
  const std::string text = Text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}
std::string Quoted(const std::string& text) { return "\"" + text + "\""; }

std::ofstream Open(const std::string& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file);
  return out;
}

void WriteModel(const Values& given, const std::string& file) {
  std::ofstream out = Open(file);
  out << "# The rig as its makers describe it. Units: in, lbf, s, psi, rad, V.\nname = \"test "
         "rig\"\n\n[parameters]\n";
  for (const ValueForm& form : ValueForms()) out << form.name << " = " << Float(given.*form.value) << "\n";
}

// What a newcomer's table has instead of our units.
struct Units {
  double time = 1, voltage = 1, speed = 1, arm = 1, pressure = 1;
  bool exchanged = false;
};
Units UnitsOf(const Mistake& mistake) {
  Units u;
  if (mistake.what == "voltage sign") u.voltage = -1;
  if (mistake.what == "p1 and p2 exchanged") u.exchanged = true;
  if (mistake.what == "bar") u.pressure = 1 / 14.5037738;
  if (mistake.what == "kPa") u.pressure = 6.89475729;
  if (mistake.what == "MPa") u.pressure = 6.89475729e-3;
  if (mistake.what == "rpm") u.speed = 30 / kPi;
  if (mistake.what == "deg") u.arm = 180 / kPi;
  if (mistake.what == "ms") u.time = 1000;
  return u;
}

// The recorder loses ten rows across the largest step of the voltage, and repeats what it had.
void DropAcrossStep(std::vector<Row>* rows) {
  size_t at = 20;
  double largest = 0;
  for (size_t i = 20; i + 20 < rows->size(); ++i) {
    const double step = std::abs((*rows)[i].volts - (*rows)[i - 1].volts);
    if (step > largest) {
      largest = step;
      at = i;
    }
  }
  for (size_t i = at - 4; i < at + 6; ++i) {
    (*rows)[i].volts = (*rows)[at - 5].volts;
    (*rows)[i].sample = (*rows)[at - 5].sample;
  }
}

void WriteTable(const std::vector<Row>& rows, const Plan& plan, const Recorder& recorder, const Units& units,
                const std::string& file) {
  std::ofstream out = Open(file);
  const bool arm = !plan.day.clamped;
  out << "time,command" << (recorder.motor_speed ? ",speed" : "") << (recorder.motor_angle ? ",shaft" : "")
      << ",p_a,p_b" << (arm ? ",arm" : "") << "\n";
  for (const Row& row : rows) {
    const Sample& s = row.sample;
    const double a = s[units.exchanged ? kSide2 : kSide1];
    const double b = s[units.exchanged ? kSide1 : kSide2];
    out << Text(row.time * units.time) << ',' << Text(row.volts * units.voltage);
    if (recorder.motor_speed) out << ',' << Text(s[kSpeed] * units.speed, "%.8g");
    if (recorder.motor_angle) out << ',' << Text(s[kShaft], "%.10g");
    out << ',' << Text(a * units.pressure, "%.8g") << ',' << Text(b * units.pressure, "%.8g");
    if (arm) out << ',' << Text(s[kArmAngle] * units.arm, "%.9g");
    out << '\n';
  }
}

void WriteSidecar(const Plan& plan, const Recorder& recorder, const std::string& file) {
  std::ofstream out = Open(file);
  out << "name = " << Quoted(plan.name) << "\nshaft = " << (plan.day.clamped ? "\"clamped\"" : "\"free\"")
      << "\n";
  if (plan.day.clamped)
    out << "arm_angle_rad = " << Float(std::round(plan.day.arm_angle * 1e4) / 1e4) << "\n";
  out << "bypass = " << (plan.day.bypass ? "true" : "false")
      << "\n\n[columns]\ntime = \"time\"\nvoltage = \"command\"\n";
  if (recorder.motor_speed) out << "motor_speed = \"speed\"\n";
  if (recorder.motor_angle) out << "motor_angle = \"shaft\"\n";
  out << "p1 = \"p_a\"\np2 = \"p_b\"\n";
  if (!plan.day.clamped) out << "arm_angle = \"arm\"\n";
}

}  // namespace

void WriteRuns(const Case& c, const Solved& solved, const Options& options, const std::string& folder) {
  std::filesystem::create_directories(folder);
  WriteModel(solved.given, folder + "/model.toml");
  const Units units = UnitsOf(solved.mistake);
  for (size_t i = 0; i < solved.plans.size(); ++i) {
    const Plan& plan = solved.plans[i];
    std::vector<Row> rows = Record(solved.rig, plan, solved.recorder, options.seconds, c.seed * 1009 + i);
    if (solved.mistake.what == "dropout") DropAcrossStep(&rows);
    WriteTable(rows, plan, solved.recorder, units, folder + "/" + plan.name + ".csv");
    WriteSidecar(plan, solved.recorder, folder + "/" + plan.name + ".toml");
  }
}

namespace {

void WriteEffects(const std::vector<Truth>& effects, std::ofstream& out) {
  out << ",\n \"effects\": [";
  for (size_t i = 0; i < effects.size(); ++i) {
    const Truth& effect = effects[i];
    out << (i > 0 ? ",\n  " : "") << "{\"id\": " << Quoted(effect.id)
        << ", \"form\": " << Quoted(FindEffect(effect.id).form) << ", \"parameters\": {";
    for (size_t k = 0; k < effect.parameters.size(); ++k) {
      out << (k > 0 ? ", " : "") << Quoted(effect.parameters[k].first) << ": "
          << Number(effect.parameters[k].second);
    }
    out << "}" << (effect.signal.empty() ? "" : ", \"signal\": " + Quoted(effect.signal)) << "}";
  }
  out << "]";
}

void WriteValues(const Solved& s, std::ofstream& out) {
  out << ",\n \"parameters\": [";
  bool first = true;
  for (const ValueForm& form : ValueForms()) {
    if (s.rig.values.*form.value == 0) continue;
    out << (first ? "" : ",\n  ") << "{\"name\": " << Quoted(form.name)
        << ", \"true\": " << Number(s.rig.values.*form.value)
        << ", \"model\": " << Number(s.given.*form.value) << "}";
    first = false;
  }
  out << "],\n \"per_run\": [";
  for (size_t i = 0; i < s.plans.size(); ++i) {
    const Day& day = s.plans[i].day;
    const double friction =
        day.friction * (1 + s.rig.rich.size * s.rig.rich.daily_friction * day.friction_draw);
    out << (i > 0 ? ",\n  " : "") << "{\"run\": " << Quoted(s.plans[i].name)
        << ", \"T_s\": " << Number(s.rig.values.dry_torque * friction)
        << ", \"celsius\": " << Number(day.celsius) << ", \"payload\": " << Number(day.payload)
        << ", \"p1_offset\": " << Number(day.offset_1) << ", \"p2_offset\": " << Number(day.offset_2)
        << ", \"p_3\": " << Number(s.rig.values.supply_pressure + day.supply) << "}";
  }
  out << "]";
}

void WriteRecorder(const Recorder& r, std::ofstream& out) {
  out << ",\n \"recorder\": {\"rate_hz\": " << Number(r.rate)
      << ", \"averages\": " << (r.averages ? "true" : "false") << ", \"jitter\": " << Number(r.jitter)
      << ", \"spikes_per_s\": " << Number(r.spikes) << ", \"dropouts_per_s\": " << Number(r.dropouts)
      << ",\n  \"channels\": {";
  const char* const kNames[kChannels] = {"motor_speed", "motor_angle", "arm_angle", "p1", "p2"};
  for (int i = 0; i < kChannels; ++i) {
    const Channel& c = r.channels[i];
    out << (i > 0 ? ",\n   " : "") << Quoted(kNames[i]) << ": {\"unit\": " << Number(NoiseUnit(c))
        << ", \"coloured\": " << Number(c.coloured) << ", \"colour_s\": " << Number(c.colour_time)
        << ", \"hum\": " << Number(c.hum) << ", \"wander\": " << Number(c.wander)
        << ", \"step\": " << Number(c.step) << ", \"filter_s\": " << Number(c.filter) << "}";
  }
  out << "}}";
}

}  // namespace

void WriteKey(const Case& c, const Solved& s, const std::string& file) {
  std::ofstream out = Open(file);
  out << "{\"generation\": 2, \"case\": " << Quoted(c.name) << ", \"class\": " << Quoted(c.kind)
      << ", \"what\": " << Quoted(c.what) << ", \"seed\": " << c.seed << ",\n \"gap\": " << Number(s.gap)
      << ", \"gap_asked\": " << Number(c.gap) << ", \"gap_reached\": " << (s.reached ? "true" : "false")
      << ", \"gap_at_true_values\": " << Number(s.gap_at_truth)
      << ", \"gap_of_model\": " << Number(s.gap_of_model) << ", \"richness\": " << Number(s.richness)
      << ", \"window_s\": 0.4";
  WriteEffects(s.effects, out);
  WriteValues(s, out);
  WriteRecorder(s.recorder, out);
  out << ",\n \"remark\": [";
  for (size_t i = 0; i < s.mistake.remark.size(); ++i) {
    out << (i > 0 ? ", " : "") << "[";
    for (size_t k = 0; k < s.mistake.remark[i].size(); ++k)
      out << (k > 0 ? ", " : "") << Quoted(s.mistake.remark[i][k]);
    out << "]";
  }
  out << "],\n \"outside\": ";
  if (c.outside >= 0) {
    const OutsideForm& form = OutsideForms()[c.outside];
    out << "{\"what\": " << Quoted(form.what) << ", \"balance\": " << Quoted(form.balance)
        << ", \"function_of\": " << Quoted(form.function_of)
        << ", \"size\": " << Number(s.rig.outside.*form.value) << "}";
  } else {
    out << "null";
  }
  out << "}\n";
}

}  // namespace foreign_rig
