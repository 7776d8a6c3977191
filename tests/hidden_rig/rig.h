// A simulated test rig, written independently: it shares no code with the model that is tested against it,
// and its physics is richer. The gap finder gets what its sensors record and must say what is in it.
//
// Units: in, lbf, s, psi, rad, V. Signs are the paper's: positive motor speed pumps fluid from side 1 to side
// 2.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hidden_rig {

// The paper's Table 1; the paper gives no mass of the arm, so the gravity torque is an assumption.
struct Base {
  double k_1 = 4.0, T_pmax = 40.0, D = 0.00796, J = 0.03, b = 0.01455, T_s = 4.0, f = 0;
  double beta = 247000, V_ms = 3.16, c = 1.83 * 1.83 * 2.20 / 2, c_E = 6.5e-6, c_I = 1.0e-6, p_3 = 100;
  double k_2 = 3.68, J_a = 23.3, mgl = 300;
};

enum class Channel { kNone, kMotorSpeed, kArmAngle, kP1, kP2 };

// What else acts, in the parameters of the catalogue; 0: inactive.
struct Effects {
  double lag_tau = 0, delay = 0, no_load_speed = 0;
  double cogging = 0, cogging_periods = 6, cogging_phase = 0.7;
  double pressure_friction = 0, stribeck_excess = 0, stribeck_speed = 3;
  double asymmetry_coulomb = 0, asymmetry_viscous = 0, quadratic_drag = 0;
  double turbulent_leakage = 0, flow_ripple = 0, flow_ripple_periods = 9;
  double air_fraction = 0, stiffening = 0, warming = 0;
  double wave_hz = 0, wave_fraction = 0.3, wave_damping = 0.08;
  double check_cracking = 0, check_conductance = 0;
  double relief_set = 0, relief_conductance = 0, accumulator = 0;
  double seal_coulomb = 0, seal_viscous = 0, flexure_stiffness = 0, flexure_damping = 0;
  double sensor_tau = 0, offset_p1 = 0, offset_p2 = 0, gain = 0, skew = 0;
  Channel skew_channel = Channel::kNone, sign_channel = Channel::kNone;
};

// Effects that the catalogue lacks.
struct Outside {
  double arm_spring = 0;         // in-lbf/rad, about mid-stroke
  double daily_torque = 0;       // in-lbf on the pump, a slow wave over the time of day
  double backlash = 0;           // rad of play between actuator and arm
  double leakage_position = 0;   // in^3/(s psi rad): cross-port leakage + this |alpha|
  double gravity_sine = 0;       // in-lbf, mgl cos alpha + this sin alpha
  double torque_saturation = 0;  // part of k_1 lost at T_pmax, growing with the square of the torque
  double hose_creep = 0;         // part of the fluid's compliance that follows with 0.15 s
  double end_cushion = 0;        // in-lbf/rad beyond +/- 0.12 rad
  double torque_fade = 0;        // 1/s, k_1 falls while the motor is loaded
  double floor_vibration = 0;    // in-lbf on the arm at 9 Hz
};

enum class Shaft { kFree, kClamped, kDriven };

// One run: how the shaft is held, and what the motor is told to do. Each segment lasts until the next begins.
struct Segment {
  enum class Kind { kVoltage, kPressure, kAngle } kind = Kind::kVoltage;
  enum class Form { kHold, kRamp, kSine, kSquare, kChirp } form = Form::kHold;
  double start = 0;      // s
  double offset = 0;     // V, psi or rad
  double amplitude = 0;  // the same; a ramp goes from offset to offset + amplitude
  double hz = 0, hz_end = 0;
  double end = 0;  // s, of ramps and chirps
};
struct Plan {
  std::string name;  // says what was done, never what is in the rig
  Shaft shaft = Shaft::kFree;
  double arm_angle = 0;  // rad, clamped: where; free: where it starts
  bool bypass = false;
  std::vector<Segment> segments;
  double motion_amplitude = 0, motion_hz = 0;  // driven: the arm's motion, rad
};

struct Conditions {
  double rate = 1000;  // Hz, of recording and of the pressure loop
  double seconds = 2.5;
  double noise = 1;                              // times the stated noise; 0: neither noise nor quantisation
  uint64_t seed = 1;                             // of the noise
  double time_of_day = 0;                        // s
  bool trivia = true;                            // the small effects that every real rig has
  const std::vector<double>* voltage = nullptr;  // replayed instead of the plan's commands and loops
};

struct Record {
  std::vector<double> time, voltage, pressure_ref, motor_speed, arm_angle, p1, p2;
};

// Stated standard deviations: of the transducers, the tachometer, and the encoder's steps of 2 pi / 2^14.
inline constexpr double kPressureNoise = 1.5;
inline constexpr double kSpeedNoise = 0.3;
inline constexpr double kAngleStep = 6.283185307179586 / 16384;
inline constexpr double kAngleNoise = 1.107e-4;

struct RigSetup {
  Base base;
  Effects effects;
  Outside outside;
};

// Throws std::runtime_error when the rig breaks: a volume that reaches 0, a value that is not finite.
Record RecordRun(const RigSetup& setup, const Plan& plan, const Conditions& conditions);

}  // namespace hidden_rig
