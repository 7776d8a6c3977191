#include "settings/driver_section.h"

#include "base/number_text.h"
#include "settings/process_sections.h"
#include "settings/stack_config.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

using Source = SensorSection::Source;

constexpr int kMostLines = 4095;
constexpr int kLongestSettling = 99999;  // ns, the longest that Comedi's wait instruction takes

void ReadLine(SectionReader& section, BoardLine* line) {
  section.Integer("subdevice", &line->subdevice, 0, kMostLines);
  section.Integer("channel", &line->channel, 0, kMostLines);
  section.Require("subdevice", "the number of the board's subdevice; comedi_board_info lists them");
  section.Require("channel", "the number of the channel of that subdevice");
}

void ReadAnalog(SectionReader& section, int* range, AnalogReference* reference) {
  section.Integer("range", range, 0, kMostLines);
  section.Choice<AnalogReference>("reference",
                                  {{"ground", AnalogReference::kGround},
                                   {"common", AnalogReference::kCommon},
                                   {"differential", AnalogReference::kDifferential},
                                   {"other", AnalogReference::kOther}},
                                  reference);
}

// With a scale of zero every reading would be the same; with an infinite scale there would be none.
void ReadScale(SectionReader& section, double* scale, double* offset, const std::string& unit) {
  if (section.Number("scale", scale) && *scale == 0) {
    throw section.Error("scale", "0", "a finite number other than 0, in " + unit);
  }
  section.Require("scale", "a finite number other than 0, in " + unit);
  section.Number("offset", offset);
}

AmplifierSection ReadAmplifier(SectionReader section, DriverKind kind) {
  AmplifierSection amplifier;
  if (kind == DriverKind::kComedi) {
    ReadLine(section, &amplifier.line);
    ReadAnalog(section, &amplifier.range, &amplifier.reference);
  }
  ReadScale(section, &amplifier.scale, &amplifier.offset,
            kind == DriverKind::kOwn ? "V of eq. (1) per unit of the device's output"
                                     : "V of eq. (1) per V at the terminal");
  section.Number("limit_V", &amplifier.limit_V, {.min = 0, .min_allowed = false, .infinity_allowed = true});
  section.Finish();
  return amplifier;
}

void ReadPlausible(SectionReader& section, DriverKind kind, SensorSection* sensor) {
  sensor->limit_suffix = kind == DriverKind::kOwn ? "" : "_V";
  const std::string minimum = "minimum" + sensor->limit_suffix, maximum = "maximum" + sensor->limit_suffix;
  section.Number(minimum, &sensor->minimum);
  section.Number(maximum, &sensor->maximum);
  if (sensor->minimum >= sensor->maximum) {
    throw section.Error(minimum, ShortestNumber(sensor->minimum),
                        "below " + maximum + " = " + ShortestNumber(sensor->maximum));
  }
}

// Where the sensor is connected.
void ReadInput(SectionReader& section, DriverKind kind, SensorSection* sensor) {
  const bool analog = sensor->source == Source::kAnalog;
  switch (kind) {
    case DriverKind::kComedi:
      ReadLine(section, &sensor->line);
      if (analog) ReadAnalog(section, &sensor->range, &sensor->reference);
      break;
    case DriverKind::kFrontEnd:
      section.Integer("channel", &sensor->line.channel, 0, kMostLines);
      section.Require("channel",
                      analog ? "the number of the front end's analog input" : "the number of its counter");
      if (!analog) section.Integer("counter_bits", &sensor->counter_bits, 8, 32);
      break;
    case DriverKind::kOwn:
      section.Text("input", &sensor->input);
      break;
  }
}

SensorSection ReadSensor(SectionReader section, DriverKind kind,
                         const std::vector<std::pair<std::string, Source>>& sources) {
  SensorSection sensor;
  section.Choice<Source>("source", sources, &sensor.source);
  std::vector<std::string> names;
  names.reserve(sources.size());
  for (const auto& [name, source] : sources) names.push_back(name);
  section.Require("source", QuotedList(names));
  const bool analog = sensor.source == Source::kAnalog;
  if (analog || sensor.source == Source::kCounter) {
    ReadInput(section, kind, &sensor);
    ReadScale(section, &sensor.scale, &sensor.offset,
              !analog                    ? "the signal's unit per count"
              : kind == DriverKind::kOwn ? "the signal's unit per unit of the device's input"
                                         : "the signal's unit per V");
    if (analog) ReadPlausible(section, kind, &sensor);
  }
  section.Number("low_pass_hz", &sensor.low_pass_hz, kNotNegative);
  section.Finish();
  return sensor;
}

// A rate derived from an angle needs that angle.
void CheckDerivative(const SectionReader& section, const std::string& speed, const SensorSection& rate,
                     const std::string& angle, const SensorSection& of) {
  if (rate.source != Source::kDerivative || of.source != Source::kNone) return;
  throw section.Error(speed, "source = \"derivative\" without [driver." + angle + "]",
                      "[driver." + angle + "] beside it, or source = \"analog\"");
}

// Two pressures of one sensor differ by nothing, whatever the load: the pressure loop would push without end.
void CheckPressures(const SectionReader& section, const DriverSection& driver) {
  const auto refuse = [&](const std::string& key, const std::string& found) {
    return section.Error(key, found + ", which [driver.p1] reads, too", "another than that of p1");
  };
  const SensorSection &p1 = driver.p1, &p2 = driver.p2;
  if (driver.kind != DriverKind::kOwn) {
    if (p1.line.subdevice == p2.line.subdevice && p1.line.channel == p2.line.channel)
      throw refuse("p2.channel", std::to_string(p2.line.channel));
    return;
  }
  const std::string first = p1.input.empty() ? "p1" : p1.input, second = p2.input.empty() ? "p2" : p2.input;
  if (first == second) throw refuse("p2.input", Quoted(second));
}

// Reads the keys that only a driver of the user's own has.
void ReadOwn(SectionReader& section, DriverSection* driver) {
  section.Require("device", "what the driver opens, e.g. \"can0\" or \"udp://192.168.1.7:5000\"");
  driver->own.place = section.place();
  if (const TomlNode* own = section.Take("own")) {
    if (!own->is(TomlNode::Kind::kTable)) throw section.Error("own", own->Shown(), "a section [driver.own]");
    driver->own = *own;
  }
}

// Reads the keys that only a front end has.
void ReadFrontEnd(SectionReader& section, FrontEndSection* front_end) {
  if (section.Text("url", &front_end->url)) {
    const std::string allowed = WhatIsWrongWithFrontEndUrl(front_end->url, &front_end->address);
    if (!allowed.empty()) throw section.Error("url", Quoted(front_end->url), allowed);
  }
  section.Require("url", "the address of the front end, e.g. \"serial:/dev/ttyACM0?baud=2000000\"");
  section.Choice<FrontEndMode>(
      "mode", {{"remote_io", FrontEndMode::kRemoteIo}, {"loop_on_device", FrontEndMode::kLoopOnDevice}},
      &front_end->mode);
  section.Number("watchdog_s", &front_end->watchdog_s, {.min = 0, .max = 1, .min_allowed = false});
  section.Number("read_back_tolerance_V", &front_end->read_back_tolerance_V, kNotNegative);
}

}  // namespace

DriverSection ReadDriver(SectionReader section) {
  DriverSection driver;
  section.Choice<DriverKind>(
      "kind",
      {{"comedi", DriverKind::kComedi}, {"front_end", DriverKind::kFrontEnd}, {"own", DriverKind::kOwn}},
      &driver.kind);
  if (driver.kind == DriverKind::kFrontEnd) {
    ReadFrontEnd(section, &driver.front_end);
  } else {
    section.Text("device", &driver.device);
  }
  driver.simulated_device =
      ReadCommand(section, "simulated_device",
                  "the program that stands for the device and its arguments, e.g. [\"./my_device\"]");
  const bool board = driver.kind == DriverKind::kComedi;
  if (board) section.Integer("settle_ns", &driver.settle_ns, 0, kLongestSettling);
  if (driver.kind == DriverKind::kOwn) ReadOwn(section, &driver);
  const auto part = [&](const char* name) { return std::pair(section.Has(name), section.Section(name)); };
  auto [has_voltage, voltage] = part("voltage");
  auto [has_watchdog, watchdog] = board ? part("watchdog") : std::pair(false, section);
  auto [has_p1, p1] = part("p1");
  auto [has_p2, p2] = part("p2");
  auto [has_motor_angle, motor_angle] = part("motor_angle");
  auto [has_motor_speed, motor_speed] = part("motor_speed");
  auto [has_arm_angle, arm_angle] = part("arm_angle");
  auto [has_arm_speed, arm_speed] = part("arm_speed");
  section.Require("voltage", "a section [driver.voltage]: the output to the amplifier");
  section.Require("p1", "a section [driver.p1]: how the pressure of side 1 is measured");
  section.Require("p2", "a section [driver.p2]: how the pressure of side 2 is measured");
  section.Require("motor_speed", "a section [driver.motor_speed]: how the motor's speed is measured");
  section.Finish();

  driver.voltage = ReadAmplifier(std::move(voltage), driver.kind);
  if (has_watchdog) {
    ReadLine(watchdog, &driver.watchdog.emplace());
    watchdog.Finish();
  }
  const std::pair<std::string, Source> analog{"analog", Source::kAnalog};
  const std::pair<std::string, Source> counter{"counter", Source::kCounter};
  const std::pair<std::string, Source> derivative{"derivative", Source::kDerivative};
  driver.p1 = ReadSensor(std::move(p1), driver.kind, {analog});
  driver.p2 = ReadSensor(std::move(p2), driver.kind, {analog});
  if (has_motor_angle)
    driver.motor_angle = ReadSensor(std::move(motor_angle), driver.kind, {counter, analog});
  driver.motor_speed = ReadSensor(std::move(motor_speed), driver.kind, {analog, derivative});
  if (has_arm_angle) driver.arm_angle = ReadSensor(std::move(arm_angle), driver.kind, {analog, counter});
  if (has_arm_speed) driver.arm_speed = ReadSensor(std::move(arm_speed), driver.kind, {analog, derivative});
  CheckPressures(section, driver);
  CheckDerivative(section, "motor_speed", driver.motor_speed, "motor_angle", driver.motor_angle);
  CheckDerivative(section, "arm_speed", driver.arm_speed, "arm_angle", driver.arm_angle);
  return driver;
}

void CheckDriver(const StackConfig& config, const std::string& program) {
  const auto refuse = [&](const std::string& key, const std::string& found, const std::string& allowed) {
    throw KeyError(config.file, key, found, allowed);
  };
  const bool ours = program == "hydro-driver";
  if (!config.driver) {
    refuse("driver", "nothing", "a section [driver], which " + program + " needs: how the machine is wired");
  }
  if (ours && config.driver->kind == DriverKind::kOwn) {
    refuse("driver.kind", "\"own\"",
           "\"comedi\" or \"front_end\" with hydro-driver; a driver of your own is started by [[process]] "
           "with command = [...] "
           "and role = \"driver\"");
  }
  if (!ours && config.driver->kind != DriverKind::kOwn) {
    refuse("driver.kind", config.driver->kind == DriverKind::kComedi ? "\"comedi\"" : "\"front_end\"",
           "\"own\" with " + program + ", a driver of your own");
  }
  if (config.time.mode == TimeMode::kLockstep) {
    refuse("time.mode", "\"lockstep\"", "\"realtime\" with " + program + ": a machine waits for nobody");
  }
  if (config.time.speed != 1) {
    refuse("time.speed", ShortestNumber(config.time.speed), "1 with " + program);
  }
  if (config.reference.signal == ReferenceSignal::kArmAngle &&
      config.driver->arm_angle.source == Source::kNone) {
    refuse("driver.arm_angle", "nothing",
           "a section [driver.arm_angle] where reference.signal = \"arm_angle\"");
  }
  if (config.pressure.arm_speed_feedforward && config.driver->arm_speed.source == Source::kNone) {
    refuse("driver.arm_speed", "nothing",
           "a section [driver.arm_speed], e.g. source = \"derivative\", where pressure.arm_speed_feedforward "
           "= true");
  }
}

}  // namespace hydro::settings
