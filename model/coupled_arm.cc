// Each joint's actuator integrates its own equations, modes and events; the arm couples them. From one
// exchange of loads, at t_0, to the next, joint i moves by
//   m_i alpha_i'' = tau_i + W_i(t),   m_i = 1/(M^-1)_ii at t_0,
// with its own torque tau_i exact at every instant. W_i is the effect of the other joints
// (arm/arm_coupling.h). It continues as a parabola, from W and W' at t_0 and the change of W' since the
// previous exchange. At the end of the step W and W' are known too, and the cubic through both ends shows the
// parabola's error. Its integrals correct angle and speed, and the angle's correction compresses the fluid.
// In smooth motion the method is of fourth order. A jump in a rate (a valve, a pump that sticks) costs
// accuracy in the step in which it lies.

#include "model/coupled_arm.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "model/arm/arm_coupling.h"
#include "model/loaded_actuator.h"

namespace hydro::model {
namespace {

// Exchanges of loads per second, enough for an arm that oscillates at 4e6 rad/s. Beyond that, its links have
// no weight.
constexpr double kMostExchanges = 1e7;

// Calls `act`, and adds the joint's name to its errors.
template <class Act>
void Named(int joint, const Act& act) {
  const std::string name = "joint " + std::to_string(joint + 1) + ": ";
  try {
    act();
  } catch (const TooManySteps& error) {
    throw TooManySteps(name + error.what());
  } catch (const ModelError& error) {
    throw ModelError(name + error.what());
  }
}

}  // namespace

class CoupledArm::Impl {
 public:
  Impl(const ArmDescription& description, const std::vector<ArmJoint>& joints,
       const CoupledArmOptions& options)
      : coupling_(PlanarArm(description)), options_(options), now_(n()), other_(n()), loads_(joints.size()) {
    if (static_cast<int>(joints.size()) != n()) {
      throw ModelError("found " + std::to_string(joints.size()) + " joints for an arm of " +
                       std::to_string(n()) + " links; allowed is one for each link");
    }
    if (!(options.longest_step > 0) || !(options.steps_per_radian > 0)) {
      throw ModelError("longest_step and steps_per_radian of a coupled arm must be above 0");
    }
    for (const ArmJoint& joint : joints) {
      const int number = static_cast<int>(actuators_.size());
      Named(number, [&] { actuators_.emplace_back(joint.model, joint.options); });
      clamped_.push_back(joint.options.shaft == Shaft::kClamped);
      parameters_.push_back(joint.model.parameters);
    }
    Couple(&now_);
    for (int i = 0; i < n(); ++i) fastest_.push_back(i % 2 == 0 ? 1 : -0.7);
    for (int round = 0; round < 20; ++round) FindFastest();
  }

  void Advance(std::span<const double> voltages, double until) {
    if (static_cast<int>(voltages.size()) != n()) {
      throw ModelError("found " + std::to_string(voltages.size()) + " voltages for " + std::to_string(n()) +
                       " joints");
    }
    if (!(until >= time()) || std::isinf(until)) {
      throw ModelError("cannot advance to t = " + std::to_string(until) +
                       " s from t = " + std::to_string(time()) + " s");
    }
    while (time() < until) {
      FindFastest();
      const double left = until - time();
      const double steps =
          std::ceil(left * std::max(1 / options_.longest_step, options_.steps_per_radian * fastest_rate_));
      if (!(steps <= std::max(1.0, kMostExchanges * left))) {
        throw TooManySteps("too fast to simulate: its joints move each other at up to " +
                           std::to_string(fastest_rate_) + " rad/s at t = " + std::to_string(time()) + " s");
      }
      Step(voltages, steps <= 1 ? until : time() + left / steps);
    }
  }

  double time() const { return actuators_[0].time(); }
  int n() const { return coupling_.joints(); }
  const LoadedActuator& actuator(int joint) const { return actuators_.at(static_cast<size_t>(joint)); }
  const JointCoupling& now() const { return now_; }

 private:
  // The fastest oscillation of the arm on its compressible fluid, rad/s: the root of the largest eigenvalue
  // of M^-1 K. One round of power iteration in each exchange follows it. The result is at least the frequency
  // of each joint with the others' torques held, which suffices until the iteration has settled.
  void FindFastest() {
    double square = 0;
    double length = 0;
    for (int i = 0; i < n(); ++i) {
      if (now_.held[i]) fastest_[i] = 0;
      length = std::max(length, std::abs(fastest_[i]));
      const Parameters& p = parameters_[i];
      const double V_1 = p.V_ms - p.c * now_.angle[i];
      const double V_2 = p.V_ms + p.c * now_.angle[i];
      const double stiffness = p.k_2 * p.c * p.beta * (1 / V_1 + 1 / V_2);
      fastest_[i] *= stiffness;
      if (!now_.held[i]) square = std::max(square, stiffness / now_.inertia[i]);
    }
    coupling_.Accelerate(&fastest_);
    double grown = 0;
    for (const double part : fastest_) grown = std::max(grown, std::abs(part));
    fastest_rate_ = std::sqrt(std::max(square, length > 0 ? grown / length : 0));
    for (int i = 0; i < n(); ++i) {
      fastest_[i] = now_.held[i] || grown == 0 ? 0.1 : fastest_[i] / grown;  // a held joint may be released
    }
  }

  void Step(std::span<const double> voltages, double until) {
    const double h = until - time();
    for (int i = 0; i < n(); ++i) {
      loads_[i] = {now_.inertia[i], now_.load[i], now_.load_rate[i], Curve(i)};
      Named(i, [&] {
        if (!clamped_[i]) actuators_[i].SetLoad(loads_[i]);
        actuators_[i].Advance(voltages[i], until);
      });
    }
    Couple(&other_);
    for (int i = 0; i < n(); ++i) {
      if (!other_.held[i]) Correct(i, h);
    }
    std::swap(now_, other_);
    last_step_ = h;
  }

  // Half of W'', from the current rates and those at the previous exchange (other_), both with the current
  // inertia.
  double Curve(int i) const {
    if (last_step_ == 0 || now_.held != other_.held) return 0;
    const double before =
        now_.held[i] ? other_.load_rate[i] : now_.inertia[i] * other_.jerk[i] - other_.torque_rate[i];
    return (now_.load_rate[i] - before) / (2 * last_step_);
  }

  // With s = (t - t_0)/h, the parabola's error is missed (3 s^2 - 2 s^3) + h missed_rate (s^3 - s^2).
  void Correct(int i, double h) {
    const auto& [m, torque, torque_rate, curve] = loads_[i];
    const double missed =
        m * other_.acceleration[i] - other_.torque[i] - (torque + h * (torque_rate + h * curve));
    const double missed_rate = m * other_.jerk[i] - other_.torque_rate[i] - (torque_rate + 2 * h * curve);
    other_.speed[i] += h / m * (missed / 2 - h * missed_rate / 12);
    other_.angle[i] += h * h / m * (0.15 * missed - h * missed_rate / 30);
    actuators_[i].MoveArm(other_.angle[i], other_.speed[i]);
  }

  void Couple(JointCoupling* at) {
    for (int i = 0; i < n(); ++i) {
      at->angle[i] = actuators_[i].arm_angle();
      at->speed[i] = actuators_[i].arm_speed();
      const auto [torque, held] = actuators_[i].ArmTorque();
      at->torque[i] = torque;
      at->held[i] = clamped_[i] || held;
    }
    coupling_.FindAccelerations(at);
    for (int i = 0; i < n(); ++i) at->torque_rate[i] = actuators_[i].ArmTorqueRate(at->acceleration[i]);
    coupling_.FindLoads(at);
  }

  ArmCoupling coupling_;
  CoupledArmOptions options_;
  std::vector<LoadedActuator> actuators_;
  std::vector<bool> clamped_;
  std::vector<Parameters> parameters_;
  JointCoupling now_;
  JointCoupling other_;          // at the previous exchange, then at the next
  double last_step_ = 0;         // s
  std::vector<double> fastest_;  // the shape of the fastest oscillation
  double fastest_rate_ = 0;      // rad/s
  std::vector<ArmLoad> loads_;   // as last set
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
