// Reads one section of a TOML document key by key, so that a key that no one asks for is an error.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text_file.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// "place: key: found ..., allowed ...".
InputError KeyError(const std::string& place, const std::string& key, const std::string& found,
                    const std::string& allowed);

// The same for a dotted key. The place is the key's or, if the key is absent, that of the innermost enclosing
// section.
InputError KeyError(const TomlNode& root, const std::string& dotted_key, const std::string& found,
                    const std::string& allowed);

// The value of a whole number; 1.0 is one too, as programs and spreadsheets write it so. Empty for any other value.
std::optional<int64_t> WholeNumber(const TomlNode& node);

struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_allowed = true;
  bool max_allowed = true;
  bool infinity_allowed = false;  // "inf" for "no limit"
  // The sizes of numbers other than 0. Nearer to 0 a number loses its digits, and what is divided by it overflows.
  double smallest = std::numeric_limits<double>::min();
  double largest = std::numeric_limits<double>::max();
  const char* beyond_max = "";  // why a value above max is refused

  bool Holds(double value) const;
  std::string Allowed() const;  // "a finite number above 0"
  // The same, with the sizes where it is they that the number misses.
  std::string AllowedInsteadOf(double value) const;

 private:
  bool HoldsSize(double value) const;
};

inline constexpr NumberRange kAnyNumber{};
inline constexpr NumberRange kPositive{.min = 0, .min_allowed = false};
inline constexpr NumberRange kNotNegative{.min = 0};

// A key that a reader asked for, for the page that lists them all (tests/settings/configuration_page.h).
struct AskedKey {
  std::string section;  // dotted; empty: the whole document
  std::string key;
  std::string standard;  // what holds without the key, as TOML; "none"; empty: only the reader's caller knows
  bool required = false;
};

class SectionReader {
 public:
  // `path` is the dotted name of the section, empty for the whole document. The node must outlive the reader.
  // `asked`, which must too: where to note the keys that this reader and those of its sections ask for.
  SectionReader(const TomlNode& table, std::string path, std::vector<AskedKey>* asked = nullptr);

  bool Has(const std::string& key) const { return table_->Find(key) != nullptr; }

  // These return whether the key is present, and leave `out` alone if not. They throw InputError.
  bool Number(const std::string& key, double* out, const NumberRange& range = kAnyNumber);
  bool Number(const std::string& key, std::optional<double>* out, const NumberRange& range = kAnyNumber);
  bool Integer(const std::string& key, int64_t* out, int64_t min, int64_t max);
  bool Integer(const std::string& key, int* out, int min, int max);
  bool Boolean(const std::string& key, bool* out);
  bool Text(const std::string& key, std::string* out);
  template <class Value>
  bool Choice(const std::string& key, const std::vector<std::pair<std::string, Value>>& choices, Value* out);

  // The section of that name; an empty one if there is none.
  SectionReader Section(const std::string& key);

  // One of an array of sections: `item` is in this section's, `path` its dotted name.
  SectionReader Item(const TomlNode& item, const std::string& path) const {
    return SectionReader(item, path, asked_);
  }

  // The key's node, for what the functions above do not cover; null if there is none.
  const TomlNode* Take(const std::string& key);

  // Declares that `key` must be present (checked by Finish).
  void Require(const std::string& key, const std::string& allowed);

  // Throws InputError for the first key that was never asked for, else for the first missing required one.
  void Finish() const;

  InputError Error(const std::string& key, const std::string& found, const std::string& allowed) const;

  const std::string& place() const { return table_->place; }
  const std::string& path() const { return path_; }

 private:
  std::string Dotted(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  AskedKey* Asked(const std::string& key) const;
  void NoteStandard(const std::string& key, const std::string& standard) const;

  const TomlNode* table_;
  std::shared_ptr<const TomlNode> absent_;  // stands in for a missing section
  std::string path_;
  std::vector<std::string> known_;
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

}  // namespace hydro::settings
