#include "base/did_you_mean.h"

#include <algorithm>
#include <cctype>

#include "base/text_file.h"

namespace hydro {
namespace {

// Levenshtein distance, ignoring case.
size_t Edits(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                        std::tolower(static_cast<unsigned char>(b[j - 1]));
      const size_t replaced = diagonal + (same ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string Nearest(const std::string& found, const std::vector<std::string>& names) {
  if (found.empty() || found.size() > 64) return "";
  std::string nearest;
  size_t fewest = found.size() <= 3 ? 1 : 1 + found.size() / 4;  // more edits make another word
  for (const std::string& name : names) {
    // A key without its unit, or only its first part ("frequency" for "frequency_hz"), also counts as near.
    const bool beginning =
        found.size() >= 4 && name.size() > found.size() && name.compare(0, found.size(), found) == 0;
    const size_t edits = beginning ? 1 : Edits(found, name);
    if (edits <= fewest && (nearest.empty() || edits < fewest)) {
      fewest = edits;
      nearest = name;
    }
  }
  return nearest;
}

std::string DidYouMean(const std::string& found, const std::vector<std::string>& names) {
  const std::string nearest = Nearest(found, names);
  return nearest.empty() ? "" : ", did you mean " + Quoted(nearest) + "?";
}

}  // namespace hydro
