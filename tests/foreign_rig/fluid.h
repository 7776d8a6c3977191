// What the oil is like: compressibility with free and dissolved air, and viscosity over temperature.
#pragma once

namespace foreign_rig {

inline constexpr double kAtmosphere = 14.696;  // psi
// Where all air of a rig is in solution, psi.
inline constexpr double kAllDissolved = 4000;

// Viscosity relative to that at 40 degrees C, of an ISO VG 46 oil (Vogel's equation).
double RelativeViscosity(double celsius);
// Its relative change per degree.
double ViscositySlope(double celsius);

// Free air that stays in equilibrium at gauge pressure p, of `total` at atmospheric pressure (Henry's law,
// until all of it is dissolved at `all_dissolved`).
double FreeAir(double total, double p, double all_dissolved);

// Compressibility, 1/psi, of oil with `free` air (its part of the volume at atmospheric pressure), which
// is compressed isothermally: bubbles are small and give off their heat.
double AirCompressibility(double free, double p);

// Bulk modulus of a hose that stiffens: grows by `slope` psi/psi at low pressure, and by no more above the
// knee.
double HoseModulus(double at_rest, double slope, double knee, double p);

}  // namespace foreign_rig
