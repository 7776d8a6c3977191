// The evidence that one recording has for each set of mistakes.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "diagnose/evidence/recording_balances.h"
#include "diagnose/recording/recording_mistake.h"

namespace hydro::diagnose {

// The odds against one mistake, a logarithm: of a thousand lines of sidecars one is wrong.
double OddsAgainstMistake();

struct MistakeTrial {
  std::vector<RecordingMistake> mistakes;
  double gain = 0;  // of the log evidence

  // With the odds of that many mistakes.
  double Merit() const { return gain - OddsAgainstMistake() * static_cast<double>(mistakes.size()); }
};

class RunMistakes {
 public:
  // `model` must outlive this.
  RunMistakes(const model::ModelDescription& model, runs::MeasuredRun run);

  // The sets that gain most, best first: single mistakes, and the best sets with one more. `time_is_up` ends the search.
  std::vector<MistakeTrial> Search(const std::function<bool()>& time_is_up) const;
  // These mistakes, as far as this run can have them.
  MistakeTrial Try(const std::vector<RecordingMistake>& mistakes) const;
  // What the log evidence gains by these corrections, which need be none of the known ones.
  double Gain(const std::vector<RecordingMistake>& mistakes) const;
  // The share of its terms that the balance of the run as recorded leaves open that closes best; 0: none is formed, 1: nobody could
  // form one from samples so far apart.
  double LeastLeftOpen() const;

 private:
  const RecordingBalances* Read(const std::vector<RecordingMistake>& mistakes) const;

  const model::ModelDescription& model_;
  runs::MeasuredRun run_;
  std::vector<RecordingMistake> possible_;
  double as_recorded_ = 0;
  bool moves_ = false;  // the motor: nothing is said of a run at rest
  // By the times' factor, the shaft, and the signals that are read as signed numbers.
  mutable std::map<std::tuple<double, model::Shaft, std::string>, RecordingBalances> readings_;
};

}  // namespace hydro::diagnose
