#include "tune/search/unsettled.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "runs/step_response.h"
#include "tune/design/configured_laws.h"

namespace hydro::tune {
namespace {

// Of the last part, and of the whole trial: a limit that is reached for less of it does not decide.
constexpr double kMostOfTheEnd = 0.3;
constexpr double kMuchOfTheTrial = 0.2;

std::string ThreeDigits(double value) { return ShortNumber(value, 3); }

class Unsettled {
 public:
  Unsettled(const StepJudge& judge, const Gains& gains, const StepCase& step)
      : config_(judge.config()), units_(config_.model.description.units), step_(step) {
    result_ = judge.Try(gains, step, &run_);
    friction_ = FrictionError(config_, gains);
  }

  std::string Why() const {
    if (result_.settled && result_.ratio < kStopped) return "";
    if (run_.response.angle.empty()) return "the arm runs into the end of its stroke";
    if (std::string ended = EndedBy(); !ended.empty()) return ended;
    const double end = kLastPart * run_.response.time.back(), whole = run_.response.time.back();
    if (run_.held_back_at_end > kMostOfTheEnd * end) return ArmTorque("to the end of");
    if (run_.saturated_at_end > kMostOfTheEnd * end) return MotorTorque("to the end of");
    if (FrictionHolds()) {
      return fmt::format("the pump's friction T_s holds the arm {} from its target",
                         Arm(std::fabs(result_.error)));
    }
    if (run_.held_back > kMuchOfTheTrial * whole) return ArmTorque(Share(run_.held_back / whole));
    if (run_.saturated > kMuchOfTheTrial * whole) return MotorTorque(Share(run_.saturated / whole));
    return "no limit is reached for long: it is the gains";
  }

 private:
  static std::string Share(double share) {
    return fmt::format("in {} % of", ThreeDigits(std::round(100 * share)));
  }
  std::string Arm(double value) const { return ThreeDigits(value) + " " + units_.UnitFor("rad", 1); }
  std::string ArmTorque(const std::string& when) const {
    return fmt::format("limits.arm_torque {} {} holds it back {} that time",
                       ThreeDigits(config_.limits.arm_torque_in_lbf), units_.UnitFor("in-lbf", -1), when);
  }
  std::string MotorTorque(const std::string& when) const {
    return fmt::format("the motor is at its torque T_pmax {} {} {} that time",
                       ThreeDigits(config_.model.description.parameters.T_pmax), units_.UnitFor("in-lbf"),
                       when);
  }

  // The limit that ends the run of a stack. Only the model as its file says is held against limits.
  std::string EndedBy() const {
    if (step_.model != 0) return "";
    const settings::LimitsSection& limits = config_.limits;
    const auto ends = [](const char* name, double limit, double reached, const std::string& unit) {
      return fmt::format("limits.{} {} {} ends the run, at {} {}", name, ThreeDigits(limit), unit,
                         ThreeDigits(reached), unit);
    };
    if (run_.highest_pressure > limits.pressure_psi)
      return ends("pressure", limits.pressure_psi, run_.highest_pressure, units_.UnitFor("psi"));
    if (run_.highest_speed > limits.motor_speed_rad_s)
      return ends("motor_speed", limits.motor_speed_rad_s, run_.highest_speed, units_.UnitFor("rad/s"));
    return "";
  }

  // Whether the arm rests where friction may hold it.
  bool FrictionHolds() const {
    const std::vector<double>& angles = run_.response.angle;
    const auto from =
        angles.begin() + static_cast<std::ptrdiff_t>((1 - kLastPart) * static_cast<double>(angles.size()));
    const auto [low, high] = std::minmax_element(from, angles.end());
    const double band = runs::kSettlingBand * std::fabs(step_.step);
    return *high - *low < 0.5 * band && friction_ > 0.5 * std::fabs(result_.error) &&
           std::fabs(result_.error) > 0.5 * band;
  }

  const settings::StackConfig& config_;
  const UnitSystem& units_;
  StepCase step_;
  StepRun run_;
  StepResult result_;
  double friction_ = 0;
};

}  // namespace

std::string WhyUnsettled(const StepJudge& judge, const Gains& gains, const StepCase& step) {
  return Unsettled(judge, gains, step).Why();
}

double FrictionError(const settings::StackConfig& config, const Gains& gains) {
  const model::Parameters& p = config.model.description.parameters;
  const pressure_ctrl::PressureLawSettings law = design::PressureLawSettingsFor(With(config, gains));
  return p.T_s / (p.k_1 * (law.gains.k_p + law.reference_feedforward) * gains.c1);
}

}  // namespace hydro::tune
