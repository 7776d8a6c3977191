// Rigs of which all is exact but what is hidden.
#include "cases.h"
#include "draw.h"

namespace foreign_rig {

namespace {

// Other rigs' pumps have no friction by pressure, and leak so little between their sides that a wrong value
// hardly shows: this pump is worn.
void WearOut(const std::string& value, Draw* draw, Values* values) {
  if (value == "f") values->pressure_friction = draw->Between(6e-4, 1e-3);
  if (value == "c_I") values->cross_leakage = draw->Between(6e-6, 1e-5);
}

// Nothing but white noise and steps.
Recorder White(const Recorder& drawn, double stated) {
  Recorder white;
  white.rate = drawn.rate;
  white.stated = stated;
  for (int i = 0; i < kChannels; ++i) {
    white.channels[i].noise = drawn.channels[i].noise;
    white.channels[i].step = drawn.channels[i].step;
  }
  return white;
}

}  // namespace

void MakeExact(const Case& c, Solved* s) {
  Draw draw(c.seed, "exact");
  if (c.kind == "parameter") WearOut(c.what, &draw, &s->rig.values);
  s->given = s->rig.values;
  for (const ValueForm& form : ValueForms()) {
    if (c.kind == "parameter" && form.name == c.what)
      s->given.*form.value *= draw.Chance(0.5) ? draw.Between(1.15, 1.3) : draw.Between(0.75, 0.87);
  }
  s->recorder = White(s->recorder, 1 / c.noise);
  for (Plan& plan : s->plans) {
    Day& day = plan.day;
    day.prelude = day.shaft_angle = day.pressure_1 = day.pressure_2 = 0;
  }
}

}  // namespace foreign_rig
