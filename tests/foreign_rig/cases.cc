#include "cases.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "draw.h"
#include "gap.h"

namespace foreign_rig {

namespace {

constexpr double kArmReach = 0.3;  // rad

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

std::vector<std::string> DrawPair(uint64_t seed) {
  Draw draw(seed, "pair");
  const int count = static_cast<int>(EffectForms().size());
  for (;;) {
    const std::string& a = EffectForms()[draw.Index(count)].id;
    const std::string& b = EffectForms()[draw.Index(count)].id;
    if (Compatible(a, b)) return {a, b};
  }
}

}  // namespace

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  const auto add = [&](Case c) {
    c.seed = 50000 + 61 * cases.size();
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
    for (const double gap : {1.5, 3.0, 15.0}) {
      const std::string size = gap == 1.5 ? "1.5" : gap == 3 ? "3" : "15";
      add({"outside" + number(static_cast<int>(i) + 1) + "-" + size, "outside", "", gap, static_cast<int>(i),
           0});
    }
  }
  return cases;
}

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
      c.wander = c.noise * draw.Between(0.5, 1.2);
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

// The size for which the gap beyond other values is what is asked for. `put` makes a rig of a size.
template <class Put>
double FindSize(GapMeter& meter, const Rig& plain, double smallest, double largest, double asked,
                const Put& put, bool* reached) {
  double share = 0.6;  // of the gap that other values leave
  double size = std::sqrt(smallest * largest);
  for (int round = 0; round < 3; ++round) {
    const double goal = asked / share;
    double low = smallest, high = largest;
    double low_gap = 0, high_gap = 0;
    for (int i = 0; i < 12; ++i) {
      const double gap = meter.Between(put(size), plain);
      if (std::abs(gap / goal - 1) < 0.05) break;
      (gap < goal ? low : high) = size;
      (gap < goal ? low_gap : high_gap) = gap;
      // Gaps grow roughly in proportion.
      double next =
          std::isfinite(gap) && gap > 0 ? size * std::clamp(goal / gap, 0.02, 50.0) : std::sqrt(low * high);
      if (low_gap > 0 && high_gap > 0 && std::isfinite(high_gap) && i % 3 != 2) {
        const double part = std::log(goal / low_gap) / std::log(high_gap / low_gap);
        next = low * std::pow(high / low, std::clamp(part, 0.05, 0.95));
      }
      if (next <= low || next >= high) next = std::sqrt(low * high);
      if (high / low < 1.002) break;
      size = next;
    }
    const auto parts = meter.BeyondValues(put(size), plain);
    *reached = std::abs(parts.beyond / asked - 1) < 0.15;
    if (*reached || !std::isfinite(parts.gap) || !(parts.beyond > 0)) break;
    share = std::max(0.02, parts.beyond / parts.gap);
  }
  return size;
}

}  // namespace

Solved Solve(const Case& c, const Options& options) {
  Solved s;
  s.rig.values = DrawValues(c.seed);
  s.plans = DrawPlans(c.seed, options.seconds, kArmReach);
  if (c.kind == "newcomer") s.mistake = FindMistake(c.what);

  std::vector<std::string> ids;
  if (c.kind == "pair") {
    ids = DrawPair(c.seed);
  } else if (c.kind == "single" || c.kind == "bias" || c.kind == "drift") {
    ids = {c.what};
  }
  double slowest = c.kind == "newcomer" ? 500 : 200;
  for (const std::string& id : ids) slowest = std::max(slowest, FindEffect(id).slowest_rate);
  s.recorder = DrawRecorder(c.seed, slowest);
  if (options.rate > 0) s.recorder.rate = options.rate;
  // Gravity would hold the play to one side.
  if (c.outside >= 0 && OutsideForms()[c.outside].value == &Outside::backlash)
    s.rig.values.arm_weight *= 0.08;
  s.given = DrawGiven(s.rig.values, c.seed);
  MakeOdd(c.kind == "nothing" ? c.what : "", c.seed, &s);
  ApplyDaily(s.daily, c.seed, &s.plans);

  std::array<double, kChannels> noise{};
  for (int i = 0; i < kChannels; ++i) noise[i] = NoiseUnit(s.recorder.channels[i]);
  // Sizes are found on three runs of different kinds.
  GapMeter meter({s.plans[0], s.plans[1], s.plans[3]}, noise, options.seconds);
  const Rig plain = s.rig;
  if (c.outside >= 0) {
    const OutsideForm& form = OutsideForms()[c.outside];
    const auto put = [&](double size) {
      Rig rig = plain;
      rig.outside.*form.value = size;
      return rig;
    };
    s.rig = put(FindSize(meter, plain, form.smallest, form.largest, c.gap, put, &s.reached));
  }
  // Of a pair, each has the gap alone.
  for (const std::string& id : ids) {
    const EffectForm& form = FindEffect(id);
    const auto put = [&](double size) {
      Rig rig = plain;
      form.put(size, c.seed, &rig);
      return rig;
    };
    bool reached = true;
    const double size = form.smallest == form.largest
                            ? form.smallest
                            : FindSize(meter, plain, form.smallest, form.largest, c.gap, put, &reached);
    s.effects.push_back(form.put(size, c.seed, &s.rig));
    s.reached = s.reached && reached;
  }
  const bool something = !ids.empty() || c.outside >= 0;
  if (something) {
    const auto parts = meter.BeyondValues(s.rig, plain);
    s.gap = parts.beyond;
    s.gap_at_truth = parts.gap;
  }
  // Richness: a part of the gap, or of the noise where nothing is missing.
  Rig rich = s.rig;
  rich.rich = DrawRichness(c.seed);
  rich.rich.size = 1;
  const double at_one = meter.Between(rich, s.rig);
  const double asked =
      Draw(c.seed, "richness size").Between(0.05, 0.15) * (something ? std::min(s.gap, 30.0) : 2);
  if (std::isfinite(at_one) && at_one > 0) {
    rich.rich.size = std::min(3.0, asked / at_one);
    s.richness = meter.Between(rich, s.rig);
    s.rig = rich;
  }
  Rig as_given = plain;
  as_given.values = s.given;
  s.gap_of_model = meter.Between(s.rig, as_given);
  return s;
}

}  // namespace foreign_rig
