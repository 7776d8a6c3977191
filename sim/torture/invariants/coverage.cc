#include "sim/torture/invariants/coverage.h"

#include <fmt/format.h>

#include <algorithm>

#include "process/fault_codes.h"
#include "process/safety/safety_table.h"

namespace hydro::torture {
namespace {

bool Hits(const Injection& injection, const NamedFault& named) {
  if (injection.kind != named.kind) return false;
  return !named.target || injection.target < 0 || injection.target == *named.target;
}

bool Injected(const process::SafetyRow& row, const std::vector<Injection>& injections) {
  for (const std::string_view word : process::WordsOf(row.injected)) {
    const std::optional<NamedFault> named = FaultNamed(word);
    if (!named) continue;  // a test reports this
    const auto hits = [&](const Injection& injection) { return Hits(injection, *named); };
    if (std::any_of(injections.begin(), injections.end(), hits)) return true;
  }
  return false;
}

bool Occurred(const process::SafetyRow& row, const std::map<std::string, int64_t>& codes) {
  const std::vector<std::string_view> own = process::WordsOf(row.codes);
  return own.empty() || std::any_of(own.begin(), own.end(),
                                    [&](std::string_view code) { return codes.contains(std::string(code)); });
}

}  // namespace

std::optional<NamedFault> FaultNamed(std::string_view word) {
  const size_t colon = std::min(word.find(':'), word.size());
  const std::string_view name = word.substr(0, colon);
  const auto kinds = FaultKinds();
  const auto info = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == name; });
  if (info == kinds.end()) return std::nullopt;
  if (colon == word.size()) return NamedFault{info->kind, std::nullopt};
  const std::string_view target = word.substr(colon + 1);
  const std::string all = TargetsOf(*info);
  const std::vector<std::string_view> allowed = process::WordsOf(all);
  if (std::find(allowed.begin(), allowed.end(), target) == allowed.end()) return std::nullopt;
  return NamedFault{info->kind, TargetNamed(target)};
}

std::set<std::string> ReachedRows(const std::vector<Injection>& injections,
                                  const std::map<std::string, int64_t>& codes) {
  std::set<std::string> reached;
  for (const process::SafetyRow& row : process::SafetyTable()) {
    if (Occurred(row, codes) && Injected(row, injections)) reached.emplace(row.id);
  }
  return reached;
}

std::string RowsReport(const std::set<std::string>& reached) {
  const std::vector<process::SafetyRow>& table = process::SafetyTable();
  std::string missing;
  for (const process::SafetyRow& row : table) {
    if (reached.contains(std::string(row.id))) continue;
    missing += row.injected.empty()
                   ? fmt::format("  {}: {}\n", row.id, row.not_injected)
                   : fmt::format("  {}: not in these runs; it needs {}\n", row.id, row.injected);
  }
  return fmt::format("rows of docs/safety.md reached: {} of {}{}\n{}", reached.size(), table.size(),
                     missing.empty() ? "" : "; not:", missing);
}

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
