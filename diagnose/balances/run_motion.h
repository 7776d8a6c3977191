// A measured run in the form that the balances need: every signal is smoothed alike on one even grid, with
// its derivatives. A filter that is the same for all signals leaves every linear balance unchanged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "diagnose/recording/run_data.h"
#include "model/balances.h"

namespace hydro::diagnose {

// The signals from which balances are made.
enum class GridChannel { kSpeed, kAngle, kArm, kP1, kP2 };
inline constexpr size_t kGridChannels = 5;
inline constexpr runs::MeasuredSignal runs::MeasuredRun::*kSignalOf[kGridChannels] = {
    &runs::MeasuredRun::motor_speed, &runs::MeasuredRun::motor_angle, &runs::MeasuredRun::arm_angle,
    &runs::MeasuredRun::p1, &runs::MeasuredRun::p2};
// s: the balances are needed at this interval, at four times the highest frequency of their test functions.
inline constexpr double kBalanceStep = 2e-3;

// One measured signal on the grid, with its gaps bridged.
struct GridSignal {
  std::vector<double> values;  // empty: not measured
  double noise = 0;            // standard deviation, white, at its own samples
  double interval = 0;         // s, between its own samples
  std::vector<uint8_t> gap;    // 1: further from the nearest sample than the signal's own interval

  bool measured() const { return !values.empty(); }
};

// How the balances change with the pressures at one instant, for a run in which one or both pressures were
// not measured.
struct PressureSlopes {
  std::array<double, 2> torque{};               // by p1, p2
  std::array<std::array<double, 2>, 2> flow{};  // of each side, by p1, p2
  std::array<double, 2> capacity{};             // V/beta of each side
  std::array<bool, 2> moves{};                  // marched, and not held by its valve
};

struct RunMotion {
  std::string name;
  model::ActuatorOptions options;           // how the shaft was held
  double step = 0;                          // s, of the grid
  double interval = 0;                      // s, between the samples of the recording
  size_t stride = 1;                        // the balances need only every stride-th instant
  std::vector<double> voltage;              // held from each instant to the next
  std::vector<model::Surroundings> around;  // at each instant; empty: none were recorded
  std::array<GridSignal, kGridChannels> signals;
  bool pressures = false;    // both are known, and the bypass does not connect the two sides
  bool arm_moves = false;    // and its motion was measured
  bool speed_known = false;  // measured, or derived from the angle
  // The speed is the derivative of the angle: it was not measured, or contradicts the angle.
  bool from_angle = false;
  double speed_noise = 0;              // rad/s, of the smoothed speed
  std::vector<model::KnownMotion> at;  // one entry an instant
  // At every stride-th instant, where a pressure was not measured but follows from the flow balance
  // (latent_pressures.h); otherwise empty.
  std::vector<PressureSlopes> slopes;

  size_t size() const { return at.size(); }
  const GridSignal& Of(GridChannel signal) const { return signals[static_cast<size_t>(signal)]; }
  // Whether a pressure is known although it was not measured.
  bool IsLatent(GridChannel signal) const { return pressures && !Of(signal).measured(); }
};

// s, width of the Gaussian that smooths all signals. It passes up to 120 Hz; beyond that, derivatives of
// noisy signals say little.
inline constexpr double kSmoothing = 1.5e-3;
double SmoothingOf(double step);

struct ReadAs {
  // Sensors ("p1") whose readings have the wrong sign. Their sign is turned back.
  std::vector<std::string> inverted = {};
  // Of so many samples only the first is read, and the command is their mean.
  size_t every = 1;
  // What is known of a sensor's noise from other runs: it is not smaller in this one.
  std::array<double, kGridChannels> least_noise = {};
};
RunMotion MotionOf(const RunData& run, const model::Parameters& given, const ReadAs& as = {});

// The same motion with the sensors' noise added once more, from a separate generator. The difference shows
// what noise does.
RunMotion WithNoiseAgain(const RunMotion& run, const model::Parameters& given, uint64_t seed);
// The same motion after `errors` times `part` has been subtracted from the measured signals. `errors` has one
// series for each smoothed signal; an empty series means none.
struct SignalErrors {
  std::array<std::vector<double>, kGridChannels> of;
};
RunMotion Without(const RunMotion& run, const SignalErrors& errors, double part);

// Centred derivative of sixth order, 1/s.
std::vector<double> Derivative(const std::vector<double>& values, double step);
// Gaussian, `sigma` in samples; mirrored at the ends.
std::vector<double> Smoothed(const std::vector<double>& values, double sigma);

}  // namespace hydro::diagnose
