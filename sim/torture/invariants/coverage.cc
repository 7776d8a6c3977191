#include "sim/torture/invariants/coverage.h"

#include <fmt/format.h>

#include <algorithm>

#include "process/fault_codes.h"
#include "sim/torture/invariants/reached_rows.h"

namespace hydro::torture {

void Coverage::Add(const Coverage& other) {
  runs += other.runs;
  injected += other.injected;
  simulated_s += other.simulated_s;
  ticks += other.ticks;
  for (const auto& [code, count] : other.codes) codes[code] += count;
  for (const auto& [kind, count] : other.kinds) kinds[kind] += count;
  rows.insert(other.rows.begin(), other.rows.end());
  pairs.insert(other.pairs.begin(), other.pairs.end());
}

void Coverage::AddPairs(const std::vector<Injection>& injections) {
  constexpr double kTogether_s = 1;
  for (size_t i = 0; i < injections.size(); ++i) {
    for (size_t j = i + 1; j < injections.size(); ++j) {
      const Injection &a = injections[i], &b = injections[j];  // sorted by time
      if (b.at_s > a.at_s + a.duration_s + kTogether_s) continue;
      pairs.insert(std::minmax(a.kind, b.kind));
    }
  }
}

void Coverage::AddRows(const std::vector<Injection>& injections) {
  rows.merge(ReachedRows(injections, codes));
}

std::string Coverage::Report() const {
  std::string codes_missing;
  size_t known = 0;
  for (const process::FaultCode& code : process::FaultCodes()) {
    if (codes.contains(std::string(code.code))) {
      ++known;
    } else {
      codes_missing += fmt::format(" {}", code.code);
    }
  }
  const size_t count = FaultKinds().size();
  const size_t all_pairs = count * (count + 1) / 2;
  std::string pairs_missing;
  for (size_t a = 0; a < count; ++a) {
    for (size_t b = a; b < count && all_pairs - pairs.size() <= 20; ++b) {
      const auto one = static_cast<FaultKind>(a), other = static_cast<FaultKind>(b);
      if (!pairs.contains({one, other})) {
        pairs_missing += fmt::format(" {}+{}", InfoOf(one).name, InfoOf(other).name);
      }
    }
  }
  return fmt::format(
      "fault codes reached: {} of {}; not:{}\nkinds of faults: {} of {}; pairs: {} of {}{}{}\n{}", known,
      process::FaultCodes().size(), codes_missing.empty() ? " none" : codes_missing, kinds.size(), count,
      pairs.size(), all_pairs, pairs_missing.empty() ? "" : "; not:", pairs_missing, RowsReport(rows));
}

}  // namespace hydro::torture
