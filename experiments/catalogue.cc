#include "experiments/experiment.h"

namespace hydro {

const std::vector<Experiment>& Experiments() {
  static const std::vector<Experiment> experiments = {};
  return experiments;
}

}  // namespace hydro
