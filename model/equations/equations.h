// The equations under Actuator: state vectors, modes, rates, exact Jacobians, switches. This is for code that
// linearises, estimates or integrates in its own way; for the actuator's motion alone, use actuator.h.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/terms/actuator_options.h"
#include "model/terms/description.h"
#include "model/terms/measurement.h"
#include "model/terms/model_error.h"
#include "model/terms/parameter_info.h"
#include "model/terms/state.h"
#include "model/terms/terms.h"

namespace hydro::model {

class Effect;
struct StateSizes;
template <class T>
class StateHistory;

// The numbers in the right-hand side: parameters, and values that follow from them alone.
template <class T>
struct NumbersOf {
  ParametersOf<T> parameters;
  std::vector<T> own;  // the effects' parameters, each effect's from Effect::first_parameter() on
  T inverse_J{};
  T inverse_J_a{};
  T fixed_volume{};  // in^3, part of each side outside the actuator
  T stiffness_1{};   // beta/V_1 at arm_angle, psi/in^3
  T stiffness_2{};
};

// What the right-hand side needs in addition to time, state, mode and voltage.
struct EquationData : NumbersOf<double> {
  Shaft shaft = Shaft::kFree;
  bool bypass = false;
  bool linear_arm = false;                         // a cylinder: its weight is the same in every position
  double atmosphere = 0;                           // in the model's unit of pressure
  double arm_angle = 0;                            // clamped
  double mid_volume_1 = 0, mid_volume_2 = 0;       // in^3, at the actuator, where the arm is at 0
  double c_1 = 0, c_2 = 0;                         // the volume of each side that the arm displaces
  double begin = 0;                                // s, the zero of the effects' time
  const trajectory::Trajectory* motion = nullptr;  // driven
  // s: `motion` is evaluated at times below this.
  double motion_limit = std::numeric_limits<double>::infinity();
  std::vector<std::shared_ptr<Effect>> effects;
  // Numbers of effects that the model leaves out: the place in `own`, and what stands there.
  std::vector<std::pair<size_t, Standard>> standards;
  Surroundings around;
  int states = 0;
  int switches = kFirstEffectSwitch;
  bool ideal_valves = true;  // false: an effect has the one-way valves; valve_1 and valve_2 stay closed
  bool reads_late = false;   // some channel does, by at most `reach`
  double reach = 0;          // s
  int p_3_state = -1;        // the accumulator's pressure, where it is a state
  int actuator_angle_state = kArmAngle;  // free shaft: the angle that V_1 and V_2 depend on
  // Free shaft: the arm is part of something larger, and `load` replaces J_a and gravity.
  bool loaded = false;
  ArmLoad load;
  double load_since = 0;  // s
  double inverse_load_inertia = 0;
  std::shared_ptr<const NumbersOf<Jet>> constants;  // the same numbers without derivatives
};

class Equations {
 public:
  // Throws ModelError: volumes not above 0, a motion with jumps, unknown or contradictory effects, parameters
  // outside their bounds.
  Equations(const ModelDescription& description, const ActuatorOptions& options);

  const EquationData& data() const { return data_; }
  int states() const { return data_.states; }
  int switches() const { return data_.switches; }
  bool plain() const { return data_.effects.empty() && !data_.bypass && data_.shaft != Shaft::kDriven; }
  std::vector<std::string> StateNames() const;

  // The size of each state below which absolute errors count: error weights are relative_tolerance * (|y| +
  // scale).
  const std::vector<double>& scales() const { return scales_; }

  // The state with both pressures at `pressure`, and its mode: at rest, with the valves closed.
  void Start(double pressure, double* state, Mode* mode) const;

  // Sets the effects' switches of `mode` to where they are in this state: an arm that moves does not stick.
  // Without a voltage.
  void SwitchEffects(const double* state, Mode* mode) const;

  // d state/dt. `margin` (may be null) receives switches() numbers. Each is positive while its switch may
  // keep its position and falls through 0 when it must change:
  //   pump slips: speed in its direction; pump sticks: friction limit less net torque
  //   valve closed: p - p_3
  //   valve open: p_3' (0 unless an effect moves p_3) less the rate that p would have with the valve closed
  void Rates(double time, double voltage, const Mode& mode, const double* state, double* rate,
             double* margin = nullptr) const;

  // d rate_i/d state_j at jacobian[i + j * states()], exact (automatic derivatives).
  void Jacobian(double time, double voltage, const Mode& mode, const double* state, double* jacobian) const;

  // Rates and Measure, with the derivatives along the kJetWidth directions that `voltage` and `state` carry,
  // for Linearise. `voltage` is the acting voltage: amp.delay passes it on at once.
  void Differentiate(double time, const Jet& voltage, const Mode& mode, const Jet* state, Jet* rate,
                     MeasurementOf<Jet>* measured) const;

  // Changes switch `which`, whose margin has reached 0, and puts the state exactly on the boundary.
  void Cross(int which, double time, double voltage, double* state, Mode* mode) const;

  // All named quantities at one instant.
  void Evaluate(double time, double voltage, const Mode& mode, const double* state, double* rate,
                Terms<double>* terms) const;

  Power PowerBalance(double time, double voltage, const Mode& mode, const double* state) const;

  // What the sensors read. A late channel (sensor.skew) reads from `history`, which must hold the states of
  // the last data().reach seconds; without a history it is not late.
  Measurement Measure(double time, const double* state, const StateHistory<double>* history = nullptr) const;

  // in-lbf, what the actuator gives a loaded arm: k_2 dp as changed by effects, without the load.
  struct ArmTorque {
    double torque = 0;
    bool held = false;  // at rest by the arm's own friction: the arm then does not feel this torque
  };
  ArmTorque FindArmTorque(double time, double voltage, const Mode& mode, const double* state);
  // d/dt of that torque where the state moves with `rate`. It is exact, except for what effects change
  // explicitly with time.
  double ArmTorqueRate(double time, double voltage, const Mode& mode, const double* state,
                       const double* rate) const;

  // Throws ModelError when V_1 or V_2 at `arm_angle` is not above 0 (or not above the volume that an effect
  // places elsewhere).
  void CheckVolumes(double arm_angle) const;

  // Sets the arm's load from `time` on. A call before the first integration step makes the arm a loaded one.
  // Throws ModelError.
  void SetLoad(double time, const ArmLoad& load);

  // Sets the outside influences from now on. An integrator must then evaluate afresh, as for another voltage.
  // Simulations of the plain equations ignore them.
  void Surround(const Surroundings& around) { data_.around = around; }

  // Whether V_1 and V_2 are above 0 at `arm_angle`.
  bool HasVolumes(double arm_angle) const {
    return arm_angle * data_.c_1 < data_.mid_volume_1 && -arm_angle * data_.c_2 < data_.mid_volume_2;
  }

  // Moves a free arm to a nearby position. That motion compresses the fluid, except where a valve is open or
  // where the arm does not compress the fluid (bypass, arm.flexure).
  void MoveArm(double time, double voltage, const Mode& mode, double angle, double speed,
               double* state) const;

  // Known stops: times at which the right-hand side itself jumps. An integrator calls Command when the
  // voltage changes, steps no further than NextStop, and calls PassStop there. Until then the earlier
  // formulas hold.
  void Command(double time, double voltage);
  double NextStop(double time) const;  // the first one after `time`; infinity if there is none
  void PassStop(double time);

 private:
  void FindMidVolumes();

  // `pressure` and `flow`: magnitudes that matter, for the scales of the effect's states.
  void AddEffect(const EffectDescription& effect, const StateSizes& sizes);

  EquationData data_;
  UnitSystem units_;
  std::vector<double> scales_;
};

}  // namespace hydro::model
