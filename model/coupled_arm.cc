// Each joint's actuator integrates its own equations, modes and events; the arm couples them. Between two exchanges of loads joint i
// moves by
//   m_i alpha_i'' = tau_i + W_i + W_i' (t - t_0),   m_i = 1/(M^-1)_ii,
// with its own torque tau_i exact at every instant and what the others do to it, W_i = m_i alpha_i'' - tau_i of the whole arm's
// M alpha'' + bias = tau, as a straight line. At the end of the step W and W' are known too; the cubic through both ends gives
// what the straight line has missed, and angle and speed are corrected by its integrals. So the method is of third order and
// looks back at nothing: events inside a step cost accuracy in that step only.

#include "model/coupled_arm.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "model/arm/factor.h"
#include "model/arm/planar_arm.h"
#include "model/loaded_actuator.h"

namespace hydro::model {
class CoupledArm::Impl {
 public:
  // What couples the joints at one instant.
  struct Coupling {
    explicit Coupling(size_t n)
        : angle(n), speed(n), torque(n), torque_rate(n), acceleration(n), jerk(n), inertia(n), load(n),
          load_rate(n), held(n) {}

    std::vector<double> angle, speed;
    std::vector<double> torque, torque_rate;  // tau and its rate: what the actuators give
    std::vector<double> acceleration, jerk;
    std::vector<double> inertia;          // m
    std::vector<double> load, load_rate;  // W, W'
    std::vector<bool> held;               // clamped, or held by friction of its own
  };

  Impl(const ArmDescription& description, const std::vector<ArmJoint>& joints,
       const CoupledArmOptions& options)
      : arm_(description),
        options_(options),
        now_(description.links.size()),
        next_(description.links.size()),
        matrix_(description.links.size() * description.links.size()),
        work_(description.links.size()) {
    if (joints.size() != description.links.size()) {
      throw ModelError("found " + std::to_string(joints.size()) + " joints for an arm of " +
                       std::to_string(description.links.size()) + " links; allowed is one for each link");
    }
    if (!(options.longest_step > 0) || !(options.steps_per_radian > 0)) {
      throw ModelError("longest_step and steps_per_radian of a coupled arm must be above 0");
    }
    for (const ArmJoint& joint : joints) {
      Named(static_cast<int>(actuators_.size()),
            [&] { actuators_.emplace_back(joint.model, joint.options); });
      clamped_.push_back(joint.options.shaft == Shaft::kClamped);
      parameters_.push_back(joint.model.parameters);
    }
    Couple(&now_);
  }

  void Advance(std::span<const double> voltages, double until) {
    if (static_cast<int>(voltages.size()) != n()) {
      throw ModelError("found " + std::to_string(voltages.size()) + " voltages for " + std::to_string(n()) +
                       " joints");
    }
    if (!(until >= time()) || std::isinf(until)) {
      throw ModelError("cannot advance to t = " + std::to_string(until) + " s from t = " +
                       std::to_string(time()) + " s");
    }
    while (time() < until) {
      const double left = until - time();
      const double steps = std::ceil(left / LongestStep());
      Step(voltages, steps <= 1 ? until : time() + left / steps);
    }
  }

  double time() const { return actuators_[0].time(); }
  int n() const { return arm_.links(); }
  const LoadedActuator& actuator(int joint) const { return actuators_.at(static_cast<size_t>(joint)); }
  const Coupling& now() const { return now_; }

 private:
  // Calls `act`, whose errors then say which joint's they are.
  template <class Act>
  static void Named(int joint, const Act& act) {
    try {
      act();
    } catch (const ModelError& error) {
      throw ModelError("joint " + std::to_string(joint + 1) + ": " + error.what());
    }
  }

  // The fastest oscillation is no faster than the root of the sum of all joints' squares, which is the trace of M^-1 K.
  double LongestStep() const {
    double squares = 0;
    for (int i = 0; i < n(); ++i) {
      if (clamped_[i]) continue;
      const Parameters& p = parameters_[i];
      const double V_1 = p.V_ms - p.c * now_.angle[i];
      const double V_2 = p.V_ms + p.c * now_.angle[i];
      squares += p.k_2 * p.c * p.beta * (1 / V_1 + 1 / V_2) / now_.inertia[i];
    }
    const double fluid = 1 / (options_.steps_per_radian * std::sqrt(squares));
    return squares > 0 ? std::min(options_.longest_step, fluid) : options_.longest_step;
  }

  void Step(std::span<const double> voltages, double until) {
    const double h = until - time();
    for (int i = 0; i < n(); ++i) {
      Named(i, [&] {
        if (!clamped_[i]) {
          actuators_[i].SetLoad({.inertia = now_.inertia[i], .torque = now_.load[i], .torque_rate = now_.load_rate[i]});
        }
        actuators_[i].Advance(voltages[i], until);
      });
    }
    Couple(&next_);
    for (int i = 0; i < n(); ++i) {
      if (!next_.held[i]) Correct(i, h);
    }
    std::swap(now_, next_);
  }

  // With x = (t - t_0)/h the line has missed missed (3 x^2 - 2 x^3) + missed_rate h (x^3 - x^2).
  void Correct(int i, double h) {
    const double m = now_.inertia[i];
    const double missed =
        m * next_.acceleration[i] - next_.torque[i] - (now_.load[i] + h * now_.load_rate[i]);
    const double missed_rate = m * next_.jerk[i] - next_.torque_rate[i] - now_.load_rate[i];
    next_.speed[i] += h / m * (missed / 2 - h * missed_rate / 12);
    next_.angle[i] += h * h / m * (0.15 * missed - h * missed_rate / 30);
    actuators_[i].MoveArm(next_.angle[i], next_.speed[i]);
  }

  void Couple(Coupling* at) {
    for (int i = 0; i < n(); ++i) {
      at->angle[i] = actuators_[i].arm_angle();
      at->speed[i] = actuators_[i].arm_speed();
      const auto [torque, held] = actuators_[i].ArmTorque();
      at->torque[i] = torque;
      at->held[i] = clamped_[i] || held;
    }
    const ArmPose pose = arm_.PoseAt(at->angle);
    FactorMass(pose, at);
    arm_.Bias(pose, at->speed, work_);
    Solve(*at, at->torque, &at->acceleration);
    for (int i = 0; i < n(); ++i) at->torque_rate[i] = actuators_[i].ArmTorqueRate(at->acceleration[i]);
    std::fill(at->jerk.begin(), at->jerk.end(), 0.0);
    arm_.JointTorqueRates(pose, at->speed, at->acceleration, at->jerk, work_);
    Solve(*at, at->torque_rate, &at->jerk);
    for (int i = 0; i < n(); ++i) {
      at->load[i] = at->inertia[i] * at->acceleration[i] - at->torque[i];
      at->load_rate[i] = at->inertia[i] * at->jerk[i] - at->torque_rate[i];
    }
    LoadHeld(pose, at);
  }

  // The matrix's factors, with the held joints taken out, and the inertia that each joint has while the others' torques are held.
  void FactorMass(const ArmPose& pose, Coupling* at) {
    arm_.MassMatrix(pose, matrix_);
    bool any = false;
    for (int i = 0; i < n(); ++i) {
      if (!at->held[i]) continue;
      any = true;
      at->inertia[i] = matrix_[i + i * n()];
      for (int k = 0; k < n(); ++k) matrix_[std::max(i, k) + std::min(i, k) * n()] = 0;
      matrix_[i + i * n()] = 1;
    }
    if (!Factor(n(), matrix_)) throw ModelError("the arm's mass matrix is not positive definite");
    InverseDiagonal(n(), matrix_, work_);
    for (int i = 0; i < n(); ++i) {
      if (!at->held[i]) at->inertia[i] = 1 / work_[i];
    }
    if (any) FreeHeld(pose, at);
  }

  // The inertia that a held joint has once it moves, when the other held ones stay.
  void FreeHeld(const ArmPose& pose, Coupling* at) {
    std::vector<double> whole(matrix_.size());
    arm_.MassMatrix(pose, whole);
    for (int i = 0; i < n(); ++i) {
      if (!at->held[i] || clamped_[i]) continue;
      const double* column = whole.data() + i * n();
      for (int k = 0; k < n(); ++k) work_[k] = at->held[k] ? 0 : column[k];
      SolveFactored(n(), matrix_, work_);
      for (int k = 0; k < n(); ++k) at->inertia[i] -= column[k] * work_[k];
    }
  }

  // M x = torques - work_, where held joints have x = 0.
  void Solve(const Coupling& at, const std::vector<double>& torques, std::vector<double>* x) const {
    for (int i = 0; i < n(); ++i) (*x)[i] = at.held[i] ? 0 : torques[i] - work_[i];
    SolveFactored(n(), matrix_, *x);
  }

  // What a held joint has to hold is its load.
  void LoadHeld(const ArmPose& pose, Coupling* at) {
    if (std::none_of(at->held.begin(), at->held.end(), [](bool held) { return held; })) return;
    arm_.JointTorques(pose, at->speed, at->acceleration, work_);
    for (int i = 0; i < n(); ++i) {
      if (at->held[i]) at->load[i] = -work_[i];
    }
    arm_.JointTorqueRates(pose, at->speed, at->acceleration, at->jerk, work_);
    for (int i = 0; i < n(); ++i) {
      if (at->held[i]) at->load_rate[i] = -work_[i];
    }
  }

  PlanarArm arm_;
  CoupledArmOptions options_;
  std::vector<LoadedActuator> actuators_;
  std::vector<bool> clamped_;
  std::vector<Parameters> parameters_;
  Coupling now_, next_;
  std::vector<double> matrix_;
  std::vector<double> work_;
};

CoupledArm::CoupledArm(const ArmDescription& arm, const std::vector<ArmJoint>& joints,
                       const CoupledArmOptions& options)
    : impl_(std::make_unique<Impl>(arm, joints, options)) {}
CoupledArm::~CoupledArm() = default;
CoupledArm::CoupledArm(CoupledArm&&) noexcept = default;
CoupledArm& CoupledArm::operator=(CoupledArm&&) noexcept = default;

void CoupledArm::Advance(std::span<const double> voltages, double until) { impl_->Advance(voltages, until); }
double CoupledArm::time() const { return impl_->time(); }
int CoupledArm::joints() const { return impl_->n(); }
Measurement CoupledArm::Measure(int joint) const { return impl_->actuator(joint).Measure(); }
double CoupledArm::ActuatorTorque(int joint) const {
  return impl_->now().torque.at(static_cast<size_t>(joint));
}
double CoupledArm::Acceleration(int joint) const {
  return impl_->now().acceleration.at(static_cast<size_t>(joint));
}
Power CoupledArm::PowerBalance(int joint) const { return impl_->actuator(joint).PowerBalance(); }

}  // namespace hydro::model
