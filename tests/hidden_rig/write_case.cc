#include "write_case.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "plans.h"

namespace hidden_rig {

namespace {

std::string Text(double value, const char* format = "%.10g") {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::ofstream Open(const std::string& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file);
  return out;
}

// A TOML float needs a point or an exponent.
std::string Float(double value) {
  std::string text = Text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

void WriteModel(const Base& b, const std::string& file) {
  std::ofstream out = Open(file);
  out << "# The rig as its makers describe it. Units: in, lbf, s, psi, rad, V.\nname = \"test "
         "rig\"\n\n[parameters]\n";
  const std::pair<const char*, double> values[] = {
      {"k_1", b.k_1}, {"T_pmax", b.T_pmax}, {"D", b.D},       {"J", b.J},    {"b", b.b},     {"T_s", b.T_s},
      {"f", b.f},     {"beta", b.beta},     {"V_ms", b.V_ms}, {"c", b.c},    {"c_E", b.c_E}, {"c_I", b.c_I},
      {"p_3", b.p_3}, {"k_2", b.k_2},       {"J_a", b.J_a},   {"mgl", b.mgl}};
  for (const auto& [name, value] : values) out << name << " = " << Float(value) << "\n";
}

}  // namespace

void WriteRuns(const Case& c, const Truth& truth, const Options& options, const std::string& folder) {
  std::filesystem::create_directories(folder);
  WriteModel(truth.given, folder + "/model.toml");
  int number = 0;
  for (const Plan& plan : Plans(c.seed, options.seconds, options.driven)) {
    ++number;
    Conditions conditions;
    conditions.rate = options.rate;
    conditions.seconds = options.seconds;
    conditions.noise = options.noise * c.noise;
    conditions.seed = c.seed * 1009 + number;
    conditions.time_of_day = 1.7 * number;
    const Record record = RecordRun(truth.setup, plan, conditions);
    const bool arm = plan.shaft != Shaft::kClamped;
    const std::string stem = folder + "/run" + std::to_string(number);

    std::ofstream table = Open(stem + ".csv");
    table << "time_s,voltage_V,motor_speed_rad_s,p1_psi,p2_psi" << (arm ? ",arm_angle_rad" : "") << "\n";
    for (size_t i = 0; i < record.time.size(); ++i) {
      table << Text(record.time[i]) << ',' << Text(record.voltage[i], "%.12g") << ','
            << Text(record.motor_speed[i], "%.8g") << ',' << Text(record.p1[i], "%.8g") << ','
            << Text(record.p2[i], "%.8g");
      if (arm) table << ',' << Text(record.arm_angle[i], "%.9g");
      table << '\n';
    }

    std::ofstream sidecar = Open(stem + ".toml");
    sidecar << "name = \"" << plan.name << "\"\nshaft = \""
            << (plan.shaft == Shaft::kFree      ? "free"
                : plan.shaft == Shaft::kClamped ? "clamped"
                                                : "driven")
            << "\"\n";
    if (!arm) sidecar << "arm_angle_rad = " << Float(plan.arm_angle) << "\n";
    sidecar << "bypass = " << (plan.bypass ? "true" : "false") << "\n\n[columns]\n"
            << "time = \"time_s\"\nvoltage = \"voltage_V\"\nmotor_speed = \"motor_speed_rad_s\"\n"
            << "p1 = \"p1_psi\"\np2 = \"p2_psi\"\n";
    if (arm) sidecar << "arm_angle = \"arm_angle_rad\"\n";
    // What the sensors' makers state, whatever the noise really is.
    sidecar << "\n[noise]\nmotor_speed = " << Float(kSpeedNoise) << "\np1 = " << Float(kPressureNoise)
            << "\np2 = " << Float(kPressureNoise) << "\n";
    if (arm) sidecar << "arm_angle = " << Float(kAngleNoise) << "\n";
  }
}

void WriteKey(const Case& c, const Truth& truth, const std::string& file) {
  std::ofstream out = Open(file);
  const auto quoted = [](const std::string& text) { return "\"" + text + "\""; };
  out << "{\n  \"case\": " << quoted(c.name) << ",\n  \"class\": " << quoted(c.kind)
      << ",\n  \"seed\": " << c.seed << ",\n  \"size\": " << quoted(c.size)
      << ",\n  \"noise\": " << Text(c.noise) << ",\n  \"gap\": " << Text(truth.gap, "%.4g")
      << (truth.beyond_values < 0 ? "" : ",\n  \"gap_beyond_values\": " + Text(truth.beyond_values, "%.4g"))
      << ",\n  \"gap_asked\": " << Text(c.gap)
      << ",\n  \"gap_reached\": " << (truth.reached ? "true" : "false") << ",\n  \"effects\": [";
  for (size_t i = 0; i < truth.effects.size(); ++i) {
    const TrueEffect& effect = truth.effects[i];
    out << (i > 0 ? ", " : "") << "{\"id\": " << quoted(effect.id) << ", \"parameters\": {";
    for (size_t k = 0; k < effect.parameters.size(); ++k) {
      out << (k > 0 ? ", " : "") << quoted(effect.parameters[k].first) << ": "
          << Text(effect.parameters[k].second);
    }
    out << "}";
    if (!effect.channel.empty()) out << ", \"signal\": " << quoted(effect.channel);
    out << "}";
  }
  out << "],\n  \"parameters\": [";
  bool first = true;
  for (const auto& form : BaseForms()) {
    const double is = truth.setup.base.*form.value;
    const double given = truth.given.*form.value;
    if (is == given) continue;
    out << (first ? "" : ", ") << "{\"name\": " << quoted(form.name) << ", \"true\": " << Text(is)
        << ", \"model\": " << Text(given) << "}";
    first = false;
  }
  out << "],\n  \"outside\": ";
  if (c.outside >= 0) {
    const OutsideForm& form = OutsideForms()[c.outside];
    out << "{\"what\": " << quoted(form.what) << ", \"balance\": " << quoted(form.place)
        << ", \"size\": " << Text(truth.setup.outside.*form.value) << "}";
  } else {
    out << "null";
  }
  out << "\n}\n";
}

}  // namespace hidden_rig
