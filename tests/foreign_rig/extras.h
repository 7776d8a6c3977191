// All that can act on a rig beyond its plain values. 0 is always: not there.
#pragma once

namespace foreign_rig {

enum class Signal { kNone, kMotorSpeed, kArmAngle, kP1, kP2 };

// Effects of the catalogue's meaning, in other forms than the catalogue's.
struct Effects {
  // Drive.
  double lag = 0;             // s, of two stages
  double delay = 0;           // s
  double back_emf_speed = 0;  // rad/s at which the supply's voltage is used up
  double stall_ratio = 1.2;   // torque that the supply could drive at rest, of the limit
  double bias = 0;            // in-lbf
  double cogging = 0;         // in-lbf, of the main harmonic
  int slots = 6;              // main harmonic, 1/rev
  double cogging_phase = 0;   // rad
  // Pump.
  double static_excess = 0;         // of the dry torque
  double stribeck_speed = 3;        // rad/s
  double bristle_give = 0;          // rad that the bristles bend before they slip
  double friction_by_pressure = 0;  // in-lbf/psi
  double dry_asymmetry = 0, viscous_asymmetry = 0;
  double churning = 0;  // in-lbf at 300 rad/s
  double churning_power = 2;
  double orifice = 0;              // in^3/s/psi^.5 between the sides
  double orifice_transition = 30;  // psi below which the orifice is laminar
  double piston_ripple = 0;        // amplitude of the first harmonic, of the displacement
  int pistons = 9;
  // Fluid.
  double air = 0;              // part of the volume at atmospheric pressure
  double air_dissolves = 3;    // s
  double hose_stiffening = 0;  // psi/psi at low pressure
  double hose_knee = 800;      // psi
  double warming = 0;          // 1/s, of the viscosity at the start
  double warming_time = 15;    // s
  double line_delay = 0;       // s for a wave to run through
  double line_part = 0.3;      // of mid_volume that is not at the actuator
  double line_loss = 0;        // of a wave's height lost in a pass
  // Valves.
  double check_cracking = 0;   // psi
  double check_flow = 0;       // in^3/s/psi^.5 when open
  double relief_flow = 0;      // in^3/s/psi^.5 when open
  double relief_set = 750;     // psi
  double accumulator_gas = 0;  // in^3 of gas when charged; 0: infinite
  // Arm.
  double seal_dry = 0, seal_viscous = 0;
  double shaft_stiffness = 0, shaft_damping = 0;
  // Sensors.
  double pressure_lag = 0;  // s, of two stages
  double offset_1 = 0, offset_2 = 0;
  double gain = 0;
  double drift_1 = 0, drift_2 = 0;  // psi/s at the start
  double skew = 0;                  // s
  Signal skewed = Signal::kNone, inverted = Signal::kNone;
};

// Effects that the catalogue lacks.
struct Outside {
  double backlash = 0;          // rad of play between vane and arm
  double arm_spring = 0;        // in-lbf/rad, hardening
  double iron_saturation = 0;   // part of the torque lost at its limit
  double position_leakage = 0;  // in^3/s/psi at 0.1 rad off a worn place
  double hose_creep = 0;        // part of the compliance that follows late
  double gravity_offset = 0;    // in-lbf, times sin alpha
  double film_friction = 0;     // in-lbf at 100 rad/s, growing as the square root of speed
  double floor_shake = 0;       // in-lbf on the arm
  double end_cushion = 0;       // in-lbf/rad^2 near the ends
  double case_stretch = 0;      // part of the displacement lost at 1000 psi
  double motor_fade = 0;        // 1/s, part of the torque lost at its limit
  double slow_torque = 0;       // in-lbf on the pump, a wave of the day's clock
};

// Small things that every real machine has, as a whole scaled by one number.
struct Richness {
  double size = 0;
  double bristle_give = 0;    // rad that the pump's bristles bend at size 1
  double once_a_turn = 0;     // in-lbf of friction that depends on the shaft's angle
  double once_phase = 0;      // rad
  double creep = 0;           // part of the compliance that follows late
  double gravity_offset = 0;  // in-lbf
  double daily_friction = 0;  // part by which the dry torque differs from run to run
};

}  // namespace foreign_rig
