// What the runs have reached so far: fault codes, rows of the safety table, kinds of injected faults and
// pairs of them.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/torture/schedule/injection.h"

namespace hydro::torture {

struct Coverage {
  int64_t runs = 0;
  int64_t injected = 0;
  double simulated_s = 0;
  int64_t ticks = 0;
  std::map<std::string, int64_t> codes;             // faults that began, by code
  std::set<std::string> rows;                       // rows of process/safety, by id
  std::map<FaultKind, int64_t> kinds;               // injections by kind
  std::set<std::pair<FaultKind, FaultKind>> pairs;  // pairs active within a second of each other

  void Add(const Coverage& other);
  void AddPairs(const std::vector<Injection>& injections);
  // Adds the rows that a run with these injections and `codes` has reached.
  void AddRows(const std::vector<Injection>& injections);
  // Lists what was not reached, one line each.
  std::string Report() const;
};

}  // namespace hydro::torture
