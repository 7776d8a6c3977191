#include "settings/toml/section_reader.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::settings {
namespace {

using Kind = TomlNode::Kind;

constexpr size_t kLarge = 64;  // keys; fewer are found as fast one by one

}  // namespace

std::optional<int64_t> WholeNumber(const TomlNode& node) {
  constexpr double kExact = 9007199254740992;  // 2^53: above it, doubles cannot hold every whole number
  if (node.is(Kind::kInteger)) return node.integer;
  const bool whole =
      node.is(Kind::kFloat) && std::abs(node.number) <= kExact && std::floor(node.number) == node.number;
  return whole ? std::optional(static_cast<int64_t>(node.number)) : std::nullopt;
}

InputError KeyError(const std::string& place, const std::string& key, const std::string& found,
                    const std::string& allowed) {
  return InputError(place + ": " + key + ": found " + found + ", allowed " + allowed);
}

InputError KeyError(const TomlNode& root, const std::string& dotted_key, const std::string& found,
                    const std::string& allowed) {
  const TomlNode* node = &root;
  for (size_t begin = 0; begin <= dotted_key.size();) {
    const size_t end = std::min(dotted_key.find('.', begin), dotted_key.size());
    const TomlNode* inner = node->Find(dotted_key.substr(begin, end - begin));
    if (inner == nullptr) break;
    node = inner;
    begin = end + 1;
  }
  return KeyError(node->place, dotted_key, found, allowed);
}

bool NumberRange::Holds(double value) const {
  if (std::isinf(value) && value > 0 && infinity_allowed) return true;
  if (!std::isfinite(value)) return false;
  return (min_allowed ? value >= min : value > min) && (max_allowed ? value <= max : value < max) &&
         HoldsSize(value);
}

bool NumberRange::HoldsSize(double value) const {
  const double size = std::fabs(value);
  return size == 0 || (size >= smallest && size <= largest);
}

std::string NumberRange::Allowed() const {
  std::string allowed = "a finite number";
  if (std::isfinite(min)) allowed += (min_allowed ? " of at least " : " above ") + ShortestNumber(min);
  if (std::isfinite(max)) {
    allowed += std::isfinite(min) ? " and" : "";
    allowed += (max_allowed ? " at most " : " below ") + ShortestNumber(max);
  }
  return infinity_allowed ? allowed + ", or inf" : allowed;
}

std::string NumberRange::AllowedInsteadOf(double value) const {
  if (value > max && *beyond_max != '\0') return Allowed() + "; " + beyond_max;
  if (!std::isfinite(value) || HoldsSize(value)) return Allowed();
  const double size = std::fabs(value);
  return Allowed() + ", of a size of " +
         (size < smallest ? "at least " + ShortNumber(smallest) : "at most " + ShortNumber(largest));
}

SectionReader::SectionReader(const TomlNode& table, std::string path, std::vector<AskedKey>* asked)
    : table_(&table), path_(std::move(path)), asked_(asked) {}

bool SectionReader::Number(const std::string& key, double* out, const NumberRange& range) {
  NoteStandard(key, ShortestNumber(*out));
  const TomlNode* node = Take(key);
  if (node == nullptr) return false;
  if (!node->is_number()) throw Error(key, node->Shown(), range.Allowed());
  const double value = node->AsDouble();
  if (!range.Holds(value)) throw Error(key, node->Shown(), range.AllowedInsteadOf(value));
  *out = value;
  return true;
}

bool SectionReader::Number(const std::string& key, std::optional<double>* out, const NumberRange& range) {
  NoteStandard(key, *out ? ShortestNumber(**out) : "none");
  double value = 0;
  if (!Number(key, &value, range)) return false;
  *out = value;
  return true;
}

bool SectionReader::Integer(const std::string& key, int64_t* out, int64_t min, int64_t max) {
  NoteStandard(key, std::to_string(*out));
  const TomlNode* node = Take(key);
  if (node == nullptr) return false;
  const std::optional<int64_t> whole = WholeNumber(*node);
  if (!whole || *whole < min || *whole > max) {
    std::string allowed = "a whole number of at least " + std::to_string(min);
    if (max != std::numeric_limits<int64_t>::max()) allowed += " and at most " + std::to_string(max);
    throw Error(key, node->Shown(), allowed);
  }
  *out = *whole;
  return true;
}

bool SectionReader::Integer(const std::string& key, int* out, int min, int max) {
  int64_t value = *out;
  if (!Integer(key, &value, int64_t{min}, int64_t{max})) return false;
  *out = static_cast<int>(value);
  return true;
}

bool SectionReader::Boolean(const std::string& key, bool* out) {
  NoteStandard(key, *out ? "true" : "false");
  const TomlNode* node = Take(key);
  if (node == nullptr) return false;
  if (!node->is(Kind::kBoolean)) throw Error(key, node->Shown(), "true or false");
  *out = node->boolean;
  return true;
}

bool SectionReader::Text(const std::string& key, std::string* out) {
  NoteStandard(key, TomlString(*out));
  const TomlNode* node = Take(key);
  if (node == nullptr) return false;
  if (!node->is(Kind::kString)) throw Error(key, node->Shown(), "a string");
  if (node->text.find('\0') != std::string::npos) {
    throw Error(key, node->Shown(), "a string without NUL characters");
  }
  *out = node->text;
  return true;
}

SectionReader SectionReader::Section(const std::string& key) {
  const TomlNode* node = Take(key);
  if (node != nullptr) {
    if (!node->is(Kind::kTable)) throw Error(key, node->Shown(), "a section [" + Dotted(key) + "]");
    return SectionReader(*node, Dotted(key), asked_);
  }
  auto absent = std::make_shared<TomlNode>();
  absent->place = table_->place;
  SectionReader reader(*absent, Dotted(key), asked_);
  reader.absent_ = std::move(absent);
  return reader;
}

AskedKey* SectionReader::Asked(const std::string& key) const {
  if (asked_ == nullptr) return nullptr;
  for (AskedKey& asked : *asked_) {
    if (asked.section == path_ && asked.key == key) return &asked;
  }
  return &asked_->emplace_back(AskedKey{path_, key, "", false});
}

void SectionReader::NoteStandard(const std::string& key, const std::string& standard) const {
  AskedKey* asked = Asked(key);
  if (asked != nullptr && asked->standard.empty()) asked->standard = standard;
}

const TomlNode* SectionReader::Take(const std::string& key) {
  Asked(key);
  if (is_known_.insert(key).second) known_.push_back(key);
  return Find(key);
}

const TomlNode* SectionReader::Find(const std::string& key) const {
  if (table_->members.size() < kLarge) return table_->Find(key);
  if (by_key_.empty()) {
    for (const auto& [name, node] : table_->members) by_key_.emplace(name, &node);
  }
  const auto found = by_key_.find(key);
  return found == by_key_.end() ? nullptr : found->second;
}

void SectionReader::Require(const std::string& key, const std::string& allowed) {
  required_.emplace_back(key, allowed);
  if (AskedKey* asked = Asked(key)) asked->required = true;
}

void SectionReader::Finish() const {
  for (const auto& [key, node] : table_->members) {
    if (is_known_.contains(key)) continue;
    const std::string where = path_.empty() ? Quoted(key) : path_ + ": " + Quoted(key);
    throw InputError(node.place + ": " + where + ": found an unknown key, allowed " + QuotedList(known_) +
                     DidYouMean(key, known_));
  }
  for (const auto& [key, allowed] : required_) {
    if (!Has(key)) throw Error(key, "nothing", allowed);
  }
}

InputError SectionReader::Error(const std::string& key, const std::string& found,
                                const std::string& allowed) const {
  const TomlNode* node = Find(key);
  return KeyError(node != nullptr ? node->place : table_->place, Dotted(key), found, allowed);
}

InputError NotAList(const std::string& place, const std::string& name) {
  return InputError(place + ": " + name + ": found a section [" + name +
                    "], allowed a list of sections: write [[" + name + "]]");
}

}  // namespace hydro::settings
