#include "cases.h"

#include <algorithm>

namespace foreign_rig {

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  const auto add = [&](Case c) {
    c.seed = 50000 + 1000003 * cases.size();  // far apart: an offset gives no other case its seed
    cases.push_back(std::move(c));
  };
  const auto number = [](int i) { return "-" + std::to_string(i); };
  for (const EffectForm& form : EffectForms()) {
    if (form.id == "amp.bias" || form.id == "sensor.pressure_drift") continue;
    for (const double gap : {3.0, 8.0, 25.0}) {
      if (form.id == "sensor.sign" && gap > 3) continue;
      add({form.id + number(static_cast<int>(gap)), "single", form.id, gap * 1.1, -1, 0});
    }
  }
  for (int i = 1; i <= 12; ++i) add({"pair" + number(i), "pair", "", 8, -1, 0});
  for (const char* what : {"values", "coloured", "daily", "spikes", "filters", "hum"}) {
    for (int i = 1; i <= 4; ++i) add({what + number(i), "nothing", what, 0, -1, 0});
  }
  for (const double gap : {3.3, 8.0, 25.0}) {
    for (int i = 1; i <= 2; ++i) {
      const std::string suffix = number(static_cast<int>(gap)) + (i == 1 ? "a" : "b");
      add({"bias" + suffix, "bias", "amp.bias", gap, -1, 0});
      add({"drift" + suffix, "drift", "sensor.pressure_drift", gap, -1, 0});
    }
  }
  for (const char* what :
       {"voltage sign", "p1 and p2 exchanged", "bar", "kPa", "MPa", "rpm", "deg", "ms", "dropout"}) {
    for (int i = 1; i <= 2; ++i) {
      std::string name = what;
      std::replace(name.begin(), name.end(), ' ', '_');
      add({"newcomer-" + name + number(i), "newcomer", what, 0, -1, 0});
    }
  }
  for (size_t i = 0; i < OutsideForms().size(); ++i) {
    for (const double gap : {1.5, 3.3, 15.0}) {
      const std::string size = gap == 1.5 ? "1.5" : gap == 3.3 ? "3" : "15";
      add({"outside" + number(static_cast<int>(i) + 1) + "-" + size, "outside", "", gap, static_cast<int>(i),
           0});
    }
  }
  return cases;
}

}  // namespace foreign_rig
