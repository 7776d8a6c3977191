#include <algorithm>
#include <cmath>
#include <set>

#include "cases.h"
#include "draw.h"
#include "gap.h"
#include "size.h"

namespace foreign_rig {

namespace {

constexpr double kArmReach = 0.3;      // rad
constexpr double kMeterSeconds = 3.6;  // of each run on which sizes are found

// Effects whose pairs would be one effect, or could not both be seen.
bool Compatible(const std::string& a, const std::string& b) {
  static const std::vector<std::set<std::string>> alike = {
      {"amp.lag", "amp.delay", "sensor.skew"},
      {"amp.bias", "pump.friction_asymmetry"},
      {"sensor.pressure_offset", "sensor.pressure_drift", "sensor.pressure_gain"},
      {"line.wave", "sensor.pressure_lag", "arm.flexure"},
      {"fluid.entrained_air", "fluid.stiffening"},
      {"pump.quadratic_drag", "motor.speed_torque_limit"},
      {"valve.check", "accumulator.stiffness"},
  };
  if (a == b || a == "sensor.sign" || b == "sensor.sign") return false;
  return std::none_of(alike.begin(), alike.end(),
                      [&](const auto& set) { return set.count(a) && set.count(b); });
}

std::vector<std::string> DrawEffects(uint64_t seed, size_t count) {
  Draw draw(seed, "pair");
  for (;;) {
    std::vector<std::string> ids;
    bool compatible = true;
    while (ids.size() < count) {
      const std::string& id = EffectForms()[draw.Index(static_cast<int>(EffectForms().size()))].id;
      for (const std::string& other : ids) compatible = compatible && Compatible(other, id);
      ids.push_back(id);
    }
    if (compatible) return ids;
  }
}

}  // namespace

namespace {

Mistake FindMistake(const std::string& what) {
  static const std::vector<Mistake> all = {
      {"voltage sign", {{"voltage"}, {"sign", "scale = -", "-1", "invert"}}},
      {"p1 and p2 exchanged", {{"p1"}, {"p2"}, {"exchange", "swap", "other way"}}},
      {"bar", {{"p1", "p2", "pressure"}, {"bar", "14.5"}}},
      {"kPa", {{"p1", "p2", "pressure"}, {"kPa", "0.145"}}},
      {"MPa", {{"p1", "p2", "pressure"}, {"MPa", "145"}}},
      {"rpm", {{"motor_speed", "speed"}, {"rpm", "0.1047"}}},
      {"deg", {{"arm_angle", "angle"}, {"deg", "0.01745"}}},
      {"ms", {{"time"}, {"ms", "0.001", "1e-3", "1e-03"}}},
      {"dropout", {{"dropout", "gap", "missing", "lost", "held", "repeat"}}},
  };
  for (const Mistake& mistake : all) {
    if (mistake.what == what) return mistake;
  }
  return {};
}

Richness DrawRichness(uint64_t seed) {
  Draw draw(seed, "richness");
  Richness r;
  r.bristle_give = draw.LogBetween(2e-4, 2e-3);
  r.once_a_turn = draw.Between(0, 0.15);
  r.once_phase = draw.Between(0, 6.28);
  r.creep = draw.Between(0, 0.01);
  r.gravity_offset = draw.Between(-6, 6);
  r.daily_friction = draw.Between(0, 0.02);
  return r;
}

// What is odd about a rig that lacks nothing: more of it than other rigs have.
void MakeOdd(const std::string& what, uint64_t seed, Solved* s) {
  Draw draw(seed, "odd");
  if (what == "daily") {
    s->daily.friction = draw.Between(0.05, 0.12);
    s->daily.celsius = draw.Between(2, 5);
    s->daily.payload = draw.Chance(0.5) ? draw.Between(0.1, 0.3) : 0;
    s->daily.offset = draw.Chance(0.5) ? draw.Between(1, 4) : 0;
    s->daily.supply = draw.Chance(0.5) ? draw.Between(2, 6) : 0;
  }
  if (what == "spikes") {
    s->recorder.spikes = draw.LogBetween(1, 6);
    s->recorder.dropouts = draw.LogBetween(0.5, 3);
  }
  for (const int i : {kSpeed, kArmAngle, kSide1, kSide2}) {
    Channel& c = s->recorder.channels[i];
    if (what == "coloured") {
      c.coloured = draw.Between(0.6, 0.95);
      c.colour_time = draw.LogBetween(0.01, 0.1);
    }
    if (what == "hum") c.hum = c.noise * draw.Between(0.8, 2);
    if (what == "filters" && i != kArmAngle) c.filter = draw.LogBetween(2e-4, 6e-4);
  }
  if (what == "filters") {
    s->recorder.averages = true;
    s->recorder.jitter = draw.Between(0.05, 0.12);
    s->recorder.channels[kSide1].filter = s->recorder.channels[kSide2].filter;
  }
}

}  // namespace

namespace {

std::vector<std::string> EffectsOf(const Case& c) {
  if (c.kind == "pair" || c.what == "pair") return DrawEffects(c.seed, 2);
  if (c.what == "triple") return DrawEffects(c.seed, 3);
  if (c.what.find('.') != std::string::npos) return {c.what};  // as all ids of effects have
  return {};
}

double SlowestRate(const Case& c, const std::vector<std::string>& ids) {
  double slowest = IsExact(c) ? 1000 : c.kind == "newcomer" ? 500 : 200;
  for (const std::string& id : ids) slowest = std::max(slowest, FindEffect(id).slowest_rate);
  return slowest;
}

void HideOutside(const Case& c, const GapMeter& meter, const Rig& plain, Solved* s) {
  const OutsideForm& form = OutsideForms()[c.outside];
  const auto put = [&](double size) {
    Rig rig = plain;
    rig.outside.*form.value = size;
    return rig;
  };
  const Sized sized = FindSize(meter, plain, form.smallest, form.largest, c.gap, put);
  s->rig = put(sized.size);
  s->reached = sized.reached;
}

// Of a pair, each has the gap alone.
void HideEffects(const Case& c, const std::vector<std::string>& ids, const GapMeter& meter, const Rig& plain,
                 Solved* s) {
  for (const std::string& id : ids) {
    const EffectForm& form = FindEffect(id);
    const auto put = [&](double size) {
      Rig rig = plain;
      form.put(size, c.seed, &rig);
      return rig;
    };
    Sized sized{form.smallest, {0, 0}, true};
    if (form.smallest < form.largest) sized = FindSize(meter, plain, form.smallest, form.largest, c.gap, put);
    s->effects.push_back(form.put(sized.size, c.seed, &s->rig));
    if (c.inverted != Signal::kNone) {
      s->rig.effects.inverted = c.inverted;
      s->effects.back().signal = NameOf(c.inverted);
    }
    s->reached = s->reached && sized.reached;
  }
}

// Small things of every machine: a part of the gap, or of the noise where nothing is missing.
void Enrich(const Case& c, const GapMeter& meter, Solved* s) {
  const bool something = !s->effects.empty() || c.outside >= 0;
  const double asked =
      Draw(c.seed, "richness size").Between(0.05, 0.15) * (something ? std::min(s->gap, 30.0) : 3);
  Rig rich = s->rig;
  rich.rich = DrawRichness(c.seed);
  rich.rich.size = 1;
  // In proportion, then corrected: near sticking, little things are not small.
  for (int i = 0; i < 5; ++i) {
    s->richness = meter.Between(rich, s->rig);
    if (s->richness < 1.2 * asked && (s->richness > 0.7 * asked || rich.rich.size >= 3)) break;
    rich.rich.size = std::isfinite(s->richness) ? std::min(3.0, rich.rich.size * asked / s->richness)
                                                : 0.1 * rich.rich.size;
  }
  s->richness = meter.Between(rich, s->rig);
  s->rig = rich;
}

}  // namespace

Solved Solve(const Case& c, const Options& options) {
  Solved s;
  s.rig.values = DrawValues(c.seed);
  // Gravity would hold the play to one side.
  if (c.outside >= 0 && OutsideForms()[c.outside].value == &Outside::backlash)
    s.rig.values.arm_weight *= 0.08;
  s.given = DrawGiven(s.rig.values, c.seed);
  s.plans = DrawPlans(c.seed, options.seconds, kArmReach);
  const std::vector<std::string> ids = EffectsOf(c);
  s.recorder = DrawRecorder(c.seed, SlowestRate(c, ids));
  if (options.rate > 0) s.recorder.rate = options.rate;
  if (c.kind == "newcomer") s.mistake = FindMistake(c.what);
  if (c.kind == "nothing") MakeOdd(c.what, c.seed, &s);
  ApplyDaily(s.daily, c.seed, &s.plans);
  if (IsExact(c)) MakeExact(c, &s);

  std::array<double, kChannels> noise{};
  for (int i = 0; i < kChannels; ++i) noise[i] = NoiseUnit(s.recorder.channels[i]);
  // Sizes are found on three runs of different kinds.
  const GapMeter meter({s.plans[0], s.plans[1], s.plans[3]}, noise, std::min(options.seconds, kMeterSeconds));
  const Rig plain = s.rig;
  if (c.outside >= 0) HideOutside(c, meter, plain, &s);
  HideEffects(c, ids, meter, plain, &s);
  if (!ids.empty() || c.outside >= 0) {
    const auto parts = meter.Beyond(s.rig, plain);
    s.gap = parts.beyond;
    s.gap_at_truth = parts.gap;
  }
  if (!IsExact(c)) Enrich(c, meter, &s);
  Rig as_given = plain;
  as_given.values = s.given;
  s.gap_of_model = meter.Between(s.rig, as_given);
  if (c.kind == "parameter") s.gap = s.gap_of_model;
  return s;
}

}  // namespace foreign_rig
