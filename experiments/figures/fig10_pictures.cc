#include "experiments/figures/fig10_pictures.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iterator>

#include "experiments/studies/position_loop.h"

namespace hydro::experiments {
namespace {

const page::Axis kTime{.label = "time since the step, s", .min = 0, .max = 2};
const page::Axis kShortTime{.label = "time since the step, s", .min = 0, .max = 1};
const page::Axis kAngle{.label = "α, rad", .min = 0};

Picture FormsPicture(const Figure10Runs& figure) {
  const ArmRun& full = figure.forms[0].nonlinear;
  const model::Parameters& p = figure.model.parameters;
  return {"",
          {.caption = fmt::format(
               "Step of {:g} rad at g = {:g}, T = {:g} ms, m g l = 0: Figure 8's linear model and the full "
               "model over the stack, the derivative on the error.",
               kFigure10Step, kPaperGain, 1e3 * kFigure10Interval),
           .panels = {{.title = "Arm",
                       .x = kTime,
                       .y = kAngle,
                       .curves = {page::Line("linear, derivative on the error", figure.forms[0].linear.time,
                                             figure.forms[0].linear.angle, 0),
                                  page::Line("linear, on the measurement", figure.forms[1].linear.time,
                                             figure.forms[1].linear.angle, 1),
                                  page::Line("full model", full.time, full.angle, 2)},
                       .rules = {{"", false, kFigure10Step}},
                       .height = 1.6},
                      {.title = "Motor torque, full model",
                       .x = kTime,
                       .y = {.label = "T_p, in-lbf", .min = -45, .max = 45},
                       .curves = {page::Line("", full.time, full.torque, 2)},
                       .rules = {{"", false, p.T_pmax}, {"", false, -p.T_pmax}}}}}};
}

Picture CausesPicture(const Figure10Runs& figure) {
  page::Panel slow{
      .title = "Eq. (16) as printed", .x = kTime, .y = kAngle, .rules = {{"", false, kFigure10Step}}};
  page::Panel fast{.title = "Without the k_v term braking the arm",
                   .x = kTime,
                   .y = kAngle,
                   .rules = {{"", false, kFigure10Step}}};
  for (size_t i = 0; i < kCauses.size(); ++i) {
    const ArmRun& run = figure.causes.runs[i];
    page::Panel& panel = i < kFeedforward ? slow : fast;
    const auto colour = static_cast<int>(i < kFeedforward ? i : i - kFeedforward);
    panel.curves.push_back(page::Line(kCauses[i].label, run.time, run.angle, colour));
  }
  fast.curves.push_back(page::Line("Figure 8", figure.forms[1].linear.time, figure.forms[1].linear.angle, 3,
                                   page::Stroke::kDashed));
  return {"-causes",
          {.caption = fmt::format("What makes the full model differ from Figure 8's, switched off one after "
                                  "another: step of {:g} rad at g = {:g}, derivative on the measurement.",
                                  kFigure10Step, kPaperGain),
           .panels = {slow, fast}}};
}

Picture RetunedPicture(const Figure10Runs& figure) {
  const ArmRun& run = figure.retuned.run;
  const ArmRun& assisted = figure.causes.runs[kFeedforward];
  const model::Parameters& p = figure.model.parameters;
  // The arm's swing on the oil, during the last 0.1 s.
  const auto tail = run.angle.end() - std::min<ptrdiff_t>(500, std::ssize(run.angle));
  const auto [lowest, highest] = std::minmax_element(tail, run.angle.end());
  const double ripple = (*highest - *lowest) / 2;
  return {
      "-retuned",
      {.caption = fmt::format(
           "The retuned loop of config/retuned.toml. The motor cannot bring the arm to within 2 % of "
           "{:g} rad, to stay, before {:.3f} s; the loop takes {}. After that its torque ripples, "
           "because the arm swings on the oil by {:.0e} rad, hardly damped.",
           kFigure10Step, figure.retuned.shortest, SettlingText(run.response), ripple),
       .panels = {
           {.title = "Arm",
            .x = kShortTime,
            .y = {.label = "α, rad", .min = 0, .max = 0.15},
            .curves = {page::Line("retuned", run.time, run.angle, 0),
                       page::Line("g = 350 with arm-speed feed-forward", assisted.time, assisted.angle, 1)},
            .rules = {{"", false, kFigure10Step}, {"shortest settling", true, figure.retuned.shortest}},
            .height = 1.6},
           {.title = "Motor torque",
            .x = kShortTime,
            .y = {.label = "T_p, in-lbf", .min = -45, .max = 45},
            .curves = {page::Line("", run.time, run.torque, 0),
                       page::Line("", assisted.time, assisted.torque, 1)},
            .rules = {{"", false, p.T_pmax}, {"", false, -p.T_pmax}}}}}};
}

Picture StepsPicture(const Figure10Runs& figure) {
  page::Panel steps{
      .x = kShortTime, .y = {.label = "α/step", .min = -0.2, .max = 1.3}, .rules = {{"", false, 1}}};
  for (const RetunedStep& r : figure.retuned.steps) {
    std::vector<double> share = r.run.angle;
    for (double& value : share) value /= r.step;
    // Noise hardly shows, so this curve is dashed to leave the one below it visible.
    steps.curves.push_back(
        page::Line(r.label, r.run.time, share, -1, r.noise ? page::Stroke::kDashed : page::Stroke::kLine));
  }
  return {"-robustness",
          {.caption = "The retuned loop on other steps, with noise and with gravity (m g l = 562 in-lbf, "
                      "assumed: the arm starts where the loop holds it), as a share of the step.",
           .panels = {steps}}};
}

}  // namespace

std::vector<Picture> Figure10Pictures(const Figure10Runs& figure) {
  return {FormsPicture(figure), CausesPicture(figure), RetunedPicture(figure), StepsPicture(figure)};
}

}  // namespace hydro::experiments
