// The residuals of eqs. (4), (13), (14), (15) for a known motion. Only the states that effects add are
// integrated, along the given motion. The gap finder uses these residuals to compare measured motion with the
// model.
#pragma once

#include <optional>
#include <vector>

#include "model/equations/equations.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

// The motion at one instant, in the model's units.
struct KnownMotion {
  double time = 0;     // s
  double voltage = 0;  // V
  double motor_angle = 0, motor_speed = 0, motor_acceleration = 0;
  double p1 = 0, p2 = 0, p1_rate = 0, p2_rate = 0;
  double arm_angle = 0, arm_speed = 0, arm_acceleration = 0;
  Surroundings around = {};
  // The expected sign of the pump's and of the arm's motion, -1 to 1; between these where noise hides the
  // sign.
  double pump_direction = 0, arm_direction = 0;
};

// The residual as a torque or flow that the model lacks: 0 where the model is right.
template <class T>
struct BalancesOf {
  T torque{};  // on the pump, eq. (4), in-lbf
  T flow_1{};  // into each side with its one-way valve closed, eqs. (13), (14), in^3/s
  T flow_2{};
  T arm{};      // on the arm, eq. (15), in-lbf
  T level_1{};  // psi, reading of a side above the level at which its open one-way valve holds it
  T level_2{};
  T drive{};  // the motor's torque, eq. (1): part of `torque`
};

// What the sensors would read beyond the motion because of the recorder's effects.
using ReadingErrors = Measurement;

class BalanceEquations {
 public:
  // `unknowns` are those by which At differentiates, at most kJetWidth, of kinds kBase and kEffect. Throws
  // ModelError as Equations does.
  BalanceEquations(const ModelDescription& model, ActuatorOptions options,
                   const std::vector<Unknown>& unknowns = {});

  bool has_states() const { return equations_.states() > first_state_; }
  // Whether an effect remembers commands, reads late, or has states. The instants must then be passed in
  // order.
  bool remembers() const;

  // Sets the states of effects to their values in steady motion at this instant. `filled`: the accumulator
  // has filled the sides, from where all pressures were p_3; else it is at p_3 itself.
  void Start(const KnownMotion& motion, bool filled = false);
  // Advances the states of effects to the next sample. The voltage of `from` is held until then.
  void Advance(const KnownMotion& from, const KnownMotion& to);
  // The motor's torque at an instant before its command acts; `voltage` is the voltage held until then.
  double DriveBefore(const KnownMotion& motion, double voltage) const;
  // Whether a late command acted during the last sample, and which part of the sample, 0 to 1, before its
  // end.
  bool acted_late() const { return drive_before_.has_value(); }
  double early() const { return early_; }

  BalancesOf<double> Values(const KnownMotion& motion) const;
  BalancesOf<Jet> At(const KnownMotion& motion) const;
  // The errors, to first order in the delay of a late channel.
  ReadingErrors Errors(const KnownMotion& motion) const;

 private:
  void CopyStates(const KnownMotion& motion, double* state) const;
  void OwnRates(const KnownMotion& motion, double* state, double* rate) const;
  void FindJacobian(const KnownMotion& motion);
  void AdvanceStates(const KnownMotion& from, const KnownMotion& to);
  void PassStops(const KnownMotion& from, const KnownMotion& to);
  double Drive(KnownMotion motion, double voltage) const;

  Equations equations_;
  NumbersOf<Jet> numbers_;                      // with derivatives with respect to the unknowns
  int first_state_ = 0;                         // of effects
  bool commands_ = false;                       // some effect may remember commands
  std::vector<double> own_;                     // the effects' states
  std::vector<double> jacobian_, step_matrix_;  // of their rates by themselves, by rows; of a sample
  int since_jacobian_ = 0;
  double early_ = 0;
  std::optional<double> drive_before_;  // set where a late command acted during the last sample
};

}  // namespace hydro::model
