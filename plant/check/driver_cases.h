// Tries what docs/safety.md promises of a driver, one promise after the other.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::plant {

struct CaseResult {
  enum class Verdict { kKept, kBroken, kNotTried };
  Verdict verdict = Verdict::kBroken;
  std::string found;  // a few words, or what the driver said
  bool begun = true;  // false: the driver never was ready, so the case says nothing of its promise
};

struct DriverCase {
  const char* name;      // what happens
  const char* promised;  // what must follow
  CaseResult (*run)(class DriverTrial& trial);
};

const std::vector<DriverCase>& DriverCases();

// A stack's configuration for the trials, with the overrides that give it a network of its own.
struct TrialSettings {
  std::string file;
  std::vector<std::string> overrides;
  bool verbose = false;
};

// Runs one case with a fresh device and a fresh driver. Throws InputError when either cannot be started.
CaseResult RunDriverCase(const DriverCase& which, const TrialSettings& settings);

}  // namespace hydro::plant
