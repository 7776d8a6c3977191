#include "process/agreement.h"

#include <sstream>

#include "base/utf8.h"

namespace hydro::process {
namespace {

constexpr size_t kMostRefused = 4096;  // more would come from a flood of made-up senders
constexpr size_t kMostHeard = 256;
constexpr size_t kMostKeys = 6;  // that one line can name
constexpr size_t kLongestValue = 60;

std::map<std::string, std::string> Entries(const std::string& text) {
  std::map<std::string, std::string> entries;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const size_t equals = line.find(" = ");
    if (equals != std::string::npos) entries[line.substr(0, equals)] = line.substr(equals + 3);
  }
  return entries;
}

std::string Value(const std::map<std::string, std::string>& entries, const std::string& key) {
  const auto found = entries.find(key);
  if (found == entries.end()) return "not given";
  if (found->second.size() <= kLongestValue) return found->second;
  return std::string(FirstBytes(found->second, kLongestValue)) + "...";
}

}  // namespace

std::string DescribeDifferences(const std::string& here, const std::string& there) {
  if (here == there) return "";
  const auto ours = Entries(here), theirs = Entries(there);
  std::set<std::string> keys;
  for (const auto& [key, value] : ours) keys.insert(key);
  for (const auto& [key, value] : theirs) keys.insert(key);
  std::string text;
  size_t named = 0, more = 0;
  for (const std::string& key : keys) {
    const auto our = ours.find(key), their = theirs.find(key);
    if (our != ours.end() && their != theirs.end() && our->second == their->second) continue;
    if (++named > kMostKeys) {
      ++more;
      continue;
    }
    text += (text.empty() ? "" : "; ") + key + " is " + Value(theirs, key) + " there, " + Value(ours, key) +
            " here";
  }
  if (more > 0) text += "; and " + std::to_string(more) + " more";
  return text.empty() ? "the order of their entries" : text;
}

bool Agreement::Observe(const configuration_t& announced) {
  if (own_.empty() || announced.text.empty()) return false;
  if (agreed_.contains(announced.session)) return false;
  // In a flood: senders that are still there announce themselves again.
  if (heard_.size() >= kMostHeard) heard_.clear();
  heard_.insert(announced.session);
  const std::string differences = DescribeDifferences(own_, announced.text);
  if (differences.empty()) {
    if (agreed_.size() >= kMostHeard) agreed_.clear();
    agreed_.insert(announced.session);
    Forget(announced.session);
    return false;
  }
  if (refused_.size() >= kMostRefused && !refused_.contains(announced.session)) {
    // The senders that were refused first have most likely gone; one that has not is refused again at its
    // next announcement.
    refused_.erase(order_.front());
    order_.pop_front();
  }
  if (!refused_.contains(announced.session)) order_.push_back(announced.session);
  return refused_.insert_or_assign(announced.session, differences).second;
}

void Agreement::Forget(int64_t session) {
  if (refused_.erase(session) > 0) std::erase(order_, session);
}

std::string Agreement::Differences(int64_t session) const {
  const auto found = refused_.find(session);
  return found == refused_.end() ? "" : found->second;
}

}  // namespace hydro::process
