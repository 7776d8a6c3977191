// What the runs have reached so far, and which rows of the safety table (process/safety) that includes.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {

// A word of SafetyRow::injected: "slow" or "slow:plant".
struct NamedFault {
  FaultKind kind;
  std::optional<int> target;  // the role that it must hit; empty: any
};

// Returns nothing where there is no such kind, or no such kind with that target.
std::optional<NamedFault> FaultNamed(std::string_view word);

// The ids of the rows that name one of the injections and, if they have codes, one of whose codes has
// occurred.
std::set<std::string> ReachedRows(const std::vector<Injection>& injections,
                                  const std::map<std::string, int64_t>& codes);

// Lines that say how many of the table's rows are in `reached`, and list each row that is not, with the
// reason that the table gives.
std::string RowsReport(const std::set<std::string>& reached);

// Fault codes, rows of the safety table, kinds of injected faults and pairs of them.
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
