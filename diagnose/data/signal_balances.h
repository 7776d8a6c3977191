// How well a recording's signals fit each other when they are multiplied, turned round or exchanged: without a
// simulation, so that every combination can be tried.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnose/data/balance_rows.h"
#include "diagnose/data/recording_mistake.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// What a recording's numbers are to be multiplied by.
struct SignalFactors {
  double time = 1, voltage = 1, motor_speed = 1, motor_angle = 1, arm_angle = 1, arm_speed = 1;
  double p1 = 1, p2 = 1;   // of the columns, before they change places
  bool exchanged = false;  // p1 and p2
};
// Adds what undoes one more mistake.
void AddFactors(const RecordingMistake& mistake, SignalFactors* factors);

// The balances, integrated over short segments: speeds are the rates of angles; eq. (4), the torque on the pump; eqs.
// (13) and (14), the flows. None of them has the arm's torque, so what the arm carries does not matter.
class SignalBalances {
 public:
  // `windows`: stretches in which signals move; `run`: all of it. The commands' factors are those of `possible`.
  SignalBalances(const model::Parameters& model, const runs::MeasuredRun& run,
                 const std::vector<runs::MeasuredRun>& windows,
                 const std::vector<RecordingMistake>& possible);

  // The logarithm of what the balances leave open of their terms, added up over the balances, in the median window.
  double LeftOpen(const SignalFactors& factors) const;

 private:
  // The terms of a balance: a row for each segment, whose sum with the right coefficients is 0.
  struct Balance {
    Eigen::MatrixXd terms;
    std::vector<Eigen::Index> first;  // row of each window, and the end
    Eigen::MatrixXd squares;          // of each term, a row for each window
    double LeftOpen(const Eigen::VectorXd& coefficients) const;
  };
  static Balance BalanceOf(const BalanceRows& rows);
  double TorqueLeftOpen(const SignalFactors& factors) const;
  double FlowLeftOpen(const SignalFactors& factors, int side) const;

  bool flow_ = false, angle_only_ = false, arm_speed_only_ = false, clamped_ = false;
  std::vector<double> commands_;             // sizes of the voltage's factors
  Balance motor_, arm_, torque_, flows_[2];  // flows_ by column: p1, p2
};

}  // namespace hydro::diagnose
