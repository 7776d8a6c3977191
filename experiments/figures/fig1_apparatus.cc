// Figure 1: the apparatus, its schematic, and what its numbers imply.
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "base/units.h"
#include "experiments/figures/catalogue.h"
#include "experiments/figures/drawings.h"
#include "experiments/runs/shipped_models.h"
#include "model/actuator.h"
#include "model/terms/description.h"
#include "page/svg.h"

namespace hydro::experiments {
namespace {

// Figure 1 of the paper as a schematic.

// An <svg> element: amplifier, motor, pump, the two lines with their leakages, one-way valves, accumulator,
// bypass and transducers, the rotary actuator and its arm. Symbols are those of eqs. (1) to (15); the
// parameters stand beside the parts, in the paper's units.
std::string ApparatusDrawing(const model::Parameters& parameters);

std::string ApparatusDrawing(const model::Parameters& p) {
  const auto number = [](double value) { return fmt::format("{:g}", value); };
  return page::FillDrawing(kApparatusDrawing, {{"k_1", number(p.k_1)},
                                               {"T_pmax", number(p.T_pmax)},
                                               {"D", number(p.D)},
                                               {"J", number(p.J)},
                                               {"b", number(p.b)},
                                               {"T_s", number(p.T_s)},
                                               {"f", number(p.f)},
                                               {"beta", number(p.beta)},
                                               {"c_I", fmt::format("{:.1e}", p.c_I)},
                                               {"c_E", fmt::format("{:.1e}", p.c_E)},
                                               {"p_3", number(p.p_3)},
                                               {"V_ms", number(p.V_ms)},
                                               {"c", fmt::format("{:.4g}", p.c)},
                                               {"k_2", number(p.k_2)},
                                               {"J_a", number(p.J_a)}});
}

using nlohmann::ordered_json;

// What the paper prints.
constexpr double kPrintedRatio = 484.7;
constexpr double kPressureLimit = 2000;          // psi, limit of the actuator's seals
constexpr double kMotorRpm = 6000;               // the motor used in the experiments
constexpr double kFastMotorRpm = 18000;          // the other motor
constexpr double kArmLength = 24;                // in; ASSUMPTION of table1_gravity.toml
constexpr double kKilowatts = kInchPound / 1e3;  // in one in-lbf/s

struct FreeRun {
  tables::Table table;
  double speed_ratio = 0;  // motor angle per arm angle, over the whole run
  double arm_speed = 0;    // rad/s, at the motor's top speed
};

// The run of the arm, free and without gravity, from one end of its travel: full torque until the motor
// reaches `top_speed`, then just the torque that holds this speed.
FreeRun RunFree(const model::ModelDescription& model, double top_speed) {
  const model::Parameters& p = model.parameters;
  constexpr double kTick = 1e-3;
  constexpr int kHold = 250;      // ticks at top speed
  constexpr int kAveraged = 200;  // of these: hydraulic oscillations are faster
  model::Actuator actuator(model, {.shaft = model::Shaft::kFree, .arm_angle = -0.75});
  FreeRun run;
  const char* names[] = {"time_s",        "voltage_V",       "motor_angle_rad", "motor_speed_rad_s",
                         "arm_angle_rad", "arm_speed_rad_s", "p1_psi",          "p2_psi"};
  for (const char* name : names) run.table.columns.push_back({name, {}});
  const model::Measurement start = actuator.Measure();
  double averaged_from = 0;
  for (int tick = 0, held = 0; held <= kHold && tick < 5000; ++tick) {
    const model::Measurement now = actuator.Measure();
    if (now.motor_speed >= top_speed || held > 0) ++held;
    const double voltage = (held > 0 ? p.b * top_speed + p.T_s : p.T_pmax) / p.k_1;
    const double row[] = {actuator.time(), voltage,       now.motor_angle, now.motor_speed,
                          now.arm_angle,   now.arm_speed, now.p1,          now.p2};
    for (size_t i = 0; i < std::size(row); ++i) run.table.columns[i].values.push_back(row[i]);
    if (held == kHold - kAveraged) averaged_from = now.arm_angle;
    if (held == kHold) run.arm_speed = (now.arm_angle - averaged_from) / (kAveraged * kTick);
    run.speed_ratio = (now.motor_angle - start.motor_angle) / (now.arm_angle - start.arm_angle);
    actuator.Advance(voltage, (tick + 1) * kTick);
  }
  return run;
}

// The arm's torque against a clamp, in-lbf, once a held motor torque has stopped everything but the leakage.
double HeldTorque(const model::ModelDescription& model, double motor_torque) {
  model::Actuator actuator(model, {.shaft = model::Shaft::kClamped});
  for (int i = 1; i <= 40; ++i) actuator.Advance(motor_torque / model.parameters.k_1, i);
  const model::Measurement m = actuator.Measure();
  return model.parameters.k_2 * (m.p2 - m.p1);
}

// The speed, rad/s, at which full voltage drives the motor with the bypass open.
double UnlimitedSpeed(const model::ModelDescription& model) {
  const model::Parameters& p = model.parameters;
  model::Actuator actuator(model, {.shaft = model::Shaft::kClamped, .bypass = true});
  for (int i = 1; i <= 60; ++i) actuator.Advance(p.T_pmax / p.k_1, i * 0.5);
  return actuator.Measure().motor_speed;
}

std::string InSi(double torque) { return fmt::format("{:.0f} N m", torque * kInchPound); }

// The arm's torque over its speed, up to `top_speed` of the motor, rad/s, after `viscous` and `coulomb`
// friction take their share of the motor's torque.
page::Curve Envelope(const std::string& label, const model::Parameters& p, double top_speed, double viscous,
                     double coulomb) {
  page::Curve curve;
  curve.label = label;
  for (const double speed : {0.0, top_speed}) {
    curve.x.push_back(speed * p.D / p.c / kRpm);
    curve.y.push_back((p.T_pmax - coulomb - viscous * speed) * p.k_2 / p.D);
  }
  curve.x.push_back(curve.x.back());
  curve.y.push_back(0);
  return curve;
}

page::Figure Limits(const model::Parameters& p) {
  page::Panel panel;
  const double top_speed = kMotorRpm * kRpm;
  panel.x = {"arm speed α', rpm", false, 0, 15};
  panel.y = {"arm torque, in-lbf", false, 0, 22000};
  const double printed_torque = p.T_pmax * kPrintedRatio;
  const double printed_speed = kMotorRpm / kPrintedRatio;
  const page::Curve printed{fmt::format("as printed, ratio {:g}", kPrintedRatio),
                            {0, printed_speed, printed_speed},
                            {printed_torque, printed_torque, 0},
                            page::Stroke::kDashed,
                            1,
                            {},
                            {}};
  panel.curves = {Envelope("Table 1, with friction", p, top_speed, p.b, p.T_s), printed,
                  Envelope("Table 1, without friction", p, top_speed, 0, 0)};
  panel.rules = {{fmt::format("Δp = {:.0f} psi, the limit of the seals", kPressureLimit), false,
                  kPressureLimit * p.k_2}};
  return {fmt::format("What the motor's limits, {:g} in-lbf and {:g} rpm, leave for the arm: the torque k_2 "
                      "(T_pmax - T_s - b θ')/D up to the speed {:g} rpm D/c. Also shown: the same with the "
                      "printed ratio, and the limit of the seals.",
                      p.T_pmax, kMotorRpm, kMotorRpm),
          {panel},
          ""};
}

constexpr double kTopSpeed = kMotorRpm * kRpm;
// in-lbf, held against the clamp. Coulomb friction is the same at both torques.
constexpr double kLowTorque = 8;
constexpr double kHighTorque = 16;

// The results of the runs, and what Table 1 implies.
struct Apparatus {
  model::Parameters p;
  model::Parameters fast;     // of the 18000 rpm motor
  double gravity_torque = 0;  // of table1_gravity.toml

  FreeRun free;
  FreeRun fast_run;
  double torque_ratio = 0;  // arm torque per motor torque, clamped
  double unlimited = 0;     // rad/s

  double torque_ratio_lossless = 0;
  double torque_ratio_leaking = 0;
  double displacement_ratio = 0;
  double needed_k2 = 0;  // the k_2 that the printed ratio needs
  double peak = 0;       // in-lbf at the arm
  double peak_with_friction = 0;
  double at_limit = 0;        // in-lbf at the seals' limit on dp
  double at_limit_gauge = 0;  // the same with the low side at p_3
  double reflected = 0;       // lbf-in-s^2 at the arm
  double reflected_fast = 0;
  double unlimited_expected = 0;  // rad/s
  double arm_mass = 0;            // lbf-s^2/in, of a uniform slender arm
  double arm_mgl = 0;             // in-lbf
};

void SolveInClosedForm(Apparatus* a) {
  const model::Parameters& p = a->p;
  const model::Parameters& fast = a->fast;
  a->torque_ratio_lossless = p.k_2 / p.D;
  // When everything but the leakage is at rest, the pump turns at (c_I + c_E) dp / D, and viscous friction
  // takes its share.
  a->torque_ratio_leaking = p.k_2 / (p.D + p.b * (p.c_I + p.c_E) / p.D);
  a->displacement_ratio = 1.83 * 1.83 * 2.20 / 2 / 0.00796;  // Table 1's r, d and D
  a->needed_k2 = kPrintedRatio * p.D;
  a->peak = p.T_pmax * a->torque_ratio_lossless;
  a->peak_with_friction = (p.T_pmax - p.T_s) * a->torque_ratio_lossless;
  a->at_limit = p.k_2 * kPressureLimit;
  a->at_limit_gauge = p.k_2 * (kPressureLimit - p.p_3);
  a->reflected = p.J * std::pow(p.c / p.D, 2);
  a->reflected_fast = fast.J * std::pow(fast.c / fast.D, 2);
  a->unlimited_expected = (p.T_pmax - p.T_s) / p.b;
  a->arm_mass = 3 * p.J_a / (kArmLength * kArmLength);
  a->arm_mgl = a->arm_mass * kGravity * kArmLength / 2;
}

Apparatus RunApparatus(const ExperimentOptions& options) {
  const model::ModelDescription model = ShippedModel("table1");
  const model::ModelDescription fast_model = ShippedModel("motor_18000rpm");
  Apparatus apparatus;
  apparatus.p = model.parameters;
  apparatus.fast = fast_model.parameters;
  apparatus.gravity_torque = ShippedModel("table1_gravity").parameters.mgl;
  apparatus.free = RunFree(model, kTopSpeed);
  apparatus.fast_run = RunFree(fast_model, kFastMotorRpm * kRpm);
  options.progress(0.3);
  apparatus.torque_ratio =
      (HeldTorque(model, kHighTorque) - HeldTorque(model, kLowTorque)) / (kHighTorque - kLowTorque);
  options.progress(0.8);
  apparatus.unlimited = UnlimitedSpeed(model);
  SolveInClosedForm(&apparatus);
  return apparatus;
}

std::vector<Comparison> Comparisons(const Apparatus& a) {
  const model::Parameters& p = a.p;
  const model::Parameters& fast = a.fast;
  return {
      {"transmission ratio of speeds, θ'/α'", "", "484.7", a.displacement_ratio, a.free.speed_ratio,
       "independent: r^2 d/(2 D) of Table 1; here: the angles turned, free arm"},
      {"transmission ratio of torques, k_2/D", "", "484.7", a.torque_ratio_lossless, a.torque_ratio,
       fmt::format("here: clamped, at rest except for leakage, which costs {:.2f} % through viscous friction",
                   100 * (1 - a.torque_ratio / a.torque_ratio_lossless))},
      {"k_2 that a ratio of 484.7 needs", "in-lbf/psi", "3.68", a.needed_k2, a.needed_k2,
       "k_2 = 484.7 D; the paper prints 3.68, \"from the transmission ratio\""},
      {"theoretical peak torque", "in-lbf", "19388", p.T_pmax * kPrintedRatio, a.peak,
       fmt::format("independent: 40 in-lbf times 484.7; here: T_pmax k_2/D, {}", InSi(a.peak))},
      {"peak torque less friction T_s", "in-lbf", "", page::kAutomatic, a.peak_with_friction,
       fmt::format("{}; it needs dp = {:.0f} psi", InSi(a.peak_with_friction), (p.T_pmax - p.T_s) / p.D)},
      {"torque at dp = 2000 psi", "in-lbf", "about 7300", page::kAutomatic, a.at_limit,
       fmt::format("k_2 2000 psi, {}; \"600 ft-lb\" is 7200 in-lb", InSi(a.at_limit))},
      {"torque at p_2 = 2000 psi, p_1 = p_3", "in-lbf", "about 7300", page::kAutomatic, a.at_limit_gauge,
       fmt::format("the low side keeps the accumulator's {:g} psi; {}", p.p_3, InSi(a.at_limit_gauge))},
      {"motor torque for dp = 2000 psi", "in-lbf", "", page::kAutomatic, p.D * kPressureLimit + p.T_s,
       "D 2000 psi + T_s: half of the motor's peak torque"},
      {"maximum arm speed", "rpm", "12.4", kMotorRpm / kPrintedRatio, a.free.arm_speed / kRpm,
       fmt::format("independent: 6000 rpm/484.7; here: free arm at 6000 rpm of the motor, {:.3f} rad/s",
                   a.free.arm_speed)},
      {"motor speed at full voltage, no load", "rpm", "6000", a.unlimited_expected / kRpm, a.unlimited / kRpm,
       "eqs. (1) to (15) do not limit the speed: only friction balances the torque, (T_pmax - T_s)/b"},
      {"voltage that holds 6000 rpm, no load", "V", "", page::kAutomatic, (p.b * kTopSpeed + p.T_s) / p.k_1,
       "(b θ' + T_s)/k_1; whoever commands the motor must respect its limit"},
      {"motor and pump inertia seen by the arm", "lbf-in-s^2", "", page::kAutomatic, a.reflected,
       fmt::format("J (c/D)^2, {:.0f} times J_a = {:g}", a.reflected / p.J_a, p.J_a)},
      {"m g l of a uniform slender arm", "in-lbf", "", a.arm_mgl, a.gravity_torque,
       fmt::format("assumed: J_a = m L^2/3 with L = {:g} in; here: table1_gravity.toml. It holds with dp = "
                   "{:.1f} psi",
                   kArmLength, a.gravity_torque / p.k_2)},
      {"18000 rpm motor: transmission ratio", "", "", 3 * a.torque_ratio_lossless, fast.k_2 / fast.D,
       "assumed: the same power, torque and speed at the arm, so a pump of D/3"},
      {"18000 rpm motor: peak torque at the arm", "in-lbf", "", a.peak, fast.T_pmax * fast.k_2 / fast.D,
       "independent: the 6000 rpm motor's"},
      {"18000 rpm motor: maximum arm speed", "rpm", "", kMotorRpm * p.D / p.c, a.fast_run.arm_speed / kRpm,
       "independent: 6000 rpm D/c of Table 1; here: its free arm"},
      {"18000 rpm motor: inertia seen by the arm", "lbf-in-s^2", "", a.reflected * std::pow(3.0, 2 - 5.0 / 3),
       a.reflected_fast,
       "independent: J grows as T_pmax^{5/3} for motors of one shape, and at the arm with the ratio squared"},
      {"18000 rpm motor: time to full speed", "s", "", page::kAutomatic,
       fast.J * kFastMotorRpm * kRpm / fast.T_pmax,
       fmt::format("J θ'/T_pmax without load and friction; the 6000 rpm motor: {:.2f} s",
                   p.J * kTopSpeed / p.T_pmax)},
  };
}

std::string Explanation(const Apparatus& a) {
  return fmt::format(
      "Table 1 gives two ratios, {displacement_ratio:.1f} from displacements and {torque_ratio:.1f} from "
      "torques. They agree within {apart_percent:.1f} %, as conservation of energy demands, but the printed "
      "484.7 is {printed_percent:.1f} % higher. With Table 1 the peak torque is {peak:.0f} in-lbf instead of "
      "19388, and the maximum speed is {speed:.2f} rpm instead of 12.4. The torque that the seals allow fits "
      "\"about 7300\": {at_limit:.0f} in-lbf, or {at_limit_gauge:.0f} if the low side's {p_3:g} psi count.",
      fmt::arg("displacement_ratio", a.displacement_ratio), fmt::arg("torque_ratio", a.torque_ratio_lossless),
      fmt::arg("apart_percent", 100 * std::abs(a.displacement_ratio / a.torque_ratio_lossless - 1)),
      fmt::arg("printed_percent", 100 * (kPrintedRatio / a.torque_ratio_lossless - 1)),
      fmt::arg("peak", a.peak), fmt::arg("speed", a.free.arm_speed / kRpm), fmt::arg("at_limit", a.at_limit),
      fmt::arg("at_limit_gauge", a.at_limit_gauge), fmt::arg("p_3", a.p.p_3));
}

std::vector<Finding> Findings(const Apparatus& a) {
  const model::Parameters& p = a.p;
  return {{2,
           "The text gives the transmission ratio as 484.7:1; Table 1 has k_2 = 3.68 \"from the transmission "
           "ratio\" and D = 0.00796.",
           fmt::format("k_2/D = {:.1f} (measured on the clamped model: {:.1f}), c/D = {:.1f} (measured on "
                       "the free arm: {:.1f}); 484.7 would need k_2 = {:.3f}.",
                       a.torque_ratio_lossless, a.torque_ratio, p.c / p.D, a.free.speed_ratio, a.needed_k2),
           "k_2 and D stay as in Table 1; both ratios are stated."},
          {6, "The mass m and length l of the arm are not printed, only J_a.",
           fmt::format("m g l is free: 0 in table1.toml, {:g} in-lbf in table1_gravity.toml, that of a "
                       "uniform slender arm of {:g} in (m = 3 J_a/L^2 = {:.4f} lbf-s^2/in, m g L/2 = {:.1f} "
                       "in-lbf). Holding it takes {:.1f} psi, {:.1f} % of the seals' limit.",
                       a.gravity_torque, kArmLength, a.arm_mass, a.arm_mgl, a.gravity_torque / p.k_2,
                       100 * a.gravity_torque / p.k_2 / kPressureLimit),
           "Two model files, both marked as assumptions; the figures use 0 unless they say otherwise."}};
}

ordered_json Numbers(const Apparatus& a) {
  const model::Parameters& p = a.p;
  const model::Parameters& fast = a.fast;
  return {{"printed_ratio", kPrintedRatio},
          {"torque_ratio", a.torque_ratio_lossless},
          {"torque_ratio_measured", a.torque_ratio},
          {"torque_ratio_with_leakage", a.torque_ratio_leaking},
          {"displacement_ratio", p.c / p.D},
          {"displacement_ratio_measured", a.free.speed_ratio},
          {"k_2_for_printed_ratio_in_lbf_per_psi", a.needed_k2},
          {"peak_torque_printed_in_lbf", p.T_pmax * kPrintedRatio},
          {"peak_torque_in_lbf", a.peak},
          {"peak_torque_N_m", a.peak * kInchPound},
          {"peak_torque_less_friction_in_lbf", a.peak_with_friction},
          {"torque_at_2000_psi_in_lbf", a.at_limit},
          {"torque_at_2000_psi_N_m", a.at_limit * kInchPound},
          {"torque_at_2000_psi_above_accumulator_in_lbf", a.at_limit_gauge},
          {"maximum_speed_printed_rpm", kMotorRpm / kPrintedRatio},
          {"maximum_speed_rpm", a.free.arm_speed / kRpm},
          {"maximum_speed_rad_s", a.free.arm_speed},
          {"unlimited_motor_speed_rpm", a.unlimited / kRpm},
          {"reflected_inertia_lbf_in_s2", a.reflected},
          {"gravity_torque_assumed_in_lbf", a.gravity_torque},
          {"motor_18000rpm",
           {{"assumption", true},
            {"peak_torque_in_lbf", fast.T_pmax * fast.k_2 / fast.D},
            {"maximum_speed_rpm", a.fast_run.arm_speed / kRpm},
            {"ratio", fast.k_2 / fast.D},
            {"power_kW", fast.T_pmax * kFastMotorRpm * kRpm * kKilowatts},
            {"reflected_inertia_lbf_in_s2", a.reflected_fast}}}};
}

}  // namespace

ExperimentResult RunFig1(const ExperimentOptions& options) {
  Apparatus apparatus = RunApparatus(options);
  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1. Speeds: the free arm swings through its travel, driven up to {:.0f} rpm of the motor. "
      "Torques: the clamped arm, motor torques of {:g} and {:g} in-lbf held for 40 s. The 18000 rpm motor is "
      "a model file of its own (config/models/motor_18000rpm.toml), an assumption where the paper is silent.",
      kMotorRpm, kLowTorque, kHighTorque);
  result.paper_says =
      "A 6000 rpm motor with a peak torque of 40 in-lb is geared down hydraulically with a ratio of 484.7:1, "
      "for a theoretical peak torque of 19388 in-lb and a maximum speed of 12.4 rpm. The seals of the "
      "actuator limit the pressure to 2000 psi and the torque to about 7300 in-lb. An 18000 rpm motor also "
      "worked very well but needed large cooling fins.";
  result.comparisons = Comparisons(apparatus);
  result.explanation = Explanation(apparatus);
  result.findings = Findings(apparatus);
  result.numbers = hydro::JsonText(Numbers(apparatus));
  result.pictures = {{"",
                      {"The apparatus, after Figure 1 and eqs. (1) to (15), with the numbers of Table 1; "
                       "leakages in in^3/(s psi). Arrows show the directions in which θ', q_1, q_2 and α "
                       "count as positive. Dashed pipes are leakages.",
                       {},
                       ApparatusDrawing(apparatus.p)}},
                     {"-limits", Limits(apparatus.p)}};
  result.table = std::move(apparatus.free.table);
  return result;
}

}  // namespace hydro::experiments
