#include "batch/study/study_difference.h"

#include <algorithm>

#include "base/number_text.h"
#include "settings/toml/toml_document.h"

namespace hydro::batch {
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
