#include "cases.h"

#include <algorithm>

namespace foreign_rig {

namespace {

std::string Numbered(int i) { return "-" + std::to_string(i); }

// Each effect in one size: other sizes are those of rigs whose values are wrong.
std::vector<Case> ExactCases() {
  std::vector<Case> cases;
  for (const EffectForm& form : EffectForms()) {
    if (form.id != "sensor.sign") cases.push_back({"exact-" + form.id, "exact", form.id, 5});
  }
  for (const Signal signal : {Signal::kArmAngle, Signal::kP1, Signal::kMotorSpeed}) {
    cases.push_back({std::string("exact-sensor.sign-") + NameOf(signal), "exact", "sensor.sign"});
    cases.back().inverted = signal;
  }
  for (const char* what : {"pair", "triple"}) {
    for (int i = 1; i <= 6; ++i)
      cases.push_back({std::string("exact-") + what + Numbered(i), "exact", what, 15});
  }
  using Noise = std::pair<std::string, double>;
  for (const auto& [what, noise] :
       {Noise("noise as stated", 1), Noise("noise halved", 0.5), Noise("noise tripled", 3)}) {
    for (int i = 1; i <= 4; ++i) {
      cases.push_back({"exact-" + what + Numbered(i), "exact", what});
      std::replace(cases.back().name.begin(), cases.back().name.end(), ' ', '_');
      cases.back().noise = noise;
    }
  }
  for (const ValueForm& form : ValueForms())
    cases.push_back({"parameter-" + form.name, "parameter", form.name});
  return cases;
}

}  // namespace

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  const auto add = [&](Case c) {
    c.seed = 50000 + 1000003 * cases.size();  // far apart: an offset gives no other case its seed
    cases.push_back(std::move(c));
  };
  for (const EffectForm& form : EffectForms()) {
    if (form.id == "amp.bias" || form.id == "sensor.pressure_drift") continue;
    for (const double gap : {3.0, 8.0, 25.0}) {
      if (form.id == "sensor.sign" && gap > 3) continue;
      add({form.id + Numbered(static_cast<int>(gap)), "single", form.id, gap * 1.1, -1, 0});
    }
  }
  for (int i = 1; i <= 12; ++i) add({"pair" + Numbered(i), "pair", "", 8, -1, 0});
  for (const char* what : {"values", "coloured", "daily", "spikes", "filters", "hum"}) {
    for (int i = 1; i <= 4; ++i) add({what + Numbered(i), "nothing", what, 0, -1, 0});
  }
  for (const double gap : {3.3, 8.0, 25.0}) {
    for (int i = 1; i <= 2; ++i) {
      const std::string suffix = Numbered(static_cast<int>(gap)) + (i == 1 ? "a" : "b");
      add({"bias" + suffix, "bias", "amp.bias", gap, -1, 0});
      add({"drift" + suffix, "drift", "sensor.pressure_drift", gap, -1, 0});
    }
  }
  for (const char* what :
       {"voltage sign", "p1 and p2 exchanged", "bar", "kPa", "MPa", "rpm", "deg", "ms", "dropout"}) {
    for (int i = 1; i <= 2; ++i) {
      std::string name = what;
      std::replace(name.begin(), name.end(), ' ', '_');
      add({"newcomer-" + name + Numbered(i), "newcomer", what, 0, -1, 0});
    }
  }
  for (size_t i = 0; i < OutsideForms().size(); ++i) {
    for (const double gap : {1.5, 3.3, 15.0}) {
      const std::string size = gap == 1.5 ? "1.5" : gap == 3.3 ? "3" : "15";
      add({"outside" + Numbered(static_cast<int>(i) + 1) + "-" + size, "outside", "", gap,
           static_cast<int>(i), 0});
    }
  }
  for (const Case& c : ExactCases()) add(c);
  return cases;
}

}  // namespace foreign_rig
