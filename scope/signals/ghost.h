// The model beside the rig. The voltage that was sent drives it, and now and then it is set to the measured
// state. The difference between its motion and the rig's is the gap between them, live.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/started_actuator.h"
#include "scope/signals/channel_list.h"
#include "settings/stack_config.h"

namespace hydro::scope {

// Estimates the noise of a signal from its own samples where nothing states it.

// The standard deviation of the noise on a sampled signal, from the second differences of its newest samples.
// Motion contributes little to them at the rates of a stack, and the median ignores steps and spikes.
class NoiseEstimate {
 public:
  NoiseEstimate();

  void Add(double value);  // NaN: begins again after a gap

  // NaN before kFirst samples, and for a signal without noise.
  double sigma() const { return sigma_; }

  static constexpr size_t kFirst = 256;

 private:
  void Update();

  std::vector<double> differences_;  // a ring of the newest differences
  size_t next_ = 0;
  size_t fresh_ = 0;  // number since the last update
  double before_;
  double last_;
  double sigma_;
};

// What was measured at a tick.
struct GhostSample {
  double time = 0;     // s
  double voltage = 0;  // V, which acted since the tick before
  model::Measurement measured;
  bool after_gap = false;  // states are missing before it, so it is unknown what acted meanwhile
};

class Ghost {
 public:
  using Row = std::array<double, kGhostColumns>;

  // The model, how its shaft is held and the noise are those of `config`. `resync_s` is the plant time in s
  // after which the model is set to the measured state again; 0: only by Sync() and after gaps. Throws
  // InputError for a negative value.
  Ghost(std::shared_ptr<const settings::StackConfig> config, double resync_s);
  ~Ghost();

  // Returns the ghost's values at the sample's time and the residuals (measured value minus ghost's value, in
  // standard deviations of the noise). Returns nothing while the ghost waits for a state to begin from. Where
  // it begins, its values are the measured ones, and the residuals are missing.
  std::optional<Row> Add(const GhostSample& sample);

  // Begins anew with the next sample.
  void Sync() { sync_ = true; }

  // Why the ghost does not run, or the model's last error; empty when there was none.
  const std::string& problem() const { return problem_; }
  int64_t starts() const { return starts_; }

 private:
  void Start(const GhostSample& sample);
  std::optional<double> Slope(double model::Measurement::*angle) const;
  double Sigma(double given, double resolution, const NoiseEstimate& estimate) const;

  std::shared_ptr<const settings::StackConfig> config_;
  double resync_s_;
  std::unique_ptr<trajectory::Trajectory> motion_;  // motion of a driven shaft; the actuator points to it
  std::optional<model::StartedActuator> actuator_;
  std::deque<GhostSample> newest_;
  double started_ = 0;  // s
  bool sync_ = false;
  int64_t starts_ = 0;
  std::string problem_;
  NoiseEstimate p1_;
  NoiseEstimate p2_;
  NoiseEstimate motor_speed_;
};

}  // namespace hydro::scope
