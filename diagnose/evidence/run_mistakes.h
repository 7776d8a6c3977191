// The evidence that one recording has for each set of mistakes.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "diagnose/evidence/recording_balances.h"
#include "diagnose/recording/recording_mistake.h"

namespace hydro::diagnose {

// The logarithm of the odds against one mistake: about one sidecar line in a thousand is wrong.
double OddsAgainstMistake();
// A clear gain of the log evidence, beside any odds: ten to one.
double ClearGain();

struct MistakeTrial {
  std::vector<RecordingMistake> mistakes;
  double gain = 0;  // of the log evidence

  // The gain less the odds against that many mistakes.
  double Merit() const { return gain - OddsAgainstMistake() * static_cast<double>(mistakes.size()); }
};

class RunMistakes {
 public:
  // `model` must outlive this object.
  RunMistakes(const model::ModelDescription& model, runs::MeasuredRun run);

  // The sets that gain most, best first: single mistakes, and the best sets extended by one mistake.
  // `time_is_up` ends the search.
  std::vector<MistakeTrial> Search(const std::function<bool()>& time_is_up) const;
  // Tries these mistakes, leaving out those that this run cannot have.
  MistakeTrial Try(const std::vector<RecordingMistake>& mistakes) const;
  // What the log evidence gains by these corrections, which need not be among the known mistakes.
  double Gain(const std::vector<RecordingMistake>& mistakes) const;
  // The share of its terms that the best-closing balance of the run as recorded leaves open. 0: no balance is
  // formed. 1: the samples are too far apart, or too close, to form one.
  double LeastLeftOpen() const;
  // Whether the run as recorded forms any balance. False too where its samples are too far apart or too
  // close.
  bool Formed() const;
  // Whether the motor certainly moves. Nothing is said about a run at rest.
  bool moves() const { return moves_; }

 private:
  const RecordingBalances* Read(const std::vector<RecordingMistake>& mistakes) const;

  const model::ModelDescription& model_;
  runs::MeasuredRun run_;
  std::vector<RecordingMistake> possible_;
  double as_recorded_ = 0;
  bool moves_ = false;
  // By the factor of the times, the shaft, and the signals that are read as signed numbers.
  mutable std::map<std::tuple<double, model::Shaft, std::string>, RecordingBalances> readings_;
};

}  // namespace hydro::diagnose
