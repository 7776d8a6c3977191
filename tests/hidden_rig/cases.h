// All cases of the proof, each with its seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "effect_table.h"

namespace hidden_rig {

struct Case {
  std::string name;
  std::string kind;  // single, pair, triple, nothing, parameter, outside
  uint64_t seed = 1;
  double noise = 1;                  // times the stated noise
  std::vector<std::string> effects;  // ids
  std::string size;                  // singles: small, medium, plain
  double gap = 0;                    // asked for, noise units; 0: the effects' plain sizes
  std::string parameter;             // the one that the given model has wrong
  double factor = 1;                 // given = true * factor
  int outside = -1;                  // of OutsideForms()
};
std::vector<Case> AllCases();

// A case made concrete.
struct Truth {
  RigSetup setup;
  Base given;  // the model that is handed over
  std::vector<TrueEffect> effects;
  double gap = 0;             // noise units, rms over all signals; see Gap()
  bool reached = true;        // the gap asked for
  double beyond_values = -1;  // GapBeyondValues(), where it was asked for
};
struct Options {
  double rate = 1000;
  double seconds = 2.5;
  double noise = 1;
  bool driven = false;
};
Truth Solve(const Case& c, const Options& options);

// The rig's distance, without noise, from a rig with Table 1's values (or those given) and nothing else,
// under the same voltages: rms over all samples of all measured signals of all runs, in stated noise units.
double Gap(const Truth& truth, uint64_t seed, const Options& options);

// What is left of the gap when the base parameters take the values that close it best, linearised at the
// given ones: how much of an effect no other values can explain. Takes a minute.
double GapBeyondValues(const Truth& truth, uint64_t seed, const Options& options);

}  // namespace hidden_rig
