// How well the balances of one recording close when its signals are multiplied, inverted or exchanged. Every
// term of a balance is weighed with the test functions once. A correction then only multiplies terms, so that
// any combination can be tried.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "diagnose/recording/recording_mistake.h"
#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// The factors by which a recording's numbers are multiplied.
struct SignalFactors {
  double voltage = 1, motor_speed = 1, motor_angle = 1, arm_angle = 1, arm_speed = 1;
  double p1 = 1, p2 = 1;   // of the recorded columns, before they change places
  bool exchanged = false;  // p1 and p2 change places
};
// Adds the factors that undo one more mistake.
void AddFactors(const RecordingMistake& mistake, SignalFactors* factors);

// A term of a balance. It is known with relative error `sd`, apart from the factor that a correction gives
// it.
struct SignalTerm {
  std::function<double(const SignalFactors&)> factor;
  double sd = 0;
  int group = 0;  // terms of one group form one term: a difference of pressures
};

// The terms of one balance of the recording, whose sum is 0, and their products in each band of frequencies.
struct TermBalance {
  // Whether this balance is the one that applies under the correction.
  std::function<bool(const SignalFactors&)> holds = [](const SignalFactors&) { return true; };
  std::vector<SignalTerm> terms;
  struct Band {
    Eigen::MatrixXd products, noise;  // of the terms, and of what noise adds to them
  };
  std::vector<Band> bands;
  mutable std::map<std::vector<double>, double> evidence;  // cached, by the terms' factors
};

// Eqs. (4), (13), (14), (15) of the recording, and the balance that a speed is the rate of its angle.
class RecordingBalances {
 public:
  // `run` has its times and shaft as they are to be understood, and all other signals as recorded. `possible`
  // lists the mistakes from which factors will be made.
  RecordingBalances(const model::ModelDescription& model, const runs::MeasuredRun& run,
                    const std::vector<RecordingMistake>& possible);

  // The log evidence of the numbers multiplied by these factors, against balances that explain nothing: how
  // much smaller the remainder is than the terms, at the likeliest values of the model. Each balance counts
  // as kNumbers independent numbers, because what a model lacks is correlated within a band. Returns 0 where
  // no balance can be formed: an absent balance is no evidence.
  double Evidence(const SignalFactors& factors) const;
  // The balance that closes best leaves open this share of its terms, a ratio of squares. 0 where no balance
  // is formed.
  double LeastLeftOpen() const;
  // Whether any balance is formed.
  bool Formed() const { return !balances_.empty(); }

 private:
  double EvidenceOf(const TermBalance& balance, const SignalFactors& factors) const;

  std::vector<TermBalance> balances_;
};

}  // namespace hydro::diagnose
