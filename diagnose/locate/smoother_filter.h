// The smoother's forward pass: an extended Kalman filter along a run over the model's states and a wandering
// disturbance in each balance, run in parallel for draws of noise. Only for the smoother's own files.
#pragma once

#include <array>
#include <vector>

#include "diagnose/locate/smoother_mode.h"
#include "diagnose/locate/smoother_record.h"
#include "diagnose/locate/smoother_setup.h"
#include "model/equations/equations.h"

namespace hydro::diagnose::smoother {

class Filter {
 public:
  explicit Filter(const Setup& setup);

  // Filters the whole run.
  Record Run();

 private:
  using Rates = std::array<double, model::kMaxStates>;

  void Begin();
  Matrix BeginCovariance() const;
  void KeepVolumes();
  void CopyStateToColumns();

  // At a sample: takes its readings and sets the mode from it on.
  void ReadSample(size_t k);
  void Correct(size_t k);
  // From one sample to the next.
  void Advance(size_t k);
  double Linearise(size_t k);
  Rates DisturbanceRates(size_t k);
  void IntegrateState(size_t k, int halvings, const Rates& push);
  void RungeKuttaStep(double begin, double h, double voltage, const Rates& push);
  void CrossSwitches(size_t k);
  Matrix Transition(double part, int halvings) const;
  void PropagateCovariance(const Matrix& transition);
  void PropagateColumns(const Matrix& transition);
  void AddUncertainty(size_t k, double step);
  void ForgetArmAtSwitches();

  const Setup& setup_;
  model::Equations equations_;
  ModeAtSample mode_at_sample_;
  Record record_;

  double state_[model::kMaxStates];
  model::Mode mode_;
  model::Terms<double> terms_;
  Matrix first_covariance_;
  Matrix covariance_;
  Columns columns_;               // the data's state, then the draws' differences from it
  Matrix rates_;                  // of all states by all states, in the present mode
  std::vector<double> switched_;  // s, when a switch of an effect changed
};

}  // namespace hydro::diagnose::smoother
