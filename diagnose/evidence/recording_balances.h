// How well the balances of a single recording close when its signals are multiplied, turned round or exchanged. Every term of a
// balance is weighed with the test functions once; a correction then multiplies terms, so that any combination can be tried.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "diagnose/recording/recording_mistake.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// What a recording's numbers are to be multiplied by.
struct SignalFactors {
  double voltage = 1, motor_speed = 1, motor_angle = 1, arm_angle = 1, arm_speed = 1;
  double p1 = 1, p2 = 1;   // of the columns, before they change places
  bool exchanged = false;  // p1 and p2
};
// Adds what undoes one more mistake.
void AddFactors(const RecordingMistake& mistake, SignalFactors* factors);

// A term of a balance: known to `sd`, relative, times the factor that a correction gives it.
struct SignalTerm {
  std::function<double(const SignalFactors&)> factor;
  double sd = 0;
  int group = 0;  // terms of one group are a single one: a difference of pressures
};

// The terms of one balance of the recording, whose sum is 0, and their products in each band of frequencies.
struct TermBalance {
  // Whether it is this one for the correction.
  std::function<bool(const SignalFactors&)> holds = [](const SignalFactors&) { return true; };
  std::vector<SignalTerm> terms;
  struct Band {
    Eigen::MatrixXd products, noise;  // of the terms, and of what noise adds to them
  };
  std::vector<Band> bands;
  mutable std::map<std::vector<double>, double> evidence;  // that was asked for, by the terms' factors
};

// Eqs. (4), (13), (14), (15) of the recording, and that a speed is the rate of its angle.
class RecordingBalances {
 public:
  // `run`: its times and shaft as they are to be understood, all other signals as recorded; `possible`: the mistakes that
  // factors will be of.
  RecordingBalances(const model::ModelDescription& model, const runs::MeasuredRun& run,
                    const std::vector<RecordingMistake>& possible);

  // The log evidence of the numbers multiplied by these factors, against balances that explain nothing: by how much what is left is
  // smaller than the terms, at the likeliest values of the model. Each balance counts as kNumbers independent numbers, as what a model
  // lacks is of one piece in a band. 0 where nothing can be formed: what says nothing is no evidence.
  double Evidence(const SignalFactors& factors) const;
  // The share of its terms that the balance that closes best leaves open, a ratio of squares; 0 where none is formed.
  double LeastLeftOpen() const;

 private:
  double EvidenceOf(const TermBalance& balance, const SignalFactors& factors) const;

  std::vector<TermBalance> balances_;
};

}  // namespace hydro::diagnose
