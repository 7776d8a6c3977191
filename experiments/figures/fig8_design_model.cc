// Figure 8: the paper's linear design model of the position loop, and what it leaves out.
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/units.h"
#include "experiments/figures/catalogue.h"
#include "experiments/figures/drawings.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/position_loop.h"
#include "page/svg.h"
#include "tune/design/arm_loop.h"
#include "tune/design/position_design.h"

namespace hydro::experiments {
namespace {

// The drawing of the paper's Figure 8: the position loop's block diagram with its numbers.

// An <svg> element for Figure::drawing.
std::string DrawPositionLoop(const design::DesignModel& model, double gain);

std::string DrawPositionLoop(const design::DesignModel& m, double gain) {
  const auto number = [](double value) { return fmt::format("{:g}", value); };
  return page::FillDrawing(kPositionLoopDrawing,
                           {{"zero", number(m.zero)},
                            {"omega_n", number(m.natural_frequency)},
                            {"omega_n_squared", number(m.natural_frequency * m.natural_frequency)},
                            {"two_zeta_omega_n", number(2 * m.damping_ratio * m.natural_frequency)},
                            {"zeta", number(m.damping_ratio)},
                            {"k_2", number(m.k_2)},
                            {"J_a", number(m.J_a)},
                            {"gain", number(gain)},
                            {"c_1", number(m.zero * gain)},
                            {"c_2", number(gain)}});
}

using nlohmann::json;

double Decibel(const design::Complex& z) { return 20 * std::log10(std::abs(z)); }

// Degrees, unwrapped from the previous value.
double Phase(const design::Complex& z, double previous) {
  const double phase = Degrees(std::arg(z));
  return phase + 360 * std::round((previous - phase) / 360);
}

struct Bode {
  std::vector<double> frequency, open_db, open_deg, closed_db, closed_deg;
  std::vector<double> clamped_db, free_db, feedforward_db, design_db;
};

// Figure 8's model beside exact linearisations of Table 1's model.
struct DesignStudy {
  model::Parameters p;
  design::DesignModel design;
  design::StabilityLimit limit;
  design::Margins margins;

  // The pressure loop that eq. (16) closes around the real model, with the arm clamped.
  pressure_ctrl::PressureLawSettings law;
  pressure_ctrl::SecondOrder two_sided;
  pressure_ctrl::SecondOrder one_sided;
  // Poles of the whole loop with the arm free.
  double reflected = 0;  // lbf-in-s^2, the pump's inertia at the arm
  std::vector<design::Complex> exact;
  std::vector<design::Complex> exact_assisted;  // with arm-speed feed-forward
  std::vector<design::Complex> without_motion;  // without the flow that the arm's motion forces
  Bode bode;
};

Bode SweepFrequencies(const DesignStudy& study, const design::LinearArmLoop& arm,
                      const design::LinearArmLoop& assisted) {
  const model::Parameters& p = study.p;
  const design::DesignModel& design = study.design;
  Bode bode;
  double open_phase = -180, closed_phase = 0;
  for (int i = 0; i <= 400; ++i) {
    const double w = std::pow(10.0, 3.0 * i / 400);  // 1 to 1000 rad/s
    const design::Complex open = design::OpenLoop(design, kPaperGain, w);
    const design::Complex closed =
        design::ClosedLoop(design, kPaperGain, design::DerivativeForm::kMeasurement, w);
    bode.frequency.push_back(w);
    bode.open_db.push_back(Decibel(open));
    bode.open_deg.push_back(open_phase = Phase(open, open_phase));
    bode.closed_db.push_back(Decibel(closed));
    bode.closed_deg.push_back(closed_phase = Phase(closed, closed_phase));
    const design::Complex s(0, w);
    const auto second_order = [&](double natural, double damping) {
      return natural * natural / (s * s + 2 * damping * natural * s + natural * natural);
    };
    bode.design_db.push_back(Decibel(second_order(design.natural_frequency, design.damping_ratio)));
    bode.clamped_db.push_back(
        Decibel(p.k_1 * study.law.gains.k_p / (p.D + p.k_1 * study.law.gains.k_p) *
                second_order(study.two_sided.natural_frequency, study.two_sided.damping_ratio)));
    bode.free_db.push_back(Decibel(arm.Pressure(w)));
    bode.feedforward_db.push_back(Decibel(assisted.Pressure(w)));
  }
  return bode;
}

DesignStudy RunDesignStudy(const ExperimentOptions& options) {
  const model::ModelDescription table1 = ShippedModel("table1");
  DesignStudy study;
  study.p = table1.parameters;
  study.design = design::Figure8Model(study.p);
  const model::Parameters& p = study.p;
  const design::DesignModel& design = study.design;
  study.limit = design::RouthLimit(design);
  study.margins = design::StabilityMargins(design, kPaperGain);

  study.law.gains =
      pressure_ctrl::DerivePressureGains(p, 0, design.natural_frequency, design.damping_ratio, 2);
  study.two_sided = design::ExactPressureLoop(table1, study.law, 2);
  study.one_sided = design::ExactPressureLoop(table1, study.law, 1);

  const double c1 = design.zero * kPaperGain, c2 = kPaperGain;
  const design::LinearArmLoop arm(table1, study.law);
  study.exact = arm.Poles(c1, c2);
  study.reflected = p.J * std::pow(p.c / p.D, 2);
  pressure_ctrl::PressureLawSettings feedforward = study.law;
  feedforward.arm_speed_ratio = p.c / p.D;
  const design::LinearArmLoop assisted(table1, feedforward);
  study.exact_assisted = assisted.Poles(c1, c2);
  // If the displacement does not respond to the arm's motion, the result must be Figure 8. This checks that
  // nothing else differs.
  model::ModelDescription still = table1;
  still.parameters.c *= 1e-9;
  study.without_motion = design::LinearArmLoop(still, study.law).Poles(c1, c2);
  options.progress(0.5);

  study.bode = SweepFrequencies(study, arm, assisted);
  return study;
}

std::string Conditions(const DesignStudy& study) {
  return fmt::format(
      "Linear: PD with c_1/c_2 = {:g} and g = {:g}, pressure loop with ω_n = {:g} rad/s and ζ = {:g}, k_2 = "
      "{:g} in-lbf/psi, J_a = {:g} lbf-in-s². Beside it the exact linearisation of Table 1's model at "
      "mid-stroke, the pump slipping and both sides compressing, under eq. (16) with k_p = {:.4f} V/psi and "
      "k_v = {:.3f} psi s/rad.",
      study.design.zero, kPaperGain, study.design.natural_frequency, study.design.damping_ratio, study.p.k_2,
      study.p.J_a, study.law.gains.k_p, study.law.gains.k_v);
}

std::string Explanation(const DesignStudy& study) {
  return fmt::format(
      "With the arm clamped, the model under eq. (16) is that second-order system: the exact linearisation "
      "has ω_n = {omega:.2f} rad/s and ζ = {zeta:.4f} (the difference from {design_omega:g} and "
      "{design_zeta:g} is leakage); with one side held by its valve it has {one_sided_omega:.1f} rad/s and "
      "{one_sided_zeta:.3f}. With the arm free it is a different system: α' forces the pump to turn c/D = "
      "{ratio:.1f} times as fast, eq. (16) brakes that speed through k_v, and the arm carries the pump's "
      "inertia, J (c/D)² = {reflected:.0f} lbf-in-s² against J_a = {J_a:g}. The slowest of the design's four "
      "poles at g = {g:g} is at {design_pole:.1f} 1/s; here a slow pole at {slow_pole:.2f} 1/s dominates. "
      "Feeding (c/D) α' forward removes the braking; the inertia stays, and the dominant poles are "
      "{assisted_pole}. With the arm's motion removed from the flow equations (c → 0), the exact model has "
      "Figure 8's poles again except for leakage, {first_pole} and {last_pole}: nothing else is missing.",
      fmt::arg("omega", study.two_sided.natural_frequency), fmt::arg("zeta", study.two_sided.damping_ratio),
      fmt::arg("design_omega", study.design.natural_frequency),
      fmt::arg("design_zeta", study.design.damping_ratio),
      fmt::arg("one_sided_omega", study.one_sided.natural_frequency),
      fmt::arg("one_sided_zeta", study.one_sided.damping_ratio), fmt::arg("ratio", study.p.c / study.p.D),
      fmt::arg("reflected", study.reflected), fmt::arg("J_a", study.p.J_a),
      fmt::arg("slow_pole", SlowestPole(study.exact).real()), fmt::arg("g", kPaperGain),
      fmt::arg("design_pole", SlowestPole(design::Poles(study.design, kPaperGain)).real()),
      fmt::arg("assisted_pole", PoleText(SlowestPole(study.exact_assisted))),
      fmt::arg("first_pole", PoleText(study.without_motion.front())),
      fmt::arg("last_pole", PoleText(SlowestPole(study.without_motion))));
}

std::vector<Comparison> Comparisons(const DesignStudy& study) {
  return {
      {"ω_n of the pressure loop, clamped", "rad/s", "150", study.design.natural_frequency,
       study.two_sided.natural_frequency, "exact linearisation, both sides compressing"},
      {"ζ of the pressure loop, clamped", "", ".5", study.design.damping_ratio, study.two_sided.damping_ratio,
       "the same"},
      {"ω_n, one side held at p_3", "rad/s", "150",
       pressure_ctrl::PressureLoopDynamics(study.p, 0, study.law.gains, 1).natural_frequency,
       study.one_sided.natural_frequency, "the mode in which the loop works at rest at p_3"},
      {"gain margin at g = 350", "", "2.2 (770/350)", study.limit.gain / kPaperGain, study.margins.gain, ""},
      {"phase margin at g = 350", "degrees", "", page::kAutomatic, study.margins.phase_deg,
       fmt::format("at {:.1f} rad/s", study.margins.gain_crossover)},
      {"slowest pole at g = 350, arm free", "1/s", "",
       -SlowestPole(design::Poles(study.design, kPaperGain)).real(), -SlowestPole(study.exact).real(),
       "expected: of Figure 8's model; here: of the exact one"},
      {"reflected inertia of the pump", "lbf-in-s^2", "", page::kAutomatic, study.reflected,
       fmt::format("J_a = {:g}; Figure 8 has J_a alone", study.p.J_a)}};
}

json Numbers(const DesignStudy& study) {
  return {{"gain", kPaperGain},
          {"critical_gain", study.limit.gain},
          {"critical_frequency_rad_s", study.limit.frequency},
          {"poles_at_350", AsPairs(design::Poles(study.design, kPaperGain))},
          {"gain_margin", study.margins.gain},
          {"gain_margin_db", 20 * std::log10(study.margins.gain)},
          {"phase_margin_deg", study.margins.phase_deg},
          {"gain_crossover_rad_s", study.margins.gain_crossover},
          {"bandwidth_rad_s", study.margins.bandwidth},
          {"linearised",
           {{"both_sides",
             {{"natural_frequency_rad_s", study.two_sided.natural_frequency},
              {"damping_ratio", study.two_sided.damping_ratio}}},
            {"one_side",
             {{"natural_frequency_rad_s", study.one_sided.natural_frequency},
              {"damping_ratio", study.one_sided.damping_ratio}}}}},
          {"free_arm",
           {{"reflected_inertia_lb_in_s2", study.reflected},
            {"arm_inertia_lb_in_s2", study.p.J_a},
            {"poles_at_350", AsPairs(study.exact)},
            {"poles_at_350_with_arm_speed_feedforward", AsPairs(study.exact_assisted)},
            {"poles_at_350_without_arm_flow", AsPairs(study.without_motion)}}}};
}

std::vector<tables::Column> Columns(const Bode& bode) {
  return {{"frequency_rad_s", bode.frequency},
          {"open_loop_db", bode.open_db},
          {"open_loop_deg", bode.open_deg},
          {"closed_loop_db", bode.closed_db},
          {"closed_loop_deg", bode.closed_deg},
          {"pressure_design_db", bode.design_db},
          {"pressure_clamped_db", bode.clamped_db},
          {"pressure_free_arm_db", bode.free_db},
          {"pressure_free_arm_feedforward_db", bode.feedforward_db}};
}

Picture DiagramPicture(const design::DesignModel& design) {
  return {"",
          {.caption =
               fmt::format("The design model of the position loop with its numbers, as the paper's Figure 8. "
                           "Continuous time; eq. (17) samples it. e = α - α_ref, g = {:g}.",
                           kPaperGain),
           .drawing = DrawPositionLoop(design, kPaperGain)}};
}

page::Axis FrequencyAxis() {
  return {.label = "frequency, rad/s", .logarithmic = true, .min = 1, .max = 1000};
}

page::Curve OverFrequency(const Bode& bode, const std::string& label, const std::vector<double>& y,
                          int colour, page::Stroke stroke = page::Stroke::kLine) {
  return {label, bode.frequency, y, stroke, colour, {}, {}};
}

Picture BodePicture(const DesignStudy& study) {
  const Bode& bode = study.bode;
  const design::Margins& margins = study.margins;
  page::Panel magnitude{
      .title = "Magnitude",
      .x = FrequencyAxis(),
      .y = {.label = "dB", .min = -80, .max = 60},
      .curves = {OverFrequency(bode, "open loop, -e to α", bode.open_db, 0),
                 OverFrequency(bode, "closed loop, α_ref to α", bode.closed_db, 1)},
      .notes = {{fmt::format("gain margin {:.2f} ({:.1f} dB)", margins.gain, 20 * std::log10(margins.gain)),
                 margins.phase_crossover, -20 * std::log10(margins.gain)}},
      .rules = {{"", false, 0}}};
  page::Panel phase{
      .title = "Phase",
      .x = FrequencyAxis(),
      .y = {.label = "degrees", .min = -360, .max = 0},
      .curves = {OverFrequency(bode, "", bode.open_deg, 0), OverFrequency(bode, "", bode.closed_deg, 1)},
      .notes = {{fmt::format("phase margin {:.1f}°", margins.phase_deg), margins.gain_crossover,
                 margins.phase_deg - 180}},
      .rules = {{"", false, -180}}};
  return {"-bode",
          {.caption = fmt::format(
               "Figure 8's model at g = {:g}: open loop with its margins, and closed loop with the "
               "derivative on the measurement.",
               kPaperGain),
           .panels = {magnitude, phase}}};
}

Picture FreeArmPicture(const Bode& bode) {
  page::Panel pressure{
      .title = "Δp over Δp_ref",
      .x = FrequencyAxis(),
      .y = {.label = "dB", .min = -70, .max = 30},
      .curves = {
          OverFrequency(bode, "Figure 8", bode.design_db, 0),
          OverFrequency(bode, "exact, arm clamped", bode.clamped_db, 1, page::Stroke::kDashed),
          OverFrequency(bode, "exact, arm free", bode.free_db, 2),
          OverFrequency(bode, "exact, arm free, with arm-speed feed-forward", bode.feedforward_db, 3)}};
  return {"-free-arm",
          {.caption = "The pressure loop once the arm may move, where Figure 8 assumes the clamped loop. "
                      "Exact linearisations of Table 1's model at mid-stroke under eq. (16).",
           .panels = {pressure}}};
}

}  // namespace

ExperimentResult RunFig8(const ExperimentOptions& options) {
  const DesignStudy study = RunDesignStudy(options);
  ExperimentResult result;
  result.conditions = Conditions(study);
  result.paper_says =
      "Figure 8 is the model used to choose c_1 and c_2: the closed pressure loop as a second-order system "
      "with ω_n = 150 rad/s and ζ = .5, then k_2 and 1/(J_a s²), in continuous time although the loop is "
      "digital.";
  result.explanation = Explanation(study);
  result.comparisons = Comparisons(study);
  result.numbers = JsonText(Numbers(study));
  result.table.columns = Columns(study.bode);
  result.pictures = {DiagramPicture(study.design), BodePicture(study), FreeArmPicture(study.bode)};
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
