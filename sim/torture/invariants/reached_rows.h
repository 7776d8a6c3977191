// Finds the rows of the safety table (process/safety) that a run has reached.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "sim/torture/schedule/injection.h"

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

}  // namespace hydro::torture
