// The rig's machine: drive, pump, pipes, actuator and arm, stepped at a fixed small step (Heun's method; the
// bristles exactly, the pipes by their characteristics, ideal valves by projection). Where something is stiff
// a step has parts of 5 us.
#pragma once

#include <array>
#include <vector>

#include "bristle.h"
#include "extras.h"
#include "pipe.h"
#include "poppet.h"
#include "values.h"

namespace foreign_rig {

inline constexpr double kStep = 2e-5;  // s

// What a run has of its own.
struct Day {
  bool clamped = true, bypass = false;
  double arm_angle = 0;                   // rad, at the start
  double shaft_angle = 0;                 // rad, at the start
  double pressure_1 = 0, pressure_2 = 0;  // psi above the supply, at the start
  double celsius = 40;                    // of the oil, at the start
  double friction = 1;                    // times the dry torque
  double friction_draw = 0;               // the day's part of Richness::daily_friction, -1 to 1
  double payload = 0;                     // part of arm weight and inertia added
  double offset_1 = 0, offset_2 = 0;      // psi, of the pressure amplifiers
  double supply = 0;                      // psi added to the supply pressure
  double clock = 0;                       // s, phase of what goes on regardless of the run
  double prelude = 0;                     // s that the machine ran before the recording
};

struct Rig {
  Values values;
  Effects effects;
  Outside outside;
  Richness rich;
};

struct Reading {
  double speed = 0, shaft = 0, arm = 0, p1 = 0, p2 = 0;
};

class Machine {
 public:
  Machine(const Rig& rig, const Day& day);

  // One kStep under this command, V. Throws std::runtime_error where the actuator reaches its end or a value
  // is not finite.
  void Step(double volts);

  // What ideal transducers give, with the faults of Effects and Day.
  Reading Read() const;

  // Goes on from where another machine is; parts that only one of the two has start at rest there. Oil that
  // does not warm in this machine keeps the day's temperature.
  void ContinueFrom(const Machine& other);

  // What of a start no recording tells exactly: the states of the plain equations that are free on this day.
  enum class Start { kSpeed, kPressure1, kPressure2, kArm, kArmRate, kShaft };
  // With the bypass open both sides have the first pressure. The shaft's angle counts where something of this
  // rig depends on it.
  std::vector<Start> FreeStarts() const;
  // Adds to one of them: rad/s, psi, rad, rad/s, rad.
  void Shift(Start start, double by);

  double time() const { return static_cast<double>(steps_) * kStep; }
  // For tests: kinetic and elastic energy, in-lbf, of rotor, arm, oil and shaft.
  double Energy() const;
  double pressure_1() const { return x_[kP1]; }
  double pressure_2() const { return x_[kP2]; }
  double motor_speed() const { return x_[kOmega]; }
  double shaft_angle() const { return x_[kTheta]; }
  double arm_angle() const { return x_[kArm]; }
  double arm_rate() const { return x_[kArmRate]; }
  double celsius() const { return x_[kCelsius]; }

 private:
  enum {
    kTheta,
    kOmega,
    kVane,
    kVaneRate,
    kArm,
    kArmRate,
    kDrive1,
    kDrive2,
    kP1,
    kP2,
    kPump1,
    kPump2,
    kAir1,
    kAir2,
    kCheck1,
    kCheck2,
    kRelief1,
    kRelief2,
    kCelsius,
    kReturned,
    kCreep1,
    kCreep2,
    kSense1a,
    kSense1b,
    kSense2a,
    kSense2b,
    kFade,
    kStates
  };
  using State = std::array<double, kStates>;
  struct Chamber {
    double volume, compliance;  // in^3, in^3/psi
  };

  void BuildParts();
  void Place();
  struct Flows {
    double side_1, side_2;  // in^3/s, into the actuator's sides
  };
  void Rates(const State& x, State& rate) const;
  Flows PumpRates(const State& x, double viscosity, State& rate) const;
  void ValveRates(const State& x, State& rate, Flows* into) const;
  void SideRates(const State& x, State& rate, Flows into) const;
  void TransducerRates(const State& x, State& rate) const;
  double Torque(const State& x, double volts_torque) const;
  double DryLimit(const State& x) const;
  double PumpLosses(const State& x, double viscosity) const;
  double Displacement(const State& x) const;
  double CrossLeakage(const State& x, double dp, double viscosity) const;
  Chamber ChamberOf(const State& x, int side) const;
  void AirRates(const State& x, int side, double volume, double* rate, double* flow) const;
  void ArmRates(const State& x, State& rate) const;
  double ShaftTorque(const State& x) const;
  double Load(const State& x) const;
  double SupplyPressure(const State& x) const;
  void StepBristles(double h);
  void FeedFromSupply();
  void Integrate();
  bool joint() const { return rig_.effects.shaft_stiffness > 0 || rig_.outside.backlash > 0; }
  Reading Plain() const;  // without the late channel
  double SkewedNow() const;
  static double* Channel(Reading* reading, Signal signal);

  Rig rig_;
  Day day_;
  Bristles pump_bristles_, seal_bristles_;
  double pump_bend_ = 0, seal_bend_ = 0;
  Poppet check_, relief_;
  Pipe pipe_1_, pipe_2_;
  double pump_volume_ = 0, pipe_volume_ = 0;  // in^3 a side, with a line
  double vane_inertia_ = 0;
  int parts_ = 1;     // of a step
  double h_ = kStep;  // s, a part
  State x_{};
  double volts_ = 0;              // that the drive has
  std::vector<double> commands_;  // ring, of the drive's delay
  std::vector<double> late_;      // ring, of the skewed signal
  size_t command_at_ = 0, late_at_ = 0;
  long long steps_ = 0;
};

}  // namespace foreign_rig
