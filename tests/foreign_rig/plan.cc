#include "plan.h"

#include <cmath>

#include "draw.h"

namespace foreign_rig {

namespace {

using Form = Stretch::Form;

// Bypass open: nothing holds the pump but friction, so that held voltages are short or follow a speed.
std::vector<Stretch> Bypassed(Draw& draw, double from, double to) {
  std::vector<Stretch> all;
  double direction = draw.Sign();
  for (double t = from; t < to;) {
    Stretch s;
    s.start = t;
    const int kind = draw.Index(4);
    if (kind == 0) {
      s.goal = Goal::kVoltage;
      s.mean = direction * draw.Between(1.3, 2.6);
      t += draw.Between(0.25, 0.5);
    } else if (kind == 1) {
      s.form = Form::kSine;
      s.goal = Goal::kVoltage;
      s.swing = draw.Between(2, 6);
      s.hz = draw.Between(1.5, 6);
      t += draw.Between(0.5, 0.9);
    } else if (kind == 2) {
      s.goal = Goal::kSpeed;
      s.mean = direction * draw.LogBetween(15, 420);
      t += draw.Between(0.3, 0.7);
    } else {
      s.form = Form::kRamp;
      s.goal = Goal::kSpeed;
      s.mean = direction * draw.Between(20, 120);
      s.swing = -direction * draw.Between(60, 250);
      t += draw.Between(0.5, 0.9);
    }
    s.end = t;
    direction = -direction;
    all.push_back(s);
  }
  return all;
}

// Clamped, open loop.
std::vector<Stretch> Stepped(Draw& draw, double from, double to) {
  std::vector<Stretch> all;
  double direction = draw.Sign();
  for (double t = from; t < to;) {
    Stretch s;
    s.start = t;
    const int kind = draw.Index(4);
    if (kind <= 1) {
      s.mean = direction * draw.Between(1.2, 3.4);
      t += draw.Between(0.25, 0.6);
    } else if (kind == 2) {
      s.form = Form::kRamp;
      s.mean = direction * draw.Between(0.8, 1.5);
      s.swing = direction * draw.Between(0.6, 2.0);
      t += draw.Between(0.4, 0.8);
    } else {
      s.form = Form::kChirp;
      s.swing = draw.Between(1.6, 2.6);
      s.hz = draw.Between(0.8, 2);
      s.hz_end = draw.Between(5, 14);
      t += draw.Between(0.7, 1.2);
    }
    s.end = t;
    direction = -direction;
    all.push_back(s);
  }
  return all;
}

// Clamped, pressure loop.
std::vector<Stretch> Pressed(Draw& draw, double from, double to) {
  std::vector<Stretch> all;
  for (double t = from; t < to;) {
    Stretch s;
    s.start = t;
    s.goal = Goal::kPressure;
    s.mean = draw.Between(-250, 250);
    const int kind = draw.Index(4);
    if (kind == 0) {
      s.form = Form::kSquare;
      s.swing = draw.Between(200, 900);
      s.hz = draw.Between(1.2, 4);
    } else if (kind == 1) {
      s.form = Form::kSine;
      s.swing = draw.Between(200, 1000);
      s.hz = draw.Between(0.8, 5);
    } else if (kind == 2) {
      s.form = Form::kChirp;
      s.swing = draw.Between(150, 500);
      s.hz = draw.Between(1, 3);
      s.hz_end = draw.Between(8, 20);
    } else {
      s.mean = draw.Sign() * draw.Between(150, 1000);
    }
    t += draw.Between(0.6, 1.3);
    s.end = t;
    all.push_back(s);
  }
  return all;
}

// Free, position loop.
std::vector<Stretch> Moved(Draw& draw, double from, double to, double reach) {
  std::vector<Stretch> all;
  for (double t = from; t < to;) {
    Stretch s;
    s.start = t;
    s.goal = Goal::kAngle;
    s.mean = reach * draw.Between(-0.6, 0.6);
    const int kind = draw.Index(3);
    if (kind == 1) {
      s.form = Form::kSine;
      s.swing = reach * draw.Between(0.15, 0.4);
      s.hz = draw.Between(0.4, 2);
    } else if (kind == 2) {
      s.form = Form::kRamp;
      s.swing = reach * draw.Between(-0.4, 0.4);
    }
    t += draw.Between(0.6, 1.3);
    s.end = t;
    all.push_back(s);
  }
  return all;
}

Plan DrawPlan(Draw& draw, int kind, double seconds, double reach) {
  Plan plan;
  Day& day = plan.day;
  day.prelude = draw.Between(0.3, 1.2);
  day.shaft_angle = draw.Between(0, 100) * kTurn;
  day.clock = draw.Between(0, 100);
  day.friction_draw = draw.Between(-1, 1);
  day.pressure_1 = draw.Chance(0.5) ? draw.Between(0, 300) : 0;
  day.pressure_2 = draw.Chance(0.5) ? draw.Between(0, 300) : 0;
  day.arm_angle = reach * draw.Between(-0.6, 0.6);
  day.bypass = kind == 0;
  day.clamped = kind != 3;
  const double from = -day.prelude;
  plan.stretches = kind == 0   ? Bypassed(draw, from, seconds)
                   : kind == 1 ? Stepped(draw, from, seconds)
                   : kind == 2 ? Pressed(draw, from, seconds)
                               : Moved(draw, from, seconds, reach);
  if (kind == 3) plan.stretches[0].mean = day.arm_angle;  // the loop is not started with a leap
  return plan;
}

}  // namespace

double Wanted(const Stretch& s, double t) {
  const double u = t - s.start;
  const double length = s.end - s.start;
  switch (s.form) {
    case Form::kHold:
      return s.mean;
    case Form::kRamp:
      return s.mean + s.swing * u / length;
    case Form::kSine:
      return s.mean + s.swing * std::sin(kTurn * s.hz * u);
    case Form::kSquare:
      return s.mean + (u * s.hz - std::floor(u * s.hz) < 0.5 ? s.swing : -s.swing);
    case Form::kChirp:
      return s.mean + s.swing * std::sin(kTurn * u * (s.hz + 0.5 * (s.hz_end - s.hz) * u / length));
  }
  return 0;
}

std::vector<Plan> DrawPlans(uint64_t seed, double seconds, double reach) {
  // The fifth and the held-out runs are drawn; the arm is free in one of the latter at least.
  Draw kinds(seed, "kinds of runs");
  const std::vector<int> order = {0, 1, 2, 3, 1 + kinds.Index(3), 3, kinds.Index(3), 1 + kinds.Index(3)};
  std::vector<Plan> plans;
  for (size_t i = 0; i < order.size(); ++i) {
    Draw draw(seed, "plan " + std::to_string(i));
    plans.push_back(DrawPlan(draw, order[i], seconds, reach));
    plans.back().held_out = i >= 5;
    plans.back().name = i < 5 ? "run" + std::to_string(i + 1) : "held" + std::to_string(i - 4);
  }
  // A motor that never reaches its limit cannot show where it is.
  Stretch& jolt = plans[0].stretches[plans[0].stretches.size() / 2];
  jolt = {Form::kSquare, Goal::kVoltage, jolt.start, jolt.end, 0, kLargestVoltage, 4, 0};
  return plans;
}

void ApplyDaily(const Daily& daily, uint64_t seed, std::vector<Plan>* plans) {
  for (size_t i = 0; i < plans->size(); ++i) {
    Draw draw(seed, "day " + std::to_string(i));
    Day& day = (*plans)[i].day;
    // Drawn evenly, of this standard deviation: no day is beyond all bounds.
    const auto about_0 = [&] { return std::sqrt(3.0) * draw.Between(-1, 1); };
    day.friction = 1 + daily.friction * about_0();
    day.celsius = 40 + daily.celsius * about_0();
    const double payload = daily.payload * draw.Uniform();
    day.payload = day.clamped ? 0 : payload;
    day.offset_1 = daily.offset * about_0();
    day.offset_2 = daily.offset * about_0();
    day.supply = daily.supply * about_0();
  }
}

}  // namespace foreign_rig
