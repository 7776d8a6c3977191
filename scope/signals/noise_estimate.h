// Estimates the noise of a signal from its own samples where nothing states it.
#pragma once

#include <cstddef>
#include <vector>

namespace hydro::scope {

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

}  // namespace hydro::scope
