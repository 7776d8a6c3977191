// Which rows of the safety table (process/safety) a run has reached.
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
  std::optional<int> target;  // whom it must hit; empty: anybody
};

// Nothing where there is no such kind, or none with that target.
std::optional<NamedFault> FaultNamed(std::string_view word);

// By id: rows with an injection that they name, and of whose codes, if they have any, one has occurred.
std::set<std::string> ReachedRows(const std::vector<Injection>& injections,
                                  const std::map<std::string, int64_t>& codes);

// Lines: how many of the table's rows are in `reached`, and each that is not, with the reason that the table gives.
std::string RowsReport(const std::set<std::string>& reached);

}  // namespace hydro::torture
