#include "tests/settings/configuration_page.h"

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "base/input_error.h"

namespace hydro::settings {
namespace {

// The cells of a table's row, without the blanks around them. "\|" does not end a cell.
std::vector<std::string> Cells(const std::string& row) {
  std::vector<std::string> cells;
  std::string cell;
  for (size_t i = 1; i < row.size(); ++i) {
    if (row[i] != '|' || row[i - 1] == '\\') {
      cell += row[i];
      continue;
    }
    cells.push_back(std::regex_replace(cell, std::regex("^ +| +$"), ""));
    cell.clear();
  }
  return cells;
}

std::string Row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += (cell.empty() ? " " : " " + cell + " ") + "|";
  return row;
}

std::vector<std::string> QuotedWords(const std::string& cell) {
  std::vector<std::string> words;
  const std::regex word("`([^`]+)`");
  for (std::sregex_iterator i(cell.begin(), cell.end(), word), end; i != end; ++i) words.push_back((*i)[1]);
  return words;
}

class Page {
 public:
  Page(const std::string& name, const std::vector<KeyFacts>& facts) : name_(name), facts_(facts) {
    for (const KeyFacts& each : facts) {
      for (const std::string& kind : each.kinds) kinds_[each.section].insert(kind);
    }
  }

  std::string Line(const std::string& line) {
    ++number_;
    std::smatch match;
    if (std::regex_search(line, match, std::regex("^(?:## )?`\\[+([\\w.]+)\\]+`"))) section_ = match[1];
    if (line.starts_with("## ") && match.empty()) section_.clear();
    if (!line.starts_with("|")) {
      columns_.clear();
      return line;
    }
    const std::vector<std::string> cells = Cells(line);
    if (columns_.empty()) {
      columns_ = cells;
      if (IsTable()) CheckHeader();
      return line;
    }
    return !IsTable() || cells[0].starts_with("---") ? line : Row(Current(cells));
  }

  void Finish() const {
    for (const KeyFacts& each : facts_) {
      if (!seen_.contains(Dotted(each)))
        throw InputError(name_ + ": found no row for the key " + Dotted(each) +
                         "; add one to the table of [" + each.section + "]");
    }
    for (const HandWritten& each : HandWrittenDefaults()) {
      const bool known = std::any_of(facts_.begin(), facts_.end(), [&](const KeyFacts& f) {
        return Dotted(f) == each.key && f.standard.empty();
      });
      if (!known)
        throw InputError("HandWrittenDefaults(): found " + each.key + ", which is no key of the code");
    }
  }

 private:
  static std::string Dotted(const KeyFacts& facts) { return facts.section + "." + facts.key; }
  bool IsTable() const { return !section_.empty() && columns_[0] == "key"; }

  size_t Column(const std::string& name) const {
    return std::find(columns_.begin(), columns_.end(), name) - columns_.begin();
  }

  void CheckHeader() const {
    for (const char* needed : {"default", "allowed", "meaning"}) {
      if (Column(needed) == columns_.size())
        Refuse("found a table of keys without a column " + std::string(needed));
    }
  }

  const KeyFacts& Known(const std::string& key) {
    const auto found = std::find_if(facts_.begin(), facts_.end(), [&](const KeyFacts& each) {
      return each.section == section_ && each.key == key;
    });
    if (found == facts_.end())
      Refuse("found " + key + ", which is no key of [" + section_ + "]; take the row out");
    if (!seen_.insert(Dotted(*found)).second) Refuse("found a second row for " + Dotted(*found));
    return *found;
  }

  std::vector<std::string> Current(std::vector<std::string> cells) {
    if (cells.size() != columns_.size())
      Refuse("found " + std::to_string(cells.size()) + " cells, the table has " +
             std::to_string(columns_.size()) + " columns");
    const std::vector<std::string> keys = QuotedWords(cells[0]);
    if (keys.empty()) Refuse("found a row without a key");
    const KeyFacts facts = Known(keys[0]);
    for (size_t i = 1; i < keys.size(); ++i) {
      const KeyFacts& other = Known(keys[i]);
      if (other.standard != facts.standard || other.allowed != facts.allowed || other.kinds != facts.kinds)
        Refuse("found one row for " + facts.key + " and " + other.key + ", which differ; write two");
    }
    cells[Column("allowed")] = facts.allowed;
    std::string& standard = cells[Column("default")];
    if (!facts.standard.empty()) standard = facts.standard;
    if (standard.empty()) Refuse("found no default of " + facts.key + ", which only people can write");
    for (const char* name : {"kind", "source"}) {
      if (Column(name) < columns_.size()) cells[Column(name)] = Kinds(facts);
    }
    return cells;
  }

  std::string Kinds(const KeyFacts& facts) const {
    if (facts.kinds.size() == kinds_.at(section_).size()) return "all";
    std::string text;
    for (const std::string& kind : facts.kinds) text += (text.empty() ? "" : ", ") + kind;
    return text;
  }

  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(number_) + ": " + what);
  }

  std::string name_;
  const std::vector<KeyFacts>& facts_;
  std::map<std::string, std::set<std::string>> kinds_;  // of each section
  std::set<std::string> seen_;                          // keys with a row
  int number_ = 0;
  std::string section_;               // whose tables stand here; empty: none
  std::vector<std::string> columns_;  // of the table that stands here; empty: none
};

}  // namespace

std::string CurrentConfigurationPage(const std::string& page, const std::string& name,
                                     const std::vector<KeyFacts>& facts) {
  Page reader(name, facts);
  std::string result;
  std::istringstream stream(page);
  for (std::string line; std::getline(stream, line);) result += reader.Line(line) + "\n";
  reader.Finish();
  return result;
}

}  // namespace hydro::settings
