#include "batch/study/study.h"

#include <algorithm>

#include "base/number_text.h"
#include "settings/toml/toml_document.h"

namespace hydro::batch {

int64_t Study::cases() const {
  int64_t count = draw_count;
  for (const GridFactor& factor : grid) count *= static_cast<int64_t>(factor.values.size());
  return list.keys.empty() ? count : count * static_cast<int64_t>(list.rows.size());
}

std::vector<std::string> Study::Keys() const {
  std::vector<std::string> keys;
  for (const GridFactor& factor : grid) keys.push_back(factor.key);
  for (const std::string& key : list.keys) keys.push_back(key);
  for (const Draw& draw : draws) keys.push_back(draw.key);
  return keys;
}

// The draws change fastest, then the rows of the list, then the last factor of the grid.
std::vector<Value> Study::Values(int64_t index) const {
  const int64_t draw = same_draws ? index % draw_count : index;
  int64_t rest = index / draw_count;
  std::vector<Value> of_list;
  if (!list.keys.empty()) {
    const auto rows = static_cast<int64_t>(list.rows.size());
    of_list = list.rows[static_cast<size_t>(rest % rows)];
    rest /= rows;
  }
  std::vector<Value> values(grid.size());
  for (size_t i = grid.size(); i-- > 0;) {
    const auto count = static_cast<int64_t>(grid[i].values.size());
    values[i] = grid[i].values[static_cast<size_t>(rest % count)];
    rest /= count;
  }
  values.insert(values.end(), of_list.begin(), of_list.end());
  for (const Draw& each : draws) values.push_back(DrawnValue(each, seed, draw));
  return values;
}

namespace {

using settings::TomlNode;
using Kind = TomlNode::Kind;

std::string Told(const std::string& path, const TomlNode* was, const TomlNode* is) {
  return path + ": was " + (was == nullptr ? "absent" : was->Shown()) + ", is " +
         (is == nullptr ? "absent" : is->Shown());
}

bool SameScalar(const TomlNode& a, const TomlNode& b) {
  if (a.is_number() && b.is_number()) return a.AsDouble() == b.AsDouble();
  return a.kind == b.kind && a.text == b.text && a.boolean == b.boolean;
}

std::string Difference(const std::string& path, const TomlNode& was, const TomlNode& is) {
  if (was.is(Kind::kTable) && is.is(Kind::kTable)) {
    const std::string prefix = path.empty() ? "" : path + ".";
    for (const auto& [key, value] : was.members) {
      const TomlNode* other = is.Find(key);
      std::string difference =
          other == nullptr ? Told(prefix + key, &value, nullptr) : Difference(prefix + key, value, *other);
      if (!difference.empty()) return difference;
    }
    for (const auto& [key, value] : is.members) {
      if (was.Find(key) == nullptr) return Told(prefix + key, nullptr, &value);
    }
    return "";
  }
  if (was.is(Kind::kArray) && is.is(Kind::kArray)) {
    for (size_t i = 0; i < std::max(was.items.size(), is.items.size()); ++i) {
      const std::string place = path + "[" + std::to_string(i) + "]";
      const TomlNode* a = i < was.items.size() ? &was.items[i] : nullptr;
      const TomlNode* b = i < is.items.size() ? &is.items[i] : nullptr;
      std::string difference = a != nullptr && b != nullptr ? Difference(place, *a, *b) : Told(place, a, b);
      if (!difference.empty()) return difference;
    }
    return "";
  }
  return SameScalar(was, is) ? "" : Told(path, &was, &is);
}

TomlNode WithoutReport(const std::string& text, const std::string& name) {
  TomlNode tree = settings::ParseToml(text, name);
  if (name == "study.toml") tree.Erase("report");
  return tree;
}

}  // namespace

std::string StudyDifference(const Study& was, const Study& is) {
  for (const auto& [name, text] : was.files) {
    const auto other = is.files.find(name);
    if (other == is.files.end()) return name + ": was there, is absent";
    if (other->second == text) continue;
    if (!name.ends_with(".toml")) return name + ": is another text";
    const std::string difference =
        Difference("", WithoutReport(text, name), WithoutReport(other->second, name));
    if (!difference.empty()) return name + ": " + difference;
  }
  for (const auto& [name, text] : is.files) {
    if (!was.files.contains(name)) return name + ": was absent, is there";
  }
  return "";
}

}  // namespace hydro::batch
