#include "settings/read_quantities.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/number_text.h"
#include "base/text_file.h"
#include "base/unit_system.h"
#include "base/units.h"
#include "settings/quantity_keys.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

// The sections whose texts are read as quantities.
constexpr std::string_view kQuantitySections[] = {"model",    "model.motion", "time",      "plant",
                                                  "pressure", "position",     "reference", "limits",
                                                  "noise",    "limb",         "arm",       "arm.link"};

// The part of a text that is its number.
std::string_view NumberPart(std::string_view text) {
  size_t length = 0;
  const auto is = [&](std::string_view characters) {
    return length < text.size() && characters.find(text[length]) != std::string_view::npos;
  };
  const auto digits = [&] {
    while (is("0123456789.")) ++length;
  };
  if (is("+-")) ++length;
  digits();
  // "2e3 Pa" has an exponent. An "e" that begins a unit, as it might after "2 ", is not an exponent.
  if (length > 0 && is("eE")) {
    const size_t mantissa = length++;
    if (is("+-")) ++length;
    const size_t before = length;
    digits();
    if (length == before) length = mantissa;
  }
  return text.substr(0, length);
}

// The probable meaning of a text of a number and a unit that cannot be read.
std::string MeaningOf(std::string_view number, std::string_view unit, const std::string& wanted) {
  if (unit.size() > 1 && unit[0] == ',' && unit[1] >= '0' && unit[1] <= '9')
    return "; decimals begin with a point, and thousands with nothing";
  const std::string meant = UnitMeant(unit, wanted);
  return meant.empty() ? "" : "; did you mean " + Quoted(std::string(number) + " " + meant) + "?";
}

bool BeginsWithNumber(const std::string& text) { return ParseNumber(NumberPart(text)).has_value(); }

// The units from which a person may choose: "Pa, kPa, MPa, bar, psi".
std::string UnitsLike(const std::string& unit) {
  std::string names = unit;
  const auto si = FindSiUnit(unit, 1e12);
  const auto powers = UnitPowers(unit);
  if (si && powers && powers->size() > 1) names += ", " + si->to;
  const std::optional<hydro::Unit> own = ParseUnit(unit);
  for (const std::string_view name : UnitNames()) {
    if (name != unit && name != "lb" && own && ParseUnit(name)->powers == own->powers)
      names += ", " + std::string(name);
  }
  return names;
}

// Calls `change(section, table)` for each section that exists; [[arm.link]] is a list of sections.
template <class Change>
void ForEachSection(TomlNode* root, const Change& change) {
  using Kind = TomlNode::Kind;
  for (const std::string_view name : kQuantitySections) {
    const std::string section(name);
    TomlNode* node = root;
    for (size_t begin = 0; begin < section.size() && node != nullptr;) {
      const size_t end = std::min(section.find('.', begin), section.size());
      node = node->is(Kind::kTable) ? node->Find(section.substr(begin, end - begin)) : nullptr;
      begin = end + 1;
    }
    if (node == nullptr) continue;
    if (node->is(Kind::kTable)) change(section, node);
    if (!node->is(Kind::kArray)) continue;
    for (TomlNode& item : node->items) {
      if (item.is(Kind::kTable)) change(section, &item);
    }
  }
}

void Rename(const QuantityKey& quantity, TomlNode* table) {
  const std::string old(quantity.old), present(quantity.key);
  const auto found = std::find_if(table->members.begin(), table->members.end(),
                                  [&](const TomlMember& member) { return member.first == old; });
  if (found == table->members.end()) return;
  if (table->Find(present) != nullptr) {
    throw KeyError(found->second.place, std::string(quantity.section) + "." + old,
                   "it beside " + present + ", its present name", "one of the two");
  }
  found->first = present;
  found->second.former = old;
}

// A value under a former name is in the paper's unit.
void CheckFormerName(const std::string& section, const std::string& key, const TomlNode& node,
                     const UnitSystem& units) {
  const QuantityKey& quantity = *FindQuantity(section + "." + key);
  const std::string unit = quantity.UnitIn(units), dotted = section + "." + node.former;
  if (node.is(TomlNode::Kind::kString) && BeginsWithNumber(node.text)) {
    throw KeyError(node.place, dotted, Quoted(node.text), "the line " + key + " = " + Quoted(node.text));
  }
  if (unit == quantity.unit) return;
  const std::string shown = node.Shown();
  throw KeyError(node.place, dotted, "a key in " + std::string(quantity.unit) + ", and a model in " + unit,
                 "the line " + key + " = " + shown + " if that is in " + unit + ", or " + key + " = \"" +
                     shown + " " + std::string(quantity.unit) + "\"");
}

// Also converts lists, whose pairs begin with a time.
void Convert(const std::string& dotted, const std::string& unit, TomlNode* node) {
  if (node->is(TomlNode::Kind::kArray)) {
    for (size_t i = 0; i < node->items.size(); ++i) {
      const bool pair = node->items[i].is(TomlNode::Kind::kArray) && node->items[i].items.size() == 2;
      if (!pair) continue;
      const std::string name = dotted + "[" + std::to_string(i) + "]";
      Convert(name, "s", &node->items[i].items[0]);
      Convert(name, unit, &node->items[i].items[1]);
    }
  }
  // The key's own reader handles a word: "every_tick", or a mistake, for which it reports what is allowed.
  if (!node->is(TomlNode::Kind::kString) || !BeginsWithNumber(node->text)) return;
  TomlNode number = NumberNode(NumberOf(node->text, unit, node->place, dotted));
  number.place = node->place;
  number.from_option = node->from_option;
  *node = std::move(number);
}

// What reference.signal says of the reference's values.
std::string SignalOf(TomlNode* root) {
  const TomlNode* reference = root->Find("reference");
  const TomlNode* signal =
      reference == nullptr || !reference->is(TomlNode::Kind::kTable) ? nullptr : reference->Find("signal");
  return signal == nullptr ? "arm_angle" : signal->text;
}

bool HoldsNumber(const TomlNode& node) {
  if (node.from_option) return false;
  if (node.is(TomlNode::Kind::kArray)) return std::any_of(node.items.begin(), node.items.end(), HoldsNumber);
  return node.is(TomlNode::Kind::kInteger) || node.is(TomlNode::Kind::kFloat);
}

}  // namespace

void UsePresentNames(TomlNode* root) {
  ForEachSection(root, [](const std::string& section, TomlNode* table) {
    for (const QuantityKey& one : QuantityKeys()) {
      if (one.section == section && !one.old.empty()) Rename(one, table);
    }
  });
  TomlNode* joints = root->Find("joint");
  if (joints == nullptr || !joints->is(TomlNode::Kind::kArray)) return;
  for (TomlNode& joint : joints->items) UsePresentNames(&joint);
}

std::vector<std::string> FormerNamesIn(const TomlNode& document,
                                       const std::vector<std::pair<std::string, std::string>>& written) {
  std::vector<std::string> names;
  for (const auto& [key, value] : written) {
    const QuantityKey* quantity = FindQuantity(key);
    if (quantity == nullptr || quantity->old.empty()) continue;
    const TomlNode* section = document.Find(std::string(quantity->section));
    if (section == nullptr || section->Find(std::string(quantity->old)) == nullptr) continue;
    names.push_back(std::string(quantity->section) + "." + std::string(quantity->old));
  }
  return names;
}

double NumberOf(const std::string& text, const std::string& unit, const std::string& place,
                const std::string& key) {
  const std::string_view digits = NumberPart(text);
  const std::optional<double> number = ParseNumber(digits);
  std::string_view given = std::string_view(text).substr(digits.size());
  given.remove_prefix(std::min(given.find_first_not_of(' '), given.size()));
  const std::optional<hydro::Unit> own = ParseUnit(given);
  const std::optional<hydro::Unit> wanted = ParseUnit(unit);
  const bool fits = number && own && wanted && own->powers == wanted->powers;
  const double factor = !fits || own->size == wanted->size ? 1 : own->size / wanted->size;
  // A value that overflows would read as "no limit".
  if (!fits || !std::isfinite(factor * *number)) {
    throw KeyError(place, key, Quoted(text),
                   "a number (in " + unit + "), or a text of a number and a unit: " + UnitsLike(unit) +
                       (fits ? "" : MeaningOf(digits, given, unit)));
  }
  return factor * *number;
}

std::string FirstNumberThatChanges(TomlNode root, const UnitSystem& was, const UnitSystem& is) {
  UsePresentNames(&root);
  const std::string of = SignalOf(&root);
  std::string first;
  ForEachSection(&root, [&](const std::string& section, TomlNode* table) {
    for (const auto& [key, node] : table->members) {
      const std::string dotted = section + "." + key;
      if (!first.empty() || UnitOfKey(dotted, was, of) == UnitOfKey(dotted, is, of) || !HoldsNumber(node))
        continue;
      first = dotted + (node.is(TomlNode::Kind::kArray) ? "" : " = " + node.Shown());
    }
  });
  return first;
}

void ReadQuantities(TomlNode* root, const UnitSystem& units, FormerNames former) {
  UsePresentNames(root);
  const std::string of = SignalOf(root);
  ForEachSection(root, [&](const std::string& section, TomlNode* table) {
    for (auto& [key, node] : table->members) {
      if (!node.former.empty() && former == FormerNames::kMustBeTrue) {
        CheckFormerName(section, key, node, units);
      }
      node.former.clear();
      const std::string dotted = section + "." + key, unit = UnitOfKey(dotted, units, of);
      if (!unit.empty()) Convert(dotted, unit, &node);
    }
  });
}

}  // namespace hydro::settings
