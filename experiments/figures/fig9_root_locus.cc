// Figure 9: the root locus of the position loop's design model, and the same loop sampled.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/position_loop.h"
#include "runs/step_response.h"
#include "tune/design/sampled_position_loop.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kNaN = page::kAutomatic;
constexpr double kPaperCriticalGain = 770;
constexpr double kPaperRatio = 484.7;       // transmission ratio printed in the paper's text
constexpr double kReferenceStep = 0.1;      // rad; the model is linear
constexpr double kRootLocusDuration = 0.6;  // s
constexpr double kResolution = 1e-5;        // s; simulation confirms the largest stable T to within this
constexpr std::array<double, 4> kIntervals = {0.001, 0.002, 0.005, 0.010};

struct Form {
  design::DerivativeForm form;
  const char* key;
  const char* name;
};
constexpr std::array<Form, 2> kForms = {
    Form{design::DerivativeForm::kError, "on_error", "Derivative of the error, eq. (17) as printed"},
    Form{design::DerivativeForm::kMeasurement, "on_measurement", "Derivative of the measurement"}};

// Branches of the locus: the poles over the gain, each followed from one gain to the next.
std::vector<std::vector<design::Complex>> FollowBranches(
    const std::vector<std::vector<design::Complex>>& poles) {
  std::vector<std::vector<design::Complex>> branches(poles.front().size());
  for (size_t b = 0; b < branches.size(); ++b) branches[b].push_back(poles.front()[b]);
  for (size_t i = 1; i < poles.size(); ++i) {
    std::vector<design::Complex> left = poles[i];
    for (auto& branch : branches) {
      const auto nearest =
          std::min_element(left.begin(), left.end(), [&](const design::Complex& a, const design::Complex& b) {
            return std::abs(a - branch.back()) < std::abs(b - branch.back());
          });
      branch.push_back(*nearest);
      left.erase(nearest);
    }
  }
  return branches;
}

page::Curve Points(const std::string& label, const std::vector<design::Complex>& points, int colour,
                   page::Stroke stroke = page::Stroke::kPoints) {
  page::Curve curve{.label = label, .stroke = stroke, .colour = colour};
  if (stroke == page::Stroke::kPoints) curve.weight = page::Weight::kStrong;
  for (const design::Complex& point : points) {
    curve.x.push_back(point.real());
    curve.y.push_back(point.imag());
  }
  return curve;
}

runs::StepResponse Measure(const design::Response& response) {
  return runs::MeasureStep(response.time, response.angle, 0, response.time.size(), 0, kReferenceStep);
}

// Whether a simulated step dies away: compares its deviation late in the run with that earlier.
bool SimulatedStepDecays(const design::DesignModel& model, double interval, design::DerivativeForm form) {
  constexpr int kSamples = 30000;
  const design::Response response =
      design::SampledStep(model, kPaperGain, interval, form, kReferenceStep, kSamples * interval, 1);
  const auto deviation = [&](size_t from, size_t to) {
    double most = 0;
    for (size_t i = from; i < to; ++i) most = std::max(most, std::fabs(response.angle[i] - kReferenceStep));
    return most;
  };
  return deviation(kSamples - 1000, kSamples) < deviation(2000, 3000);
}

// The loop at one sampling interval.
struct SampledLoop {
  double interval = 0;         // s
  double spectral_radius = 0;  // below 1: stable
  double critical_gain = 0;
  std::vector<design::Complex> poles;                  // in the z plane
  std::array<runs::StepResponse, kForms.size()> step;  // one per form

  bool stable() const { return spectral_radius < 1; }
  // A step that never settles has no overshoot.
  double Overshoot(size_t form) const { return stable() ? step[form].overshoot_percent : kNaN; }
};

struct RootLocusStudy {
  model::Parameters p;
  design::DesignModel design;
  design::StabilityLimit limit;
  design::DesignModel printed_ratio;  // with k_2 from the ratio printed in the text
  design::StabilityLimit printed_limit;
  std::vector<design::Complex> paper_poles;

  std::vector<double> gains;
  std::vector<std::vector<design::Complex>> poles;     // one set per gain
  std::vector<std::vector<design::Complex>> branches;  // the same poles, followed over the gain

  std::array<runs::StepResponse, kForms.size()> continuous;
  std::array<SampledLoop, kIntervals.size()> sampled;
  double largest = 0;  // stable interval, s
  std::array<bool, kForms.size()> confirmed{};

  bool all_confirmed() const { return confirmed[0] && confirmed[1]; }
};

void TraceLocus(RootLocusStudy* study) {
  for (int i = 0; i <= 3000; ++i) {
    study->gains.push_back(1200.0 * std::pow(i / 3000.0, 2));  // dense where poles leave the origin
    study->poles.push_back(design::Poles(study->design, study->gains.back()));
  }
  study->branches = FollowBranches(study->poles);
}

SampledLoop SampleLoop(const design::DesignModel& design, double interval) {
  SampledLoop loop{.interval = interval,
                   .spectral_radius = design::SpectralRadius(design, kPaperGain, interval),
                   .critical_gain = design::SampledCriticalGain(design, interval),
                   .poles = design::SampledPoles(design, kPaperGain, interval),
                   .step = {}};
  const int points = static_cast<int>(std::lround(interval / 1e-4));
  for (size_t f = 0; f < kForms.size(); ++f) {
    loop.step[f] =
        Measure(design::SampledStep(design, kPaperGain, interval, kForms[f].form, kReferenceStep, 2, points));
  }
  return loop;
}

RootLocusStudy RunRootLocusStudy(const ExperimentOptions& options) {
  RootLocusStudy study;
  study.p = ShippedModel("table1").parameters;
  const design::DesignModel design = study.design = design::Figure8Model(study.p);
  study.limit = design::RouthLimit(design);
  study.printed_ratio = design;
  study.printed_ratio.k_2 = kPaperRatio * study.p.D;
  study.printed_limit = design::RouthLimit(study.printed_ratio);
  study.paper_poles = design::Poles(design, kPaperGain);
  TraceLocus(&study);
  options.progress(0.3);
  for (size_t f = 0; f < kForms.size(); ++f) {
    study.continuous[f] =
        Measure(design::ContinuousStep(design, kPaperGain, kForms[f].form, kReferenceStep, 2, 1e-4));
  }
  for (size_t t = 0; t < kIntervals.size(); ++t) study.sampled[t] = SampleLoop(design, kIntervals[t]);
  study.largest = design::LargestStableInterval(design, kPaperGain);
  for (size_t f = 0; f < kForms.size(); ++f) {
    study.confirmed[f] = SimulatedStepDecays(design, study.largest - kResolution, kForms[f].form) &&
                         !SimulatedStepDecays(design, study.largest + kResolution, kForms[f].form);
  }
  options.progress(0.8);
  return study;
}

std::string Conditions(const RootLocusStudy& study) {
  return fmt::format(
      "Figure 8's linear model, k_2 = {:g} in-lbf/psi, J_a = {:g} lbf-in-s², c_1/c_2 = {:g}; g multiplies "
      "both. Sampled: eq. (17) at intervals T with its command held (zero-order hold), exact by the matrix "
      "exponential.",
      study.p.k_2, study.p.J_a, study.design.zero);
}

std::string Explanation(const RootLocusStudy& study) {
  return fmt::format(
      "Routh's criterion on the paper's own numbers puts the crossing at g = {critical_gain:.1f} and "
      "{frequency:.1f} rad/s, {percent_below:.1f} % below 770, which may well have been read off a plot. The "
      "transmission ratio that the text prints would need k_2 = {printed_k_2:.3f} and gives "
      "{printed_gain:.1f}, which is further away. Sampling costs gain: T = 1 ms leaves {gain_1_ms:.0f}, 5 ms "
      "{gain_5_ms:.0f}, and at 10 ms {gain_10_ms:.0f}, below the paper's 350. Whether the derivative acts on "
      "the error, as eq. (17) prints, or on the measurement changes only where the reference enters: the "
      "poles, and with them the largest stable T, are the same, {largest_ms:.2f} ms. {confirmed} The forms "
      "differ in their zeros, and so in overshoot: at 1 ms {overshoot_error:.1f} % against "
      "{overshoot_measurement:.1f} %.",
      fmt::arg("critical_gain", study.limit.gain), fmt::arg("frequency", study.limit.frequency),
      fmt::arg("percent_below", 100 * (1 - study.limit.gain / kPaperCriticalGain)),
      fmt::arg("printed_k_2", study.printed_ratio.k_2), fmt::arg("printed_gain", study.printed_limit.gain),
      fmt::arg("gain_1_ms", study.sampled[0].critical_gain),
      fmt::arg("gain_5_ms", study.sampled[2].critical_gain),
      fmt::arg("gain_10_ms", study.sampled[3].critical_gain), fmt::arg("largest_ms", 1e3 * study.largest),
      fmt::arg("confirmed",
               study.all_confirmed()
                   ? "Simulated steps of both forms die away 0.01 ms below it and grow 0.01 ms above it."
                   : "Simulated steps do not confirm it."),
      fmt::arg("overshoot_error", study.sampled[0].Overshoot(0)),
      fmt::arg("overshoot_measurement", study.sampled[0].Overshoot(1)));
}

std::vector<Comparison> Comparisons(const RootLocusStudy& study) {
  std::vector<Comparison> comparisons = {
      {"critical gain g", "psi s/rad", "770", study.limit.gain, design::CriticalGainOfPoles(study.design),
       "expected: Routh, closed form; here: where eigenvalues cross"},
      {"frequency there", "rad/s", "", study.limit.frequency,
       std::fabs(design::Poles(study.design, study.limit.gain).back().imag()), ""},
      {"critical gain with k_2 from 484.7:1", "psi s/rad", "770", study.printed_limit.gain,
       design::CriticalGainOfPoles(study.printed_ratio),
       fmt::format("k_2 = {:.3f}", study.printed_ratio.k_2)},
      {"largest stable T at g = 350", "ms", "", kNaN, 1e3 * study.largest,
       "in either form of the derivative"}};
  for (const SampledLoop& loop : study.sampled) {
    comparisons.push_back(
        {fmt::format("overshoot at T = {:g} ms, derivative of the measurement", 1e3 * loop.interval), "%", "",
         kNaN, loop.Overshoot(1),
         loop.stable() ? fmt::format("of the error: {:.1f} %", loop.Overshoot(0)) : "unstable"});
  }
  return comparisons;
}

std::vector<Finding> Findings(const RootLocusStudy& study) {
  return {
      {5, "Figure 9 is stable until g = 770.",
       fmt::format(
           "Routh on Figure 8's model with c_1/c_2 = {zero:g}, k_2 = {k_2:g} and J_a = {J_a:g}: "
           "{critical_gain:.1f} at {frequency:.0f} rad/s; with k_2 = {printed_k_2:.3f} of the printed ratio "
           "{printed_ratio:g}: {printed_gain:.1f}. Poles at g = {g:g}: {first_pole} and {last_pole}.",
           fmt::arg("zero", study.design.zero), fmt::arg("k_2", study.p.k_2), fmt::arg("J_a", study.p.J_a),
           fmt::arg("critical_gain", study.limit.gain), fmt::arg("frequency", study.limit.frequency),
           fmt::arg("printed_k_2", study.printed_ratio.k_2), fmt::arg("printed_ratio", kPaperRatio),
           fmt::arg("printed_gain", study.printed_limit.gain), fmt::arg("g", kPaperGain),
           fmt::arg("first_pole", PoleText(study.paper_poles.front())),
           fmt::arg("last_pole", PoleText(study.paper_poles.back()))),
       fmt::format("Prints {:.1f} beside the paper's 770.", study.limit.gain)},
      {7,
       "The sampling interval T of eq. (17) is not printed; its derivative acts on the error, so that a step "
       "of the reference causes a kick.",
       fmt::format(
           "Figure 8's model at g = {g:g}, overshoot continuous and at T = 1, 2, 5 ms: derivative of the "
           "measurement {measurement:.1f}, {measurement_1:.1f}, {measurement_2:.1f}, {measurement_5:.1f} %; "
           "of the error {error:.0f}, {error_1:.0f}, {error_2:.0f}, {error_5:.0f} %. At 10 ms both are "
           "{stable_10}; the largest stable T is {largest_ms:.2f} ms in both.",
           fmt::arg("g", kPaperGain), fmt::arg("measurement", study.continuous[1].overshoot_percent),
           fmt::arg("measurement_1", study.sampled[0].Overshoot(1)),
           fmt::arg("measurement_2", study.sampled[1].Overshoot(1)),
           fmt::arg("measurement_5", study.sampled[2].Overshoot(1)),
           fmt::arg("error", study.continuous[0].overshoot_percent),
           fmt::arg("error_1", study.sampled[0].Overshoot(0)),
           fmt::arg("error_2", study.sampled[1].Overshoot(0)),
           fmt::arg("error_5", study.sampled[2].Overshoot(0)),
           fmt::arg("stable_10", study.sampled[3].stable() ? "stable" : "unstable"),
           fmt::arg("largest_ms", 1e3 * study.largest)),
       "Both forms can be chosen (position.derivative). Figure 10 takes eq. (17) as printed; the default of "
       "a stack is the derivative of the measurement."}};
}

json Numbers(const RootLocusStudy& study) {
  json continuous, largest_stable, confirmed;
  for (size_t f = 0; f < kForms.size(); ++f) {
    const runs::StepResponse& step = study.continuous[f];
    continuous[kForms[f].key] = {{"overshoot_percent", step.overshoot_percent},
                                 {"settling_time_s", step.settling_time_s.value_or(kNaN)}};
    largest_stable[kForms[f].key] = study.largest;
    confirmed[kForms[f].key] = study.confirmed[f];
  }
  json sampled = json::array();
  for (const SampledLoop& loop : study.sampled) {
    json row = {{"sample_interval_s", loop.interval},
                {"stable", loop.stable()},
                {"spectral_radius", loop.spectral_radius},
                {"critical_gain", loop.critical_gain},
                {"poles_z", AsPairs(loop.poles)}};
    for (size_t f = 0; f < kForms.size(); ++f) {
      const runs::StepResponse& step = loop.step[f];
      row[kForms[f].key] = {
          {"overshoot_percent", loop.stable() ? json(step.overshoot_percent) : json(nullptr)},
          {"settling_time_s", step.settling_time_s ? json(*step.settling_time_s) : json(nullptr)}};
    }
    sampled.push_back(row);
  }
  return {{"critical_gain", study.limit.gain},
          {"critical_frequency_rad_s", study.limit.frequency},
          {"paper_critical_gain", kPaperCriticalGain},
          {"poles_at_350", AsPairs(study.paper_poles)},
          {"printed_ratio", {{"k_2", study.printed_ratio.k_2}, {"critical_gain", study.printed_limit.gain}}},
          {"continuous", continuous},
          {"sampled", sampled},
          {"largest_stable_interval_s", largest_stable},
          {"largest_stable_interval_confirmed_by_simulation", confirmed}};
}

std::vector<tables::Column> Columns(const RootLocusStudy& study) {
  std::vector<tables::Column> columns = {{"gain", study.gains}};
  for (size_t b = 0; b < study.branches.size(); ++b) {
    tables::Column re{fmt::format("pole_{}_re_1_s", b + 1), {}},
        im{fmt::format("pole_{}_im_rad_s", b + 1), {}};
    for (const design::Complex& pole : study.branches[b]) {
      re.values.push_back(pole.real());
      im.values.push_back(pole.imag());
    }
    columns.push_back(re);
    columns.push_back(im);
  }
  return columns;
}

Picture LocusPicture(const RootLocusStudy& study) {
  page::Panel locus{
      .x = {.label = "real part, 1/s", .logarithmic = false, .min = -200, .max = 100},
      .y = {.label = "imaginary part, rad/s", .logarithmic = false, .min = -200, .max = 200},
      .notes = {{fmt::format("g = {:.1f} at {:.1f} rad/s", study.limit.gain, study.limit.frequency), 0,
                 study.limit.frequency}},
      .rules = {{"", true, 0}, {"", false, 0}},
      .equal_scales = true,
      .height = 1.8};
  for (size_t b = 0; b < study.branches.size(); ++b) {
    locus.curves.push_back(Points(b == 0 ? "locus over g" : "", study.branches[b], 0, page::Stroke::kLine));
  }
  locus.curves.push_back(Points("open loop, g = 0", study.poles.front(), 1));
  locus.curves.push_back(Points("zero", {design::Complex(-study.design.zero, 0)}, 2));
  locus.curves.push_back(Points(fmt::format("g = {:g}", kPaperGain), study.paper_poles, 3));
  locus.curves.push_back(
      Points(fmt::format("g = {:.1f}", study.limit.gain), design::Poles(study.design, study.limit.gain), 4));
  return {"",
          {.caption = fmt::format(
               "Root locus of Figure 8's model, c_1/c_2 = {:g}, g from 0 to {:g}. The poles cross the "
               "imaginary axis at g = {:.1f}; the paper prints 770.",
               study.design.zero, study.gains.back(), study.limit.gain),
           .panels = {locus}}};
}

// Steps of the loop with one form of the derivative, continuous and sampled.
page::Panel StepPanel(const design::DesignModel& design, size_t f) {
  page::Panel panel;
  panel.title = kForms[f].name;
  panel.x = {.label = "time, s", .logarithmic = false, .min = 0, .max = 0.4};
  panel.y = {
      .label = "α, rad", .logarithmic = false, .min = f == 0 ? -0.05 : 0.0, .max = f == 0 ? 0.25 : 0.2};
  const design::Response continuous =
      design::ContinuousStep(design, kPaperGain, kForms[f].form, kReferenceStep, kRootLocusDuration, 5e-4);
  panel.curves.push_back({"continuous", continuous.time, continuous.angle, page::Stroke::kLine, 0, {}, {}});
  for (size_t t = 0; t < kIntervals.size(); ++t) {
    const double interval = kIntervals[t];
    const design::Response step =
        design::SampledStep(design, kPaperGain, interval, kForms[f].form, kReferenceStep, kRootLocusDuration,
                            static_cast<int>(std::lround(interval / 5e-4)));
    panel.curves.push_back({fmt::format("T = {:g} ms", interval * 1e3),
                            step.time,
                            step.angle,
                            interval == 0.010 ? page::Stroke::kDashed : page::Stroke::kLine,
                            static_cast<int>(t) + 1,
                            {},
                            {}});
  }
  panel.rules = {{"", false, kReferenceStep}};
  return panel;
}

Picture StepsPicture(const RootLocusStudy& study) {
  return {"-steps",
          {.caption = fmt::format(
               "Figure 8's model at g = {:g} under the sampled law: a step of {:g} rad. At T = 10 ms the "
               "loop is unstable.",
               kPaperGain, kReferenceStep),
           .panels = {StepPanel(study.design, 0), StepPanel(study.design, 1)}}};
}

Picture SampledPolesPicture(const RootLocusStudy& study) {
  page::Panel plane{.x = {.label = "real part of z", .logarithmic = false, .min = -1.1, .max = 1.1},
                    .y = {.label = "imaginary part of z", .logarithmic = false, .min = -1.1, .max = 1.1},
                    .rules = {{"", true, 0}, {"", false, 0}},
                    .equal_scales = true,
                    .height = 1.8};
  std::vector<design::Complex> circle;
  for (int i = 0; i <= 360; ++i) circle.push_back(std::polar(1.0, i * kDegree));
  plane.curves.push_back(Points("unit circle", circle, 0, page::Stroke::kDotted));
  for (size_t t = 0; t < study.sampled.size(); ++t) {
    plane.curves.push_back(Points(fmt::format("T = {:g} ms", 1e3 * study.sampled[t].interval),
                                  study.sampled[t].poles, static_cast<int>(t) + 1));
  }
  return {"-sampled",
          {.caption = fmt::format(
               "Poles of the sampled loop at g = {:g}, the same in both forms of the derivative: stable "
               "inside the unit circle.",
               kPaperGain),
           .panels = {plane}}};
}

}  // namespace

ExperimentResult RunFig9(const ExperimentOptions& options) {
  const RootLocusStudy study = RunRootLocusStudy(options);
  ExperimentResult result;
  result.conditions = Conditions(study);
  result.paper_says = "Figure 9: with c_1/c_2 = 30 the loop is stable until g = 770. T is not printed.";
  result.explanation = Explanation(study);
  result.comparisons = Comparisons(study);
  result.findings = Findings(study);
  result.numbers = JsonText(Numbers(study));
  result.table.columns = Columns(study);
  result.pictures = {LocusPicture(study), StepsPicture(study), SampledPolesPicture(study)};
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
