// How probable each explanation is among those tried: how often it wins when its evidence is weighted at random.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hydro::diagnose {

// What an explanation leaves of the data that it was not fitted to.
struct Evidence {
  std::string id;                    // several ways to fit one explanation have the same
  std::vector<std::string> parts;    // all that it changes, and each value that it frees; sorted
  double numbers = 1;                // NumbersFactor() of its hypothesis
  std::vector<double> squared_gaps;  // by block
};

// Explanations of the same data.
struct Contest {
  std::vector<Evidence> evidence;
  std::vector<std::string> runs;  // that each block is from
  bool geometric = false;         // the squared gap of all blocks is their geometric mean
};

// Weights by id; they add to 1. In each of many draws of random weights for runs, and for blocks within them, the
// explanation with the least Cost() wins; those that come near it by less than a material gain share the win, the
// less the further behind they are. One that adds to another explanation without a material gain has no part. The same
// for any order of the evidence. Empty without evidence.
std::map<std::string, double> Weights(const Contest& contest, uint64_t seed);

}  // namespace hydro::diagnose
