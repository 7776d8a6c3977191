#include "experiments/figures/fig10_uncertainty_pictures.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"

namespace hydro::experiments {
namespace {

constexpr size_t kShownMachines = 1500;  // as points
constexpr double kShownTime = 1.2;       // s, after the step
constexpr int kCurvePoints = 240;        // of a cumulative curve

template <class Quantity>
std::vector<double> Sorted(const UncertainSteps& steps, const Quantity& quantity) {
  std::vector<double> values;
  for (const UncertainStep& step : steps.drawn) {
    const double value = quantity(step);
    if (std::isfinite(value)) values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

double Settling(const UncertainStep& step) { return step.settling; }
double Shortest(const UncertainStep& step) { return step.shortest; }
double Overshoot(const UncertainStep& step) { return step.overshoot_percent; }

// Percent of all machines in each bin of `width` from `from` to `to`.
page::Curve Histogram(const std::string& label, const std::vector<double>& sorted, size_t machines,
                      double from, double to, double width, int colour, page::Stroke stroke) {
  page::Curve curve = page::Line(label, {}, {}, colour, stroke);
  const int bins = static_cast<int>(std::lround((to - from) / width));
  for (int bin = 0; bin <= bins; ++bin) {
    const double low = from + bin * width;
    const auto begin = std::lower_bound(sorted.begin(), sorted.end(), low);
    const auto end = std::lower_bound(begin, sorted.end(), low + width);
    curve.x.push_back(low);
    curve.y.push_back(bin == bins ? 0
                                  : 100.0 * static_cast<double>(end - begin) / static_cast<double>(machines));
  }
  return curve;
}

// Percent of all machines up to each value.
page::Curve Cumulative(const std::string& label, const std::vector<double>& sorted, size_t machines,
                       int colour) {
  page::Curve curve = page::Line(label, {}, {}, colour);
  for (int i = 0; i <= kCurvePoints && !sorted.empty(); ++i) {
    const double share = static_cast<double>(i) / kCurvePoints;
    curve.x.push_back(maths::Quantile(sorted, share));
    curve.y.push_back(100 * share * static_cast<double>(sorted.size()) / static_cast<double>(machines));
  }
  return curve;
}

Picture Distributions(const UncertainSteps& steps, const UncertainSpread& spread) {
  const size_t machines = steps.drawn.size();
  const std::vector<double> settling = Sorted(steps, Settling), shortest = Sorted(steps, Shortest),
                            overshoot = Sorted(steps, Overshoot);
  const page::Axis time{.label = "settling time (2 %), s", .min = 0.2, .max = 1};
  const page::Rule known{"Table 1", true, spread.settling.known};
  return {
      "",
      {.caption = fmt::format("Step of {:g} rad of config/retuned.toml's loop on {} machines drawn from what "
                              "is known of Table 1, the "
                              "gains those for Table 1. Settling: median {:.3f} s, 95 % within {:.3f} s; "
                              "Table 1 itself: {:.3f} s. "
                              "{:.0f} % of the machines overshoot by more than {:g} %.",
                              steps.trial.step, machines, spread.settling.p50, spread.settling.p95,
                              spread.settling.known, 100 * spread.overshoots.value, kMuchOvershoot),
       .panels = {{.title = "Settling time",
                   .x = time,
                   .y = {.label = "machines, % per 0.01 s", .min = 0},
                   .curves = {Histogram("retuned loop", settling, machines, 0.2, 1, 0.01, 0,
                                        page::Stroke::kBars),
                              Histogram("shortest possible", shortest, machines, 0.2, 1, 0.01, 1,
                                        page::Stroke::kSteps)},
                   .rules = {known}},
                  {.title = "Overshoot",
                   .x = {.label = "overshoot, % of the step", .min = 0, .max = 40},
                   .y = {.label = "machines, % per 1 %", .min = 0},
                   .curves = {Histogram("", overshoot, machines, 0, 40, 1, 0, page::Stroke::kBars)},
                   .rules = {{"", true, kMuchOvershoot}}},
                  {.title = "Settled by then",
                   .x = time,
                   .y = {.label = "machines, %", .min = 0, .max = 100},
                   .curves = {Cumulative("", settling, machines, 0), Cumulative("", shortest, machines, 1)},
                   .rules = {known}},
                  {.title = "Overshoot up to that",
                   .x = {.label = "overshoot, % of the step", .min = 0, .max = 40},
                   .y = {.label = "machines, %", .min = 0, .max = 100},
                   .curves = {Cumulative("", overshoot, machines, 0)},
                   .rules = {{"", true, kMuchOvershoot}}}},
       .columns = 2}};
}

// `quantity` over a parameter's ratio to the model's: some machines as points, and the median of each part of
// the range.
template <class Quantity>
page::Panel Over(const UncertainSteps& steps, size_t base, const page::Axis& y, const Quantity& quantity) {
  const model::BaseParameter& parameter = model::BaseParameters()[base];
  const auto ratio = [&](const UncertainStep& step) {
    return step.parameters.*parameter.member / (steps.trial.model.parameters.*parameter.member);
  };
  page::Curve points = page::Line("machines", {}, {}, 0, page::Stroke::kPoints);
  points.weight = page::Weight::kFaint;
  for (size_t i = 0; i < std::min(kShownMachines, steps.drawn.size()); ++i) {
    points.x.push_back(ratio(steps.drawn[i]));
    points.y.push_back(quantity(steps.drawn[i]));
  }
  page::Curve median = page::Line("median", {}, {}, 1);
  median.weight = page::Weight::kStrong;
  const double width = 0.4 * model::UncertaintyOf(steps.trial.model, base);
  for (int part = -7; part <= 7; ++part) {
    std::vector<double> values;
    for (const UncertainStep& step : steps.drawn) {
      const double value = quantity(step);
      if (std::isfinite(value) && std::fabs(std::log(ratio(step)) / width - part) < 0.5)
        values.push_back(value);
    }
    if (values.size() < 10) continue;
    std::sort(values.begin(), values.end());
    median.x.push_back(std::exp(part * width));
    median.y.push_back(maths::Quantile(values, 0.5));
  }
  return {.x = {.label = parameter.info.name + " over that of Table 1"}, .y = y, .curves = {points, median}};
}

page::Panel Effects(const UncertainSpread& spread, const std::string& title, double Influence::*effect) {
  page::Panel panel{.title = title,
                    .x = {.min = 0, .max = static_cast<double>(spread.influences.size())},
                    .y = {.label = "of the variance, %", .min = 0},
                    .curves = {page::Line("", {}, {}, 0, page::Stroke::kBars)}};
  page::Curve& bars = panel.curves[0];
  for (const Influence& influence : spread.influences) {
    const auto place = static_cast<double>(&influence - spread.influences.data());
    const double share = std::max(0.0, 100 * influence.*effect);
    for (const auto& [x, y] : {std::pair(place + 0.2, share), std::pair(place + 0.8, 0.0)}) {
      bars.x.push_back(x);
      bars.y.push_back(y);
    }
    panel.x.ticks.push_back({place + 0.5, model::BaseParameters()[influence.base].info.name});
  }
  return panel;
}

Picture Causes(const UncertainSteps& steps, const UncertainSpread& spread) {
  const size_t first = spread.influences.front().base;
  return {"-causes",
          {.caption = fmt::format("What the spread goes with. Below: how much of the variance each parameter "
                                  "explains alone, in whatever "
                                  "curve. Above: the one that explains most of the settling time's; {} of "
                                  "the {} machines are shown.",
                                  std::min(kShownMachines, steps.drawn.size()), steps.drawn.size()),
           .panels = {Over(steps, first, {.label = "settling time, s", .min = 0.2, .max = 1}, Settling),
                      Over(steps, first, {.label = "overshoot, %", .min = 0}, Overshoot),
                      Effects(spread, "Settling time", &Influence::settling_effect),
                      Effects(spread, "Overshoot", &Influence::overshoot_effect)},
           .columns = 2}};
}

page::Curve ArmCurve(tune::StepTrial trial, const std::string& label, int colour) {
  trial.duration = kShownTime;
  const tune::StepRun run = tune::RunStepTrial(trial);
  return page::Line(label, run.response.time, run.response.angle, colour);
}

Picture Machines(const UncertainSteps& steps, const UncertainSpread& spread) {
  // The slowest and the most overshooting machine, and those at a tenth, at half and at nine tenths of all by
  // settling time.
  std::vector<size_t> order(steps.drawn.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    const UncertainStep &first = steps.drawn[a], &second = steps.drawn[b];
    return first.settles() && (!second.settles() || first.settling < second.settling);
  });
  page::Panel panel{.x = {.label = "time since the step, s", .min = 0, .max = kShownTime},
                    .y = {.label = "α, rad", .min = 0},
                    .curves = {ArmCurve(steps.trial, "Table 1", 0)},
                    .bands = {{"2 % of the step", false, 0.98 * steps.trial.step, 1.02 * steps.trial.step}}};
  panel.curves[0].weight = page::Weight::kStrong;
  const auto add = [&](size_t machine, const std::string& what) {
    tune::StepTrial trial = steps.trial;
    trial.model = model::DrawnModel(trial.model, steps.seed, machine);
    panel.curves.push_back(
        ArmCurve(trial, fmt::format("{}: machine {}", what, machine), static_cast<int>(panel.curves.size())));
  };
  for (const double share : {0.1, 0.5, 0.9}) {
    add(order[static_cast<size_t>(share * static_cast<double>(order.size() - 1))],
        fmt::format("faster than {:.0f} %", 100 * (1 - share)));
  }
  add(spread.slowest.front(), "settles last or never");
  if (spread.most_overshoot.front() != spread.slowest.front())
    add(spread.most_overshoot.front(), "overshoots most");
  return {
      "-machines",
      {.caption = "Steps of single machines with the gains for Table 1; the table of all of them gives each "
                  "machine's parameters under its number.",
       .panels = {panel}}};
}

}  // namespace

std::vector<Picture> UncertaintyPictures(const UncertainSteps& steps, const UncertainSpread& spread) {
  return {Distributions(steps, spread), Causes(steps, spread), Machines(steps, spread)};
}

}  // namespace hydro::experiments
