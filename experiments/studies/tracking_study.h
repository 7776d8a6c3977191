// What Figures 4 and 5 share: the closed pressure loop follows a wave, with and without feed-forward.
#pragma once

#include <string>
#include <vector>

#include "experiments/runs/pressure_loop_run.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {

// The paper prints neither amplitude nor frequency of its references.
inline constexpr double kWaveAmplitude = 300;  // psi
inline constexpr double kWaveFrequency = 10;   // Hz
inline constexpr double kWaveDuration = 1;     // s
inline constexpr double kWaveSettled = 0.5;    // s; from here on all periods are alike
inline constexpr double kHoldDuration = 1.5;   // s, of a constant reference

struct TrackingStudy {
  std::string figure;  // "fig4"
  std::string kind;    // of the reference: "square", "sine"

  pressure_ctrl::PressureGains gains;
  double feedforward = 0;  // V/psi, supplies everything except T_s in the steady state
  // V/psi, also supplies T_s at a reference of kWaveAmplitude
  double tuned_feedforward = 0;

  // The wave without and with feed-forward, and a reference held at its amplitude.
  PressureLoopRun wave, wave_with;
  PressureLoopRun hold, hold_with;
  PressureLoopRun noisy;  // empty unless requested

  TrackingError error, error_with;
  double steady_state_error = 0, steady_state_error_with = 0;  // psi, of the held reference
  double largest_demand = 0;  // in-lbf, demand of eq. (16) before the limit, wave without feed-forward

  struct AtFrequency {
    double frequency = 0;  // Hz
    TrackingError error;   // without feed-forward
  };
  std::vector<AtFrequency> by_frequency;
};

TrackingStudy RunTrackingStudy(const ExperimentOptions& options, const std::string& figure,
                               const std::string& kind);

// Conditions, comparisons, numbers, table and the pictures of the wave; each figure adds the rest.
ExperimentResult DescribeTracking(const TrackingStudy& study);

// The error that remains when the reference rests, and why.
std::string SteadyStateText(const TrackingStudy& study);

// The keys of [reference] that make the wave.
std::string WaveReference(const std::string& kind, double frequency);

}  // namespace hydro::experiments
