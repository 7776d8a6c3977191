// Kinematics of a pump with an odd number of pistons behind a swash plate.
#pragma once

namespace foreign_rig {

// Displacement at a shaft angle relative to its mean: the sum of the half sines of the pistons on the
// pressure side. It pulses twice per piston and turn.
double PistonPulse(int pistons, double angle);

// Amplitude of the pulse's first harmonic.
double PulseAmplitude(int pistons);

}  // namespace foreign_rig
