// The answers.
#include <fstream>

#include "gap.h"
#include "text.h"
#include "write.h"

namespace foreign_rig {

namespace {

void WriteNamed(const Named& all, std::ofstream& out) {
  out << "{";
  for (size_t i = 0; i < all.size(); ++i)
    out << (i > 0 ? ", " : "") << Quoted(all[i].first) << ": " << Number(all[i].second);
  out << "}";
}

// `nearest`: the catalogue's effect with which the rig's makers would describe it.
void WriteEffects(const Rig& rig, const std::vector<Truth>& effects, std::ofstream& out) {
  out << ",\n \"effects\": [";
  for (size_t i = 0; i < effects.size(); ++i) {
    const Truth& effect = effects[i];
    out << (i > 0 ? ",\n  " : "") << "{\"id\": " << Quoted(effect.id)
        << ", \"form\": " << Quoted(FindEffect(effect.id).form) << ", \"parameters\": ";
    WriteNamed(effect.parameters, out);
    out << ", \"nearest\": ";
    WriteNamed(NearestParameters(rig, effect), out);
    out << (effect.signal.empty() ? "" : ", \"signal\": " + Quoted(effect.signal)) << "}";
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
      << ", \"window_s\": " << Number(kWindow);
  WriteEffects(s.rig, s.effects, out);
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
        << ", \"function_of\": " << Quoted(form.function_of) << ", \"catalogue\": " << Quoted(form.catalogue)
        << ", \"size\": " << Number(s.rig.outside.*form.value) << "}";
  } else {
    out << "null";
  }
  out << "}\n";
}

}  // namespace foreign_rig
