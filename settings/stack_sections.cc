#include "settings/stack_sections.h"

#include <algorithm>
#include <cctype>

#include "settings/overrides.h"
#include "settings/process_sections.h"
#include "settings/quantity_keys.h"
#include "settings/scope_section.h"
#include "settings/trajectory_spec.h"
#include "settings/urls.h"

namespace hydro::settings {
namespace {

constexpr NumberRange kPositiveOrNone{.min = 0, .min_allowed = false, .infinity_allowed = true};
// s of wall time. The largest value is far below what 64 bits of ns hold.
constexpr NumberRange kWait{.min = 0, .max = 1e6, .min_allowed = false};

void ReadModel(SectionReader section, const std::string& config_file, ModelSection* model) {
  section.Text("file", &model->file);
  section.Choice<model::Shaft>(
      "shaft",
      {{"free", model::Shaft::kFree}, {"clamped", model::Shaft::kClamped}, {"driven", model::Shaft::kDriven}},
      &model->shaft);
  section.Number("arm_angle", &model->arm_angle_rad);
  section.Boolean("bypass", &model->bypass);
  section.Number("initial_pressure", &model->initial_pressure_psi);
  SectionReader motion = section.Section("motion");
  section.Finish();
  if (!section.Has("motion")) return;
  model->motion = ReadTrajectory(motion, config_file);
  if (model->motion->kind == TrajectorySpec::Kind::kPlanner) {
    throw motion.Error(
        "kind", "\"planner\"",
        "a motion that is known before: \"steps\", \"sine\", \"square\", \"chirp\" or \"csv\"");
  }
  motion.Finish();
  CheckedTrajectory(*model->motion, motion);
}

void ReadBus(SectionReader section, const std::string& config_file, BusSection* bus) {
  if (section.Text("url", &bus->url)) {
    const std::string allowed = WhatIsWrongWithBusUrl(bus->url);
    if (!allowed.empty()) throw section.Error("url", Quoted(bus->url), allowed);
  }
  section.Text("channel_suffix", &bus->channel_suffix);
  section.Text("key_file", &bus->key_file);
  section.Finish();
  if (!bus->key_file.empty()) bus->resolved_key_file = PathBeside(config_file, bus->key_file);
  const std::string& suffix = bus->channel_suffix;
  const bool plain = std::all_of(suffix.begin(), suffix.end(), [](unsigned char c) {
    return (c < 0x80 && std::isalnum(c)) || c == '_' || c == '-' || c == '.';
  });
  // LCM's channel names have at most 63 bytes.
  if (!plain || suffix.size() > 32) {
    throw section.Error("channel_suffix", Quoted(suffix),
                        "up to 32 letters, digits, underscores, hyphens and dots");
  }
}

void ReadTime(SectionReader section, TimeSection* time) {
  section.Choice<TimeMode>("mode", {{"realtime", TimeMode::kRealtime}, {"lockstep", TimeMode::kLockstep}},
                           &time->mode);
  section.Number("speed", &time->speed, {.min = 1e-3, .max = 1e3});
  section.Number("duration_s", &time->duration_s, kNotNegative);
  section.Number("start_timeout_s", &time->start_timeout_s, kWait);
  section.Number("stall_timeout_s", &time->stall_timeout_s,
                 {.min = 0, .max = 2, .min_allowed = false, .max_allowed = false});
  section.Finish();
}

void ReadPlant(SectionReader section, PlantSection* plant) {
  section.Number("rate_hz", &plant->rate_hz, {.min = 0, .max = 1e6, .min_allowed = false});
  section.Integer("command_delay_ticks", &plant->command_delay_ticks, 0, 1);
  section.Choice<model::Integrator>("integrator",
                                    {{"auto", model::Integrator::kAuto},
                                     {"fast", model::Integrator::kFast},
                                     {"erk", model::Integrator::kErk},
                                     {"cvode", model::Integrator::kCvode}},
                                    &plant->integrator);
  section.Number("relative_tolerance", &plant->relative_tolerance,
                 {.min = 0, .max = 0.01, .min_allowed = false});
  section.Finish();
}

void ReadPressure(SectionReader section, PressureSection* pressure) {
  if (const TomlNode* rate = section.Take("rate_hz")) {
    if (rate->is(TomlNode::Kind::kString) && rate->text == "every_tick") {
      pressure->rate_hz = 0;
    } else if (rate->is_number() && kPositive.Holds(rate->AsDouble())) {
      pressure->rate_hz = rate->AsDouble();
    } else {
      throw section.Error("rate_hz", rate->Shown(), kPositive.Allowed() + " or \"every_tick\"");
    }
  }
  section.Number("k_p", &pressure->k_p, kNotNegative);
  section.Number("k_v", &pressure->k_v, kNotNegative);
  section.Number("natural_frequency_rad_s", &pressure->natural_frequency_rad_s, kPositive);
  section.Number("damping_ratio", &pressure->damping_ratio, kPositive);
  section.Integer("compressed_sides", &pressure->compressed_sides, 1, 2);
  if (const TomlNode* feedforward = section.Take("reference_feedforward")) {
    if (feedforward->is(TomlNode::Kind::kBoolean)) {
      pressure->reference_feedforward = feedforward->boolean;
    } else if (feedforward->is_number() && kAnyNumber.Holds(feedforward->AsDouble())) {
      pressure->reference_feedforward = true;
      pressure->reference_feedforward_V_psi = feedforward->AsDouble();
    } else {
      throw section.Error("reference_feedforward", feedforward->Shown(),
                          "true, false or a finite number: the gain, volts per pressure");
    }
  }
  section.Boolean("arm_speed_feedforward", &pressure->arm_speed_feedforward);
  section.Finish();
}

void ReadPosition(SectionReader section, PositionSection* position) {
  section.Number("sample_interval_s", &position->sample_interval_s, kPositive);
  section.Number("c1", &position->c1, kNotNegative);
  section.Number("c2", &position->c2, kNotNegative);
  section.Choice<bool>("derivative", {{"error", true}, {"measurement", false}},
                       &position->derivative_on_error);
  section.Number("braking", &position->braking_rad_s2, kPositive);
  section.Integer("dac_bits", &position->dac_bits, 0, 32);
  section.Number("dac_range", &position->dac_range_psi, kPositive);
  section.Finish();
}

// With `hardware`, a motor that may hurt somebody does not start again unless it is told to.
void ReadLimits(SectionReader section, bool hardware, LimitsSection* limits) {
  if (hardware) limits->rearm = Rearm::kExplicit;
  section.Number("pressure", &limits->pressure_psi, kPositiveOrNone);
  section.Number("motor_speed", &limits->motor_speed_rad_s, kPositiveOrNone);
  section.Number("arm_angle", &limits->arm_angle_rad, kPositiveOrNone);
  section.Number("arm_torque", &limits->arm_torque_in_lbf, kPositiveOrNone);
  section.Number("stale_input_s", &limits->stale_input_s, kWait);
  section.Number("pressure_ramp_s", &limits->pressure_ramp_s, {.min = 0, .max = 1e6});
  section.Number("return_s", &limits->return_s, {.min = 0, .max = 1e6});
  section.Number("transfer_s", &limits->transfer_s, {.min = 0, .max = 1e6});
  section.Number("stale_logger_s", &limits->stale_logger_s, kWait);
  section.Number("stale_supervisor_s", &limits->stale_supervisor_s, kWait);
  section.Choice<Rearm>("rearm", {{"restart", Rearm::kRestart}, {"explicit", Rearm::kExplicit}},
                        &limits->rearm);
  section.Finish();
}

void ReadNoise(SectionReader section, NoiseSection* noise, int64_t* seed) {
  section.Number("p1", &noise->p1_psi, kNotNegative);
  section.Number("p2", &noise->p2_psi, kNotNegative);
  section.Number("motor_angle", &noise->motor_angle_rad, kNotNegative);
  section.Number("motor_speed", &noise->motor_speed_rad_s, kNotNegative);
  section.Number("arm_angle", &noise->arm_angle_rad, kNotNegative);
  section.Number("arm_speed", &noise->arm_speed_rad_s, kNotNegative);
  section.Number("p1_resolution", &noise->p1_resolution_psi, kNotNegative);
  section.Number("p2_resolution", &noise->p2_resolution_psi, kNotNegative);
  section.Number("motor_angle_resolution", &noise->motor_angle_resolution_rad, kNotNegative);
  section.Number("motor_speed_resolution", &noise->motor_speed_resolution_rad_s, kNotNegative);
  section.Number("arm_angle_resolution", &noise->arm_angle_resolution_rad, kNotNegative);
  section.Number("arm_speed_resolution", &noise->arm_speed_resolution_rad_s, kNotNegative);
  section.Integer("seed", seed, 0, std::numeric_limits<int64_t>::max());
  section.Finish();
}

void ReadLogger(SectionReader section, LoggerSection* logger) {
  section.Boolean("required", &logger->required);
  section.Number("memory_mb", &logger->memory_mb, {.min = 1, .max = 1e5});
  section.Finish();
}

}  // namespace

void ReadReference(SectionReader section, const std::string& config_file, ReferenceSection* reference) {
  section.Choice<ReferenceSignal>("signal",
                                  {{"arm_angle", ReferenceSignal::kArmAngle},
                                   {"pressure", ReferenceSignal::kPressure},
                                   {"torque", ReferenceSignal::kTorque},
                                   {"voltage", ReferenceSignal::kVoltage}},
                                  &reference->signal);
  reference->trajectory = ReadTrajectory(section, config_file);
  if (reference->trajectory.kind == TrajectorySpec::Kind::kPlanner &&
      reference->signal != ReferenceSignal::kArmAngle) {
    throw section.Error("kind", "\"planner\" with another signal", "it with signal = \"arm_angle\"");
  }
  section.Finish();
  CheckedTrajectory(reference->trajectory, section);
}

bool KnowsKey(const std::string& dotted_key) {
  // Which keys these have depends on other keys, or another reader knows them.
  for (const char* section : {"joint.", "limb.", "arm.", "process.", "driver.", "model.motion."}) {
    if (dotted_key.starts_with(section)) return true;
  }
  if (FindQuantity(dotted_key) != nullptr) return true;
  // The readers know their keys, and an unknown key is the first error that they report.
  try {
    TomlNode alone;
    ApplyOverrides({dotted_key + "=0"}, &alone);
    if (dotted_key.starts_with("reference."))
      ApplyOverrides({"reference.kind=csv", "reference.points=[[0, 0]]"}, &alone);
    StackConfig ignored;
    ReadSections(alone, "", &ignored);
  } catch (const InputError& error) {
    return std::string(error.what()).find("unknown key") == std::string::npos;
  }
  return true;
}

void CheckKeysHaveSections(const TomlNode& root) {
  // Each of these keys is tried in every section. A user with more stray keys did not just forget a section.
  constexpr int kMostTried = 20;
  int tried = 0;
  for (const auto& [key, node] : root.members) {
    if (node.is(TomlNode::Kind::kTable) || node.is(TomlNode::Kind::kArray)) continue;
    if (++tried > kMostTried) return;
    std::vector<std::string> meant;
    for (const char* section :
         {"model", "bus", "time", "plant", "pressure", "position", "limits", "noise", "logger", "scope"}) {
      const std::string dotted = std::string(section) + "." + key;
      if (KnowsKey(dotted)) meant.push_back(PresentName(dotted));
    }
    if (meant.empty()) continue;  // the document's reader reports what is wrong
    throw InputError(node.place + ": " + Quoted(key) +
                     ": found a key outside of any section, allowed section.key, did you mean " +
                     QuotedList(meant) + "?");
  }
}

void ReadSections(const TomlNode& root, const std::string& config_file, StackConfig* config,
                  std::vector<AskedKey>* asked) {
  SectionReader document(root, "", asked);
  SectionReader model = document.Section("model");
  SectionReader bus = document.Section("bus");
  SectionReader time = document.Section("time");
  SectionReader plant = document.Section("plant");
  SectionReader pressure = document.Section("pressure");
  SectionReader position = document.Section("position");
  SectionReader reference = document.Section("reference");
  SectionReader limits = document.Section("limits");
  SectionReader noise = document.Section("noise");
  SectionReader driver = document.Section("driver");
  SectionReader logger = document.Section("logger");
  SectionReader scope = document.Section("scope");
  document.Take("process");
  document.Finish();

  ReadModel(std::move(model), config_file, &config->model);
  ReadBus(std::move(bus), config_file, &config->bus);
  ReadTime(std::move(time), &config->time);
  ReadPlant(std::move(plant), &config->plant);
  ReadPressure(std::move(pressure), &config->pressure);
  ReadPosition(std::move(position), &config->position);
  ReadReference(std::move(reference), config_file, &config->reference);
  ReadLimits(std::move(limits), document.Has("driver"), &config->limits);
  ReadNoise(std::move(noise), &config->noise, &config->seed);
  if (document.Has("driver")) config->driver = ReadDriver(std::move(driver));
  ReadLogger(std::move(logger), &config->logger);
  ReadScope(std::move(scope));  // hydro-scope reads it from the text: settings/scope_section.h
  ReadProcesses(document, &config->processes);
}

}  // namespace hydro::settings
