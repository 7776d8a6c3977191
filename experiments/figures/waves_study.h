// The pressure waves in the lines: the wave mode, the gains that it allows, a swept sine, and trials over the
// stack.
#pragma once

#include <complex>
#include <vector>

#include "experiments/runs/pressure_loop_run.h"
#include "experiments/runs/pressure_sweep.h"
#include "experiments/studies/experiment.h"
#include "model/linearise.h"
#include "model/terms/description.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "tune/design/linear_loop.h"

namespace hydro::experiments {

inline constexpr double kWaveHz = 300;          // as the paper measured
inline constexpr double kVolumeFraction = 0.1;  // of V_ms on the pump's side of the line: ASSUMED
inline constexpr double kWaveDamping = 0.01;    // ASSUMED: the paper says nothing
inline constexpr double kMostFactor = 200;      // largest factor on k_p searched
inline constexpr double kMostFrequency = 3000;  // rad/s

// The limits that the wave sets in one loop.
struct WaveLimits {
  design::GainLimit gain;        // factor on the design's k_p, k_v unchanged
  double natural_frequency = 0;  // rad/s, when both gains follow from it and zeta = .5
};

// The loop, run over the stack close to its limit, shows how a wave grows or decays after a small step.
struct GainTrial {
  double factor = 0;  // fraction of the limit
  std::vector<double> time;
  std::vector<double> dp;
  double growth = 0;    // 1/s, measured
  double expected = 0;  // 1/s, the pole's real part
};

// The pressure loop at one sampling interval, with a command delay.
struct SampledPressureLoop {
  design::LoopTiming timing;
  WaveLimits limits;
};

// The same line between other volumes, or with other damping.
struct LineVariant {
  double volume_fraction = 0;
  double damping = 0;
  double closed_form_hz = 0;
  double mode_hz = 0;
  WaveLimits limits;
};

struct WavesStudy {
  model::Parameters p;
  pressure_ctrl::PressureGains gains;
  model::ModelDescription model;
  model::LinearModel linear;

  // The analog loop.
  std::complex<double> closed_pole;
  double mode_hz = 0;
  double mode_damping = 0;
  WaveLimits limits;
  WaveLimits at_pump;  // with the transducers at the pump

  std::vector<SampledPressureLoop> sampled;
  // 5 kHz with one tick of delay, as in config/paper.toml.
  const SampledPressureLoop& shipped() const { return sampled[3]; }
  const SampledPressureLoop& slow() const { return sampled[4]; }

  // The swept sine at the design's gains.
  PressureSweep sweep;
  SweptPressureLoop swept;
  double worst_db = 0;
  double worst_deg = 0;
  design::ResponsePoint peak;

  std::vector<GainTrial> trials;        // just below and just above the shipped loop's limit
  std::vector<LineVariant> by_volume;   // volume_fraction varies
  std::vector<LineVariant> by_damping;  // damping varies

  double highest_k_p() const { return limits.gain.factor * gains.k_p; }
  design::LinearPressureLoop swept_linear() const { return {linear, {1 / sweep.rate_hz, 0}}; }
};

// Table 1 with wave effects, analysed and run.
WavesStudy StudyWaves(const ExperimentOptions& options);

// Wave frequency, Hz, of a line with this fraction of V_ms on the pump's side: w^2 is proportional to 1/V_p +
// 1/(V_ms - V_p).
double ClosedFormHz(double volume_fraction);

// The linear model of a clamped actuator with both sides compressing.
model::LinearModel LinearisedClamped(const model::ModelDescription& model);
// The same model with the pressure transducers at the pump instead of at the actuator.
model::LinearModel SensedAtPump(model::LinearModel model);

// The pole of the wave that the loop sees in the pressure difference: the fastest visible pole.
std::complex<double> WavePole(const design::LinearPressureLoop& loop,
                              const pressure_ctrl::PressureGains& gains);

}  // namespace hydro::experiments
