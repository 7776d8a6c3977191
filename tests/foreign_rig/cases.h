// All cases of the second generation, and how one becomes a rig: everything is drawn from the seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "catalogue.h"
#include "plan.h"
#include "recorder.h"

namespace foreign_rig {

struct Case {
  std::string name;
  std::string kind;  // single, pair, nothing, bias, drift, newcomer, outside
  std::string what;  // effect's id; what is odd about `nothing`; the newcomer's mistake
  double gap = 0;    // asked for, noise units
  int outside = -1;  // of OutsideForms()
  uint64_t seed = 1;
};
// Each with a seed of its own, to which --seed-offset adds. Offsets below 20000 are for development: rigs
// that may be looked at, learned from and drawn again. Multiples of 1000 from there on are sealed: each for
// one score of everything at one commit, and then never again (docs/developers/gap_finder_method.md
// names those that were used).
std::vector<Case> AllCases();

// A mistake in the sidecar or the recording, and words of which a remark must have one of each group.
struct Mistake {
  std::string what;
  std::vector<std::vector<std::string>> remark;
};

struct Solved {
  Rig rig;
  Values given;
  std::vector<Truth> effects;
  std::vector<Plan> plans;
  Recorder recorder;
  Daily daily;
  Mistake mistake;
  double gap = 0;           // beyond other values, noise units, over kWindow
  double gap_at_truth = 0;  // the same against the rig with its own values
  double gap_of_model = 0;  // the same against the model as given
  double richness = 0;      // of the small things that every machine has
  bool reached = true;
};
struct Options {
  double seconds = 5;
  double rate = 0;  // Hz; 0: drawn
};
Solved Solve(const Case& c, const Options& options);

}  // namespace foreign_rig
