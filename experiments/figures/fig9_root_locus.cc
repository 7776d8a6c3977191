// Figure 9: the root locus of the position loop's design model, and the same loop sampled.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "experiments/figures/catalogue.h"
#include "experiments/maths/sampled_position_loop.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/design_numbers.h"
#include "experiments/studies/json_text.h"
#include "runs/step_response.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kNaN = page::kAutomatic;
constexpr double kPaperCriticalGain = 770;
constexpr double kPaperRatio = 484.7;  // of the transmission, as the paper's text prints it
constexpr double kStep = 0.1;          // rad; the model is linear
constexpr double kDuration = 0.6;      // s
constexpr double kResolution = 1e-5;   // s: the largest stable T is confirmed by simulation this far on
constexpr std::array<double, 4> kIntervals = {0.001, 0.002, 0.005, 0.010};

struct Form {
  DerivativeForm form;
  const char* key;
  const char* name;
};
constexpr std::array<Form, 2> kForms = {
    Form{DerivativeForm::kError, "on_error", "Derivative of the error, eq. (17) as printed"},
    Form{DerivativeForm::kMeasurement, "on_measurement", "Derivative of the measurement"}};

// Branches of the locus: the poles over the gain, each followed from one gain to the next.
std::vector<std::vector<Complex>> FollowBranches(const std::vector<std::vector<Complex>>& poles) {
  std::vector<std::vector<Complex>> branches(poles.front().size());
  for (size_t b = 0; b < branches.size(); ++b) branches[b].push_back(poles.front()[b]);
  for (size_t i = 1; i < poles.size(); ++i) {
    std::vector<Complex> left = poles[i];
    for (auto& branch : branches) {
      const auto nearest =
          std::min_element(left.begin(), left.end(), [&](const Complex& a, const Complex& b) {
            return std::abs(a - branch.back()) < std::abs(b - branch.back());
          });
      branch.push_back(*nearest);
      left.erase(nearest);
    }
  }
  return branches;
}

page::Curve Points(const std::string& label, const std::vector<Complex>& points, int colour,
                   page::Stroke stroke = page::Stroke::kPoints) {
  page::Curve curve{
      .label = label, .x = {}, .y = {}, .stroke = stroke, .colour = colour, .y_low = {}, .y_high = {}};
  for (const Complex& point : points) {
    curve.x.push_back(point.real());
    curve.y.push_back(point.imag());
  }
  return curve;
}

runs::StepResponse Measure(const Response& response) {
  return runs::MeasureStep(response.time, response.angle, 0, response.time.size(), 0, kStep);
}

// Whether a simulated step dies away: its deviation late in the run against the same earlier.
bool SimulatedStepDecays(const DesignModel& model, double interval, DerivativeForm form) {
  constexpr int kSamples = 30000;
  const Response response = SampledStep(model, kPaperGain, interval, form, kStep, kSamples * interval, 1);
  const auto deviation = [&](size_t from, size_t to) {
    double most = 0;
    for (size_t i = from; i < to; ++i) most = std::max(most, std::fabs(response.angle[i] - kStep));
    return most;
  };
  return deviation(kSamples - 1000, kSamples) < deviation(2000, 3000);
}

}  // namespace

ExperimentResult RunFig9(const ExperimentOptions& options) {
  const model::ModelDescription table1 = ShippedModel("table1");
  const model::Parameters& p = table1.parameters;
  const DesignModel design = Figure8Model(p);
  const StabilityLimit limit = RouthLimit(design);
  DesignModel printed_ratio = design;
  printed_ratio.k_2 = kPaperRatio * p.D;
  const StabilityLimit printed_limit = RouthLimit(printed_ratio);
  const std::vector<Complex> paper_poles = Poles(design, kPaperGain);

  // The locus.
  std::vector<double> gains;
  std::vector<std::vector<Complex>> poles;
  for (int i = 0; i <= 3000; ++i) {
    gains.push_back(1200.0 * std::pow(i / 3000.0, 2));  // dense where poles leave the origin
    poles.push_back(Poles(design, gains.back()));
  }
  const auto branches = FollowBranches(poles);

  // Sampled.
  const double largest = LargestStableInterval(design, kPaperGain);
  json sampled = json::array();
  json largest_stable;
  std::vector<page::Panel> step_panels;
  for (size_t f = 0; f < kForms.size(); ++f) {
    page::Panel panel;
    panel.title = kForms[f].name;
    panel.x = {.label = "time, s", .logarithmic = false, .min = 0, .max = 0.4};
    panel.y = {
        .label = "α, rad", .logarithmic = false, .min = f == 0 ? -0.05 : 0.0, .max = f == 0 ? 0.25 : 0.2};
    const Response continuous = ContinuousStep(design, kPaperGain, kForms[f].form, kStep, kDuration, 5e-4);
    panel.curves.push_back({"continuous", continuous.time, continuous.angle, page::Stroke::kLine, 0, {}, {}});
    for (size_t t = 0; t < kIntervals.size(); ++t) {
      const double interval = kIntervals[t];
      const Response step = SampledStep(design, kPaperGain, interval, kForms[f].form, kStep, kDuration,
                                        static_cast<int>(std::lround(interval / 5e-4)));
      panel.curves.push_back({fmt::format("T = {:g} ms", interval * 1e3),
                              step.time,
                              step.angle,
                              interval == 0.010 ? page::Stroke::kDashed : page::Stroke::kLine,
                              static_cast<int>(t) + 1,
                              {},
                              {}});
    }
    panel.rules = {{"", false, kStep}};
    step_panels.push_back(panel);
    largest_stable[kForms[f].key] = largest;
  }
  options.progress(0.3);
  json continuous;
  for (const Form& form : kForms) {
    const runs::StepResponse step = Measure(ContinuousStep(design, kPaperGain, form.form, kStep, 2, 1e-4));
    continuous[form.key] = {{"overshoot_percent", step.overshoot_percent},
                            {"settling_time_s", step.settling_time_s.value_or(kNaN)}};
  }
  std::array<std::array<double, kIntervals.size()>, kForms.size()> overshoot{};
  for (size_t t = 0; t < kIntervals.size(); ++t) {
    const double interval = kIntervals[t];
    const double radius = SpectralRadius(design, kPaperGain, interval);
    json row = {{"sample_interval_s", interval},
                {"stable", radius < 1},
                {"spectral_radius", radius},
                {"critical_gain", SampledCriticalGain(design, interval)},
                {"poles_z", AsPairs(SampledPoles(design, kPaperGain, interval))}};
    for (size_t f = 0; f < kForms.size(); ++f) {
      const runs::StepResponse step = Measure(SampledStep(design, kPaperGain, interval, kForms[f].form, kStep,
                                                          2, static_cast<int>(std::lround(interval / 1e-4))));
      // Without an end there is no overshoot to name.
      overshoot[f][t] = radius < 1 ? step.overshoot_percent : kNaN;
      row[kForms[f].key] = {
          {"overshoot_percent", radius < 1 ? json(step.overshoot_percent) : json(nullptr)},
          {"settling_time_s", step.settling_time_s ? json(*step.settling_time_s) : json(nullptr)}};
    }
    sampled.push_back(row);
  }
  json confirmed = json::object();
  bool all_confirmed = true;
  for (const Form& form : kForms) {
    const bool holds = SimulatedStepDecays(design, largest - kResolution, form.form) &&
                       !SimulatedStepDecays(design, largest + kResolution, form.form);
    confirmed[form.key] = holds;
    all_confirmed = all_confirmed && holds;
  }
  options.progress(0.8);

  ExperimentResult result;
  result.conditions = fmt::format(
      "Figure 8's linear model, k_2 = {:g} in-lbf/psi, J_a = {:g} lbf-in-s², c_1/c_2 = {:g}; g multiplies "
      "both. "
      "Sampled: eq. (17) at intervals T with its command held (zero-order hold), exact by the matrix "
      "exponential.",
      p.k_2, p.J_a, design.zero);
  result.paper_says = "Figure 9: with c_1/c_2 = 30 the loop is stable until g = 770. T is not printed.";
  result.explanation = fmt::format(
      "Routh's criterion on the paper's own numbers puts the crossing at g = {:.1f} and {:.1f} rad/s, {:.1f} "
      "% below "
      "770, which may well be read off a plot. The transmission ratio that the text prints would need k_2 = "
      "{:.3f}, "
      "and gives {:.1f}: further away. Sampling takes gain away: T = 1 ms leaves {:.0f}, 5 ms {:.0f}, and at "
      "10 ms "
      "{:.0f}, below the paper's 350. Whether the derivative acts on the error, as eq. (17) prints, or on "
      "the "
      "measurement changes only where the reference enters: the poles, and with them the largest stable T, "
      "are the "
      "same, {:.2f} ms. {} The forms differ in their zeros, and so in overshoot: at 1 ms {:.1f} % against "
      "{:.1f} %.",
      limit.gain, limit.frequency, 100 * (1 - limit.gain / kPaperCriticalGain), printed_ratio.k_2,
      printed_limit.gain, sampled[0]["critical_gain"].get<double>(),
      sampled[2]["critical_gain"].get<double>(), sampled[3]["critical_gain"].get<double>(), 1e3 * largest,
      all_confirmed ? "Simulated steps of both forms die away 0.01 ms below it and grow 0.01 ms above it."
                    : "Simulated steps do not confirm it.",
      overshoot[0][0], overshoot[1][0]);

  result.comparisons = {
      {"critical gain g", "psi s/rad", "770", limit.gain, CriticalGainOfPoles(design),
       "expected: Routh, closed form; here: where eigenvalues cross"},
      {"frequency there", "rad/s", "", limit.frequency, std::fabs(Poles(design, limit.gain).back().imag()),
       ""},
      {"critical gain with k_2 from 484.7:1", "psi s/rad", "770", printed_limit.gain,
       CriticalGainOfPoles(printed_ratio), fmt::format("k_2 = {:.3f}", printed_ratio.k_2)},
      {"largest stable T at g = 350", "ms", "", kNaN, 1e3 * largest, "in either form of the derivative"},
  };
  for (size_t t = 0; t < kIntervals.size(); ++t) {
    result.comparisons.push_back(
        {fmt::format("overshoot at T = {:g} ms, derivative of the measurement", 1e3 * kIntervals[t]), "%", "",
         kNaN, overshoot[1][t],
         std::isnan(overshoot[1][t]) ? "unstable" : fmt::format("of the error: {:.1f} %", overshoot[0][t])});
  }
  result.findings = {
      {5, "Figure 9 is stable until g = 770.",
       fmt::format("Routh on Figure 8's model with c_1/c_2 = {:g}, k_2 = {:g} and J_a = {:g}: {:.1f} at "
                   "{:.0f} rad/s; "
                   "with k_2 = {:.3f} of the printed ratio {:g}: {:.1f}. Poles at g = {:g}: {} and {}.",
                   design.zero, p.k_2, p.J_a, limit.gain, limit.frequency, printed_ratio.k_2, kPaperRatio,
                   printed_limit.gain, kPaperGain, PoleText(paper_poles.front()),
                   PoleText(paper_poles.back())),
       fmt::format("Prints {:.1f} beside the paper's 770.", limit.gain)},
      {7,
       "The sampling interval T of eq. (17) is not printed; its derivative acts on the error, so that a step "
       "of "
       "the reference kicks.",
       fmt::format(
           "Figure 8's model at g = {:g}, overshoot continuous and at T = 1, 2, 5 ms: derivative of the "
           "measurement {:.1f}, {:.1f}, {:.1f}, {:.1f} %; of the error {:.0f}, {:.0f}, {:.0f}, {:.0f} %. At "
           "10 "
           "ms both are {}; the largest stable T is {:.2f} ms in both.",
           kPaperGain, continuous["on_measurement"]["overshoot_percent"].get<double>(), overshoot[1][0],
           overshoot[1][1], overshoot[1][2], continuous["on_error"]["overshoot_percent"].get<double>(),
           overshoot[0][0], overshoot[0][1], overshoot[0][2],
           SpectralRadius(design, kPaperGain, 0.010) < 1 ? "stable" : "unstable", 1e3 * largest),
       "Both forms can be chosen (position.derivative). Figure 10 takes eq. (17) as printed; the default of "
       "a stack is "
       "the derivative of the measurement."}};

  result.numbers =
      JsonText(json{{"critical_gain", limit.gain},
                    {"critical_frequency_rad_s", limit.frequency},
                    {"paper_critical_gain", kPaperCriticalGain},
                    {"poles_at_350", AsPairs(paper_poles)},
                    {"printed_ratio", {{"k_2", printed_ratio.k_2}, {"critical_gain", printed_limit.gain}}},
                    {"continuous", continuous},
                    {"sampled", sampled},
                    {"largest_stable_interval_s", largest_stable},
                    {"largest_stable_interval_confirmed_by_simulation", confirmed}});
  result.table.columns = {{"gain", gains}};
  for (size_t b = 0; b < branches.size(); ++b) {
    tables::Column re{fmt::format("pole_{}_re_1_s", b + 1), {}},
        im{fmt::format("pole_{}_im_rad_s", b + 1), {}};
    for (const Complex& pole : branches[b]) {
      re.values.push_back(pole.real());
      im.values.push_back(pole.imag());
    }
    result.table.columns.push_back(re);
    result.table.columns.push_back(im);
  }

  page::Panel locus{
      .title = "",
      .x = {.label = "real part, 1/s", .logarithmic = false, .min = -200, .max = 100},
      .y = {.label = "imaginary part, rad/s", .logarithmic = false, .min = -200, .max = 200},
      .curves = {},
      .notes = {{fmt::format("g = {:.1f} at {:.1f} rad/s", limit.gain, limit.frequency), 0, limit.frequency}},
      .rules = {{"", true, 0}, {"", false, 0}},
      .equal_scales = true,
      .height = 1.8};
  for (size_t b = 0; b < branches.size(); ++b) {
    locus.curves.push_back(Points(b == 0 ? "locus over g" : "", branches[b], 0, page::Stroke::kLine));
  }
  locus.curves.push_back(Points("open loop, g = 0", poles.front(), 1));
  locus.curves.push_back(Points("zero", {Complex(-design.zero, 0)}, 2));
  locus.curves.push_back(Points(fmt::format("g = {:g}", kPaperGain), paper_poles, 3));
  locus.curves.push_back(Points(fmt::format("g = {:.1f}", limit.gain), Poles(design, limit.gain), 4));
  result.pictures.push_back(
      {"",
       {.caption = fmt::format(
            "Root locus of Figure 8's model, c_1/c_2 = {:g}, g from 0 to {:g}. The poles cross the "
            "imaginary axis at g = {:.1f}; the paper prints 770.",
            design.zero, gains.back(), limit.gain),
        .panels = {locus},
        .drawing = ""}});
  result.pictures.push_back(
      {"-steps",
       {.caption = fmt::format(
            "Figure 8's model at g = {:g} under the sampled law: a step of {:g} rad. At T = 10 ms the "
            "loop is unstable.",
            kPaperGain, kStep),
        .panels = step_panels,
        .drawing = ""}});
  page::Panel plane{.title = "",
                    .x = {.label = "real part of z", .logarithmic = false, .min = -1.1, .max = 1.1},
                    .y = {.label = "imaginary part of z", .logarithmic = false, .min = -1.1, .max = 1.1},
                    .curves = {},
                    .notes = {},
                    .rules = {{"", true, 0}, {"", false, 0}},
                    .equal_scales = true,
                    .height = 1.8};
  std::vector<Complex> circle;
  for (int i = 0; i <= 360; ++i) circle.push_back(std::polar(1.0, i * std::numbers::pi / 180));
  plane.curves.push_back(Points("unit circle", circle, 0, page::Stroke::kDotted));
  for (size_t t = 0; t < kIntervals.size(); ++t) {
    plane.curves.push_back(Points(fmt::format("T = {:g} ms", 1e3 * kIntervals[t]),
                                  SampledPoles(design, kPaperGain, kIntervals[t]), static_cast<int>(t) + 1));
  }
  result.pictures.push_back(
      {"-sampled",
       {.caption = fmt::format(
            "Poles of the sampled loop at g = {:g}, the same in both forms of the derivative: stable "
            "inside the unit circle.",
            kPaperGain),
        .panels = {plane},
        .drawing = ""}});
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
