// All cases, and how one becomes a rig: everything is drawn from the seed.
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
  std::string kind;  // single, pair, nothing, bias, drift, newcomer, outside, exact, parameter
  // Effect's id; what is odd about `nothing`; the newcomer's mistake; the value that is wrong; of `exact`
  // also "pair", "triple" or what its noise is.
  std::string what;
  double gap = 0;    // asked for, noise units
  int outside = -1;  // of OutsideForms()
  uint64_t seed = 1;
  Signal inverted = Signal::kNone;  // whose sign is wrong; kNone: drawn
  double noise = 1;                 // of exact rigs, times what their sidecars state
};
// Whether all is exact but what is hidden (MakeExact).
inline bool IsExact(const Case& c) { return c.kind == "exact" || c.kind == "parameter"; }

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
  // Beyond other values, noise units, over kWindow; of `parameter` that of the model as given.
  double gap = 0;
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

// Makes the rig one of which all is exact but what is hidden: the model's values but for the one that is
// wrong, white noise of stated size, runs that begin at rest with the shaft at 0.
void MakeExact(const Case& c, Solved* s);

}  // namespace foreign_rig
