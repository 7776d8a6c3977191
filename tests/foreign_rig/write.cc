#include "write.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "recording.h"
#include "text.h"

namespace foreign_rig {

namespace {

void WriteModel(const Values& given, bool exact, const std::string& file) {
  std::ofstream out = Open(file);
  out << "# The rig as its makers describe it. Units: in, lbf, s, psi, rad, V.\nname = \"test "
         "rig\"\n\n[parameters]\n";
  for (const ValueForm& form : ValueForms()) out << form.name << " = " << Float(given.*form.value) << "\n";
  if (exact) return;
  // As DrawGiven() draws them. Of a value that is 0 no part can be known.
  out << "\n[uncertainty]\n";
  for (const ValueForm& form : ValueForms()) {
    if (given.*form.value != 0) out << form.name << " = " << Float(form.uncertainty) << "\n";
  }
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
  if (mistake.what == "rpm") u.speed = 30 / std::numbers::pi;
  if (mistake.what == "deg") u.arm = 180 / std::numbers::pi;
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
  struct Column {
    std::string signal, name;
    int channel;
  };
  std::vector<Column> columns;
  if (recorder.motor_speed) columns.push_back({"motor_speed", "speed", kSpeed});
  if (recorder.motor_angle) columns.push_back({"motor_angle", "shaft", kShaft});
  columns.insert(columns.end(), {{"p1", "p_a", kSide1}, {"p2", "p_b", kSide2}});
  if (!plan.day.clamped) columns.push_back({"arm_angle", "arm", kArmAngle});
  for (const Column& column : columns) out << column.signal << " = " << Quoted(column.name) << "\n";
  if (recorder.stated == 0) return;
  out << "\n[noise]\n";
  for (const Column& column : columns)
    out << column.signal << " = " << Float(recorder.stated * NoiseUnit(recorder.channels[column.channel]))
        << "\n";
}

}  // namespace

void WriteRuns(const Case& c, const Solved& solved, const Options& options, const std::string& folder) {
  std::filesystem::create_directories(folder);
  WriteModel(solved.given, IsExact(c), folder + "/model.toml");
  const Units units = UnitsOf(solved.mistake);
  for (size_t i = 0; i < solved.plans.size(); ++i) {
    const Plan& plan = solved.plans[i];
    std::vector<Row> rows = Record(solved.rig, plan, solved.recorder, options.seconds, c.seed * 1009 + i);
    if (solved.mistake.what == "dropout") DropAcrossStep(&rows);
    WriteTable(rows, plan, solved.recorder, units, folder + "/" + plan.name + ".csv");
    WriteSidecar(plan, solved.recorder, folder + "/" + plan.name + ".toml");
  }
}

}  // namespace foreign_rig
