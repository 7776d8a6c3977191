// Values that are held until the next step.
#include <algorithm>

#include "model/trajectory/checks.h"
#include "model/trajectory/trajectory.h"

namespace hydro::trajectory {
namespace {

class Steps : public Trajectory {
 public:
  Steps(double initial, std::vector<Step> steps) : initial_(initial), steps_(std::move(steps)) {
    min_ = max_ = initial_;
    for (const Step& step : steps_) {
      min_ = std::min(min_, step.value);
      max_ = std::max(max_, step.value);
    }
  }

  double Value(double t) const override {
    const auto after = FirstAfter(t);
    return after == steps_.begin() ? initial_ : std::prev(after)->value;
  }
  double Rate(double) const override { return 0; }
  double NextBreak(double t) const override {
    const auto after = FirstAfter(t);
    return after == steps_.end() ? std::numeric_limits<double>::infinity() : after->time;
  }
  bool continuous() const override { return min_ == max_; }
  double Min() const override { return min_; }
  double Max() const override { return max_; }

 private:
  std::vector<Step>::const_iterator FirstAfter(double t) const {
    return std::upper_bound(steps_.begin(), steps_.end(), t,
                            [](double time, const Step& step) { return time < step.time; });
  }

  double initial_;
  std::vector<Step> steps_;
  double min_;
  double max_;
};

}  // namespace

std::unique_ptr<Trajectory> MakeSteps(double initial, std::vector<Step> steps) {
  RequireFinite("initial", initial);
  RequireIncreasing("step", steps);
  return std::make_unique<Steps>(initial, std::move(steps));
}

}  // namespace hydro::trajectory
