// Reads one section of a TOML document key by key, so that a key for which nothing asks is an error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/text_file.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// "place: key: found ..., allowed ...".
InputError KeyError(const std::string& place, const std::string& key, const std::string& found,
                    const std::string& allowed);

// The same for a dotted key. The place is that of the key or, if the key is absent, that of the innermost
// enclosing section.
InputError KeyError(const TomlNode& root, const std::string& dotted_key, const std::string& found,
                    const std::string& allowed);

// The value of a whole number. 1.0 counts as one, because programs and spreadsheets write whole numbers that
// way. Empty for any other value.
std::optional<int64_t> WholeNumber(const TomlNode& node);

struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_allowed = true;
  bool max_allowed = true;
  bool infinity_allowed = false;  // "inf" for "no limit"
  // The allowed sizes of numbers other than 0. Closer to 0, a number loses its digits, and quotients by it
  // overflow.
  double smallest = std::numeric_limits<double>::min();
  double largest = std::numeric_limits<double>::max();
  const char* beyond_max = "";  // the reason why a value above max is refused

  bool Holds(double value) const;
  std::string Allowed() const;  // "a finite number above 0"
  // The same, with the allowed sizes if the size is what is wrong with the number.
  std::string AllowedInsteadOf(double value) const;

 private:
  bool HoldsSize(double value) const;
};

inline constexpr NumberRange kAnyNumber{};
inline constexpr NumberRange kPositive{.min = 0, .min_allowed = false};
inline constexpr NumberRange kNotNegative{.min = 0};

// A key for which a reader asked. The page that lists all keys uses it (tests/settings/configuration_page.h).
struct AskedKey {
  std::string section;  // dotted; empty: the whole document
  std::string key;
  std::string standard;  // what holds without the key, as TOML; "none"; empty: only the reader's caller knows
  bool required = false;
};

class SectionReader {
 public:
  // `path` is the dotted name of the section, empty for the whole document. `asked` receives the keys for
  // which this reader and those of its sections ask. Both the node and `asked` must outlive the reader.
  SectionReader(const TomlNode& table, std::string path, std::vector<AskedKey>* asked = nullptr);

  bool Has(const std::string& key) const { return Find(key) != nullptr; }

  // These return whether the key is present, and leave `out` unchanged if it is not. They throw InputError.
  bool Number(const std::string& key, double* out, const NumberRange& range = kAnyNumber);
  bool Number(const std::string& key, std::optional<double>* out, const NumberRange& range = kAnyNumber);
  bool Integer(const std::string& key, int64_t* out, int64_t min, int64_t max);
  bool Integer(const std::string& key, int* out, int min, int max);
  bool Boolean(const std::string& key, bool* out);
  bool Text(const std::string& key, std::string* out);
  template <class Value>
  bool Choice(const std::string& key, const std::vector<std::pair<std::string, Value>>& choices, Value* out);

  // The section of that name; an empty section if there is none.
  SectionReader Section(const std::string& key);

  // One section of an array of sections: `item` is in this reader's section, and `path` is its dotted name.
  SectionReader Item(const TomlNode& item, const std::string& path) const {
    return SectionReader(item, path, asked_);
  }

  // The key's node, for values that the functions above do not cover; null if there is none.
  const TomlNode* Take(const std::string& key);

  // Declares that `key` must be present; Finish() checks it.
  void Require(const std::string& key, const std::string& allowed);

  // Throws InputError for the first key for which nothing asked, or else for the first missing required key.
  void Finish() const;

  InputError Error(const std::string& key, const std::string& found, const std::string& allowed) const;

  const std::string& place() const { return table_->place; }
  const std::string& path() const { return path_; }

 private:
  std::string Dotted(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  AskedKey* Asked(const std::string& key) const;
  void NoteStandard(const std::string& key, const std::string& standard) const;

  // The key's node, as table_->Find() gives it. A file may have many keys, and then the reader may ask for
  // each of them, so they are not searched one by one.
  const TomlNode* Find(const std::string& key) const;

  const TomlNode* table_;
  mutable std::unordered_map<std::string_view, const TomlNode*> by_key_;  // of a large table, once asked for
  std::shared_ptr<const TomlNode> absent_;                                // stands in for a missing section
  std::string path_;
  std::vector<std::string> known_;  // in the order in which they were asked for
  std::unordered_set<std::string> is_known_;
  std::vector<std::pair<std::string, std::string>> required_;  // key, allowed
  std::vector<AskedKey>* asked_;                               // may be null
};

template <class Value>
bool SectionReader::Choice(const std::string& key, const std::vector<std::pair<std::string, Value>>& choices,
                           Value* out) {
  for (const auto& [name, value] : choices) {
    if (value == *out) NoteStandard(key, TomlString(name));
  }
  const TomlNode* node = Take(key);
  if (node == nullptr) return false;
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) {
    if (node->is(TomlNode::Kind::kString) && node->text == name) {
      *out = value;
      return true;
    }
    names.push_back(name);
  }
  throw Error(key, node->Shown(), QuotedList(names));
}

// The error for the section `name` of a list of sections that is written as [name].
InputError NotAList(const std::string& place, const std::string& name);

}  // namespace hydro::settings
