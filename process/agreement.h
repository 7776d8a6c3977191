// Checks whether the processes of a stack run with the same configuration, model and version.
#pragma once

#include <cstdint>
#include <deque>
#include <hydro/configuration_t.hpp>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace hydro::process {

// Pure: the caller passes in what others announce (HYDRO_CONFIGURATION).
class Agreement {
 public:
  // `own` holds sorted lines "key = value" (settings/config_entries.h). With an empty text, this process
  // agrees with every other.
  explicit Agreement(std::string own) : own_(std::move(own)) {}

  // Returns true when the sender does not agree and this was not known. A sender that has once agreed does so
  // as long as it lives: a message that says otherwise was changed on its way, or made up.
  bool Observe(const configuration_t& announced);

  // Whether messages of that sender must not be obeyed. A sender that has announced nothing is not refused:
  // it may be a program of the user's own.
  bool Refuses(int64_t session) const { return !refused_.empty() && refused_.contains(session); }

  // The differences of that sender: "pressure.k_p is 3 there, 0.3 here; ...". Empty when it is not refused.
  std::string Differences(int64_t session) const;

  bool any() const { return !refused_.empty(); }
  // Whether that sender has announced its configuration.
  bool Heard(int64_t session) const { return heard_.contains(session); }

  void Forget(int64_t session);

  const std::string& own() const { return own_; }

 private:
  std::string own_;
  std::set<int64_t> heard_;
  std::set<int64_t> agreed_;
  std::map<int64_t, std::string> refused_;  // differences, by session
  std::deque<int64_t> order_;               // the order in which they were first refused
};

// The keys in which two such texts differ, with both values; empty when they are equal.
std::string DescribeDifferences(const std::string& here, const std::string& there);

}  // namespace hydro::process
