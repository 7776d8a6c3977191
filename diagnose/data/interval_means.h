// A run in a hundred or so intervals of as many samples each: long enough to average noise, short enough to follow the motion.
#pragma once

#include <cstddef>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::diagnose {

class IntervalMeans {
 public:
  explicit IntervalMeans(const runs::MeasuredRun& run);

  // Of each interval; NaN where it has no value. `values`: one for each sample of the run.
  std::vector<double> Means(const std::vector<double>& values) const;
  // Per second, by the neighbours on both sides; NaN at both ends.
  std::vector<double> Rates(const std::vector<double>& means) const;

  const std::vector<double>& times() const { return time_; }  // s, means

 private:
  size_t length_, count_;
  std::vector<double> time_;
};

}  // namespace hydro::diagnose
