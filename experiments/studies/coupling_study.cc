#include "experiments/studies/coupling_study.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "experiments/runs/shipped_models.h"
#include "model/actuator.h"
#include "model/arm/arm_coupling.h"
#include "model/arm/planar_arm.h"
#include "model/coupled_arm.h"
#include "settings/stack_config.h"
#include "tune/search/step_trial.h"

namespace hydro::experiments {
namespace {

using OfEachJoint = std::array<double, kArmJoints>;

constexpr double kGravity = 386.09;  // in/s^2
constexpr double kHold = 1;          // s at rest before the path, in which the arm finds its balance

// The reference of all joints at one time.
struct Reference {
  OfEachJoint angle{}, speed{}, acceleration{};
};

Reference ReferenceAt(const SmoothPath& path, const Moving& moving, double time) {
  Reference at;
  for (int i = 0; i < kArmJoints; ++i) {
    if (!moving[i]) continue;
    at.angle[i] = path.angle(std::max(time, 0.0));
    at.speed[i] = path.speed(std::max(time, 0.0));
    at.acceleration[i] = path.acceleration(std::max(time, 0.0));
  }
  return at;
}

// Both joints, as two rigs or as one arm.
class Joints {
 public:
  Joints(const std::array<model::Parameters, kArmJoints>& own, const Reference& start, bool coupled) {
    std::vector<model::ArmJoint> joints;
    for (int i = 0; i < kArmJoints; ++i) {
      model::ModelDescription model = ShippedModel("table1");
      model.parameters = own[i];
      joints.push_back({.model = model});
      joints.back().options.arm_angle = start.angle[i];
      if (!coupled) rigs_.emplace_back(model, joints.back().options);
    }
    if (coupled) arm_ = std::make_unique<model::CoupledArm>(StudiedArm(), joints);
  }

  void Advance(const OfEachJoint& voltages, double until) {
    if (arm_) arm_->Advance(voltages, until);
    for (size_t i = 0; i < rigs_.size(); ++i) rigs_[i].Advance(voltages[i], until);
  }
  model::Measurement Measure(int joint) const {
    return arm_ ? arm_->Measure(joint) : rigs_[static_cast<size_t>(joint)].Measure();
  }

 private:
  std::unique_ptr<model::CoupledArm> arm_;
  std::vector<model::Actuator> rigs_;
};

// Both loops of one joint as the stack computes them (tune::StepTrial), with a feed-forward.
class JointLoops {
 public:
  explicit JointLoops(const tune::StepTrial& settings) : settings_(settings), law_(settings.position) {}

  // The voltage that acts from tick k on. `ahead`: psi.
  double Voltage(int k, const model::Measurement& m, double reference, double ahead) {
    const double voltage = next_voltage_;
    input_.pressure_ref = next_pressure_ref_;
    if (k % settings_.interval == 0) {
      feedback_ = law_.UpdateUnlimited(m.arm_angle, reference, 1);
      next_pressure_ref_ = feedback_ + ahead;
    }
    input_.p1 = m.p1;
    input_.p2 = m.p2;
    input_.motor_speed = m.motor_speed;
    input_.arm_speed = m.arm_speed;
    next_voltage_ = pressure_ctrl::PressureLaw(settings_.pressure, input_).voltage;
    return voltage;
  }
  double feedback() const { return feedback_; }  // psi

 private:
  const tune::StepTrial& settings_;
  position_ctrl::PositionLaw law_;
  pressure_ctrl::PressureLawInput input_;
  double feedback_ = 0;
  double next_pressure_ref_ = 0;
  double next_voltage_ = 0;
};

// The torque that the arm needs at each joint along the reference, as far as this feed-forward knows it.
OfEachJoint KnownTorques(const model::PlanarArm& arm, const std::array<model::Parameters, kArmJoints>& own,
                         const Reference& at, FeedForward feed_forward) {
  OfEachJoint coupling{};
  if (feed_forward == FeedForward::kWhole) {
    model::CouplingTorques(arm, own, at.angle, at.speed, at.acceleration, coupling);
  } else if (feed_forward == FeedForward::kGravity) {
    model::CouplingTorques(arm, own, at.angle, OfEachJoint{}, OfEachJoint{}, coupling);
  }
  for (int i = 0; i < kArmJoints; ++i) {
    coupling[i] += own[i].J_a * at.acceleration[i] + own[i].mgl * std::cos(at.angle[i]);
  }
  return coupling;
}

// psi: the pump's own need, which eq. (16) would otherwise supply by an error of dp.
double PumpPressure(const model::Parameters& p, double k_p, double speed, double acceleration) {
  const double friction = speed == 0 ? 0 : std::copysign(p.T_s, speed);
  return (p.c / p.D * (p.J * acceleration + p.b * speed) + friction) / (p.k_1 * k_p);
}

void Summarise(JointRun* run) {
  const auto peak = [](const std::vector<double>& values) {
    double largest = 0;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    return largest;
  };
  run->peak_angle_error = peak(run->angle_error);
  run->peak_torque_error = peak(run->torque_error);
  run->peak_feedback = peak(run->feedback);
  run->peak_coupling = peak(run->coupling);
  double squares = 0;
  for (const double error : run->torque_error) squares += error * error;
  run->rms_torque_error = std::sqrt(squares / static_cast<double>(run->torque_error.size()));
}

CoupledArmRun RunArm(const CouplingStudy& study, const tune::StepTrial& settings, const SmoothPath& path,
                     const CoupledArmRun& conditions) {
  CoupledArmRun run = conditions;
  const model::PlanarArm arm(StudiedArm());
  Joints joints(study.own, ReferenceAt(path, run.moving, 0), run.coupled);
  std::vector<JointLoops> loops(kArmJoints, JointLoops(settings));
  const int before = static_cast<int>(std::lround(kHold / settings.tick));
  const int ticks = before + static_cast<int>(study.time.size());
  for (int k = 0; k < ticks; ++k) {
    const Reference at = ReferenceAt(path, run.moving, (k - before) * settings.tick);
    const OfEachJoint known = KnownTorques(arm, study.own, at, run.feed_forward);
    const OfEachJoint own = KnownTorques(arm, study.own, at, FeedForward::kOwn);
    const OfEachJoint needed =
        KnownTorques(arm, study.own, at, run.coupled ? FeedForward::kWhole : FeedForward::kOwn);
    OfEachJoint voltages{};
    for (int i = 0; i < kArmJoints; ++i) {
      const model::Parameters& p = study.own[i];
      double ahead = 0;
      if (run.feed_forward != FeedForward::kNone) {
        ahead =
            known[i] / p.k_2 + PumpPressure(p, settings.pressure.gains.k_p, at.speed[i], at.acceleration[i]);
      }
      const model::Measurement m = joints.Measure(i);
      voltages[i] = loops[i].Voltage(k, m, at.angle[i], ahead);
      if (k < before) continue;
      JointRun& joint = run.joints[i];
      const double torque = p.k_2 * (m.p2 - m.p1);
      joint.angle_error.push_back(m.arm_angle - at.angle[i]);
      joint.torque.push_back(torque);
      joint.torque_error.push_back(torque - needed[i]);
      joint.feedback.push_back(p.k_2 * loops[i].feedback());
      joint.coupling.push_back(torque - own[i]);
      run.highest_motor_torque = std::max(run.highest_motor_torque, std::abs(p.k_1 * voltages[i]));
    }
    joints.Advance(voltages, (k + 1) * settings.tick);
  }
  for (JointRun& joint : run.joints) Summarise(&joint);
  return run;
}

}  // namespace

model::ArmDescription StudiedArm() {
  return {.gravity = kGravity,
          .payload = 15 / kGravity,
          .links = {{.mass = 12 / kGravity, .length = 20, .centre = 9, .inertia = 1, .angle = -kElbow / 2},
                    {.mass = 8 / kGravity, .length = 16, .centre = 7, .inertia = 0.5, .angle = kElbow}}};
}

std::string Name(FeedForward feed_forward) {
  switch (feed_forward) {
    case FeedForward::kNone:
      return "pd";
    case FeedForward::kOwn:
      return "own";
    case FeedForward::kGravity:
      return "gravity";
    case FeedForward::kWhole:
      return "inverse_dynamics";
  }
  return "";
}

std::string Name(const Moving& moving) {
  if (moving[0] && moving[1]) return "both_move";
  return moving[0] ? "upper_moves" : "forearm_moves";
}

const CoupledArmRun& CouplingStudy::Find(const Moving& moving, FeedForward feed_forward, bool coupled) const {
  for (const CoupledArmRun& run : runs) {
    if (run.moving == moving && run.feed_forward == feed_forward && run.coupled == coupled) return run;
  }
  throw std::out_of_range("no such run of the arm");
}

CouplingStudy RunCouplingStudy() {
  const settings::StackConfig config = settings::ParseStackConfig(ShippedStackText("retuned"), "retuned.toml",
                                                                  ShippedModelText("table1"), "table1.toml");
  tune::StepTrial settings = tune::TrialOf(config);
  settings.position.derivative_on_error = true;  // the path has no steps that would kick
  const SmoothPath path(kArmReach, kArmPeakSpeed);
  CouplingStudy study;
  study.c1 = settings.position.c1;
  study.own.fill(ShippedModel("table1").parameters);
  model::SetOwnLoads(model::PlanarArm(StudiedArm()), OfEachJoint{}, study.own);
  for (int k = 0; k < static_cast<int>(std::lround(path.duration() / settings.tick)); ++k) {
    study.time.push_back(k * settings.tick);
    study.reference.push_back(path.angle(study.time.back()));
  }
  for (const bool coupled : {true, false}) {
    for (const Moving& moving : kCases) {
      for (const FeedForward feed_forward : kFeedForwards) {
        CoupledArmRun conditions;
        conditions.moving = moving;
        conditions.feed_forward = feed_forward;
        conditions.coupled = coupled;
        if (coupled || feed_forward == FeedForward::kNone || feed_forward == FeedForward::kOwn) {
          study.runs.push_back(RunArm(study, settings, path, conditions));
        }
      }
    }
  }
  return study;
}

// Spong, Hutchinson, Vidyasagar (2006), section 7.4, with forearm and payload as one body.
std::array<CouplingAlongPath, kArmJoints> ExpectedCoupling(const CouplingStudy& study, const Moving& moving) {
  const model::ArmDescription arm = StudiedArm();
  const model::ArmLink& upper = arm.links[0];
  const model::ArmLink& forearm = arm.links[1];
  const double mass = forearm.mass + arm.payload;
  const double first =
      forearm.mass * forearm.centre + arm.payload * forearm.length;  // moment about the elbow
  const double second = forearm.inertia + forearm.mass * forearm.centre * forearm.centre +
                        arm.payload * forearm.length * forearm.length;
  const double shoulder =
      upper.inertia + upper.mass * upper.centre * upper.centre + mass * upper.length * upper.length;
  const SmoothPath path(kArmReach, kArmPeakSpeed);
  std::array<CouplingAlongPath, kArmJoints> found;
  for (const double time : study.time) {
    const Reference at = ReferenceAt(path, moving, time);
    const double bend = forearm.angle + at.angle[1];
    const double lever = upper.length * first;
    const double M_22 = second, M_12 = second + lever * std::cos(bend);
    const double M_11 = shoulder + second + 2 * lever * std::cos(bend);
    const double h = -lever * std::sin(bend);
    const double v1 = at.speed[0], v2 = at.speed[1], a1 = at.acceleration[0], a2 = at.acceleration[1];
    const double g2 = arm.gravity * first * std::cos(upper.angle + at.angle[0] + bend);
    const double g1 = arm.gravity * (upper.mass * upper.centre + mass * upper.length) *
                          std::cos(upper.angle + at.angle[0]) +
                      g2;
    const OfEachJoint inertia = {(M_11 - study.own[0].J_a) * a1 + M_12 * a2,
                                 M_12 * a1 + (M_22 - study.own[1].J_a) * a2};
    const OfEachJoint velocity = {h * (2 * v1 * v2 + v2 * v2), -h * v1 * v1};
    const OfEachJoint gravity = {g1 - study.own[0].mgl * std::cos(at.angle[0]),
                                 g2 - study.own[1].mgl * std::cos(at.angle[1])};
    for (int i = 0; i < kArmJoints; ++i) {
      CouplingAlongPath& joint = found[i];
      joint.inertia.push_back(inertia[i]);
      joint.velocity.push_back(velocity[i]);
      joint.gravity.push_back(gravity[i]);
      joint.peak = std::max(joint.peak, std::abs(inertia[i] + velocity[i] + gravity[i]));
      joint.peak_inertia = std::max(joint.peak_inertia, std::abs(inertia[i]));
    }
  }
  return found;
}

}  // namespace hydro::experiments
