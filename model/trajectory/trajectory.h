// A prescribed signal over time, which the position loop follows or which moves a driven shaft. It is a pure
// function of time, built once from its specification.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace hydro::trajectory {

class Trajectory {
 public:
  virtual ~Trajectory() = default;

  // The signal at time t (s). Before its start, it has its initial value.
  virtual double Value(double t) const = 0;

  // d Value/dt; 0 at a jump.
  virtual double Rate(double t) const = 0;

  // The first time after t at which Value jumps or its formula changes; infinity if there is none. An
  // integrator that follows the signal stops there.
  virtual double NextBreak(double t) const = 0;

  // True when Value has no jumps, so that a shaft can be driven along it.
  virtual bool continuous() const = 0;

  // The smallest and the largest value that the signal ever takes.
  virtual double Min() const = 0;
  virtual double Max() const = 0;
};

struct Step {
  double time = 0;   // s
  double value = 0;  // the signal's unit
};

enum class Interpolation {
  kHold,    // the newest point's value (jumps)
  kLinear,  // straight lines
  kCubic,   // monotone cubic (Fritsch-Carlson): smooth, never outside the points' range between two points
};

// `initial` before the first step, then each step's value from its time on. Times strictly increase. Like the
// functions below, it throws std::invalid_argument naming the offending step or the non-finite number.
std::unique_ptr<Trajectory> MakeSteps(double initial, std::vector<Step> steps);

// `offset` before `start`; then offset + amplitude sin(2 pi frequency (t - start) + phase).
std::unique_ptr<Trajectory> MakeSine(double offset, double amplitude, double frequency_hz, double start,
                                     double phase_rad);

// `offset` before `start`; then offset + amplitude for the first half of each period and offset - amplitude
// for the second.
std::unique_ptr<Trajectory> MakeSquare(double offset, double amplitude, double frequency_hz, double start);

// `offset` before `start`; then a sine whose frequency changes linearly from first_hz to last_hz over
// duration s and then stays.
std::unique_ptr<Trajectory> MakeChirp(double offset, double amplitude, double first_hz, double last_hz,
                                      double start, double duration);

// A curve through points (times strictly increase). It has the first value before them and the last value
// after them.
std::unique_ptr<Trajectory> MakePoints(std::vector<Step> points, Interpolation interpolation);

}  // namespace hydro::trajectory
