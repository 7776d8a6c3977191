#include "settings/scope_section.h"

#include <algorithm>
#include <cctype>

#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

// Whether a Host or Origin header may hold `text`. Blanks and commas are not allowed, so that a list in one
// string is noticed.
bool IsPlain(const std::string& text) {
  return !text.empty() && text.size() <= 255 && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isgraph(c) && c < 0x80 && c != ',' && c != '"';
  });
}

void ReadNames(SectionReader& section, const std::string& key, const std::string& allowed, bool origin,
               std::vector<std::string>* names) {
  const TomlNode* const node = section.Take(key);
  if (node == nullptr) return;
  if (!node->is(TomlNode::Kind::kArray)) throw section.Error(key, node->Shown(), allowed);
  for (const TomlNode& item : node->items) {
    const bool has_scheme = item.text.starts_with("http://") || item.text.starts_with("https://");
    if (!item.is(TomlNode::Kind::kString) || !IsPlain(item.text) || has_scheme != origin ||
        item.text.ends_with('/')) {
      throw section.Error(key, item.Shown(), allowed);
    }
    names->push_back(item.text);
  }
}

}  // namespace

ScopeSection ReadScope(SectionReader section) {
  ScopeSection scope;
  section.Integer("port", &scope.port, 0, 65535);
  section.Text("bind", &scope.bind);
  section.Boolean("control", &scope.control);
  section.Number("history_s", &scope.history_s, {.min = 1, .max = 3600});
  section.Number("upload_mb", &scope.upload_mb, {.min = 1, .max = 1e5});
  ReadNames(section, "hosts", "a list of names as in a browser's address line, e.g. [\"rig.lab:8443\"]",
            false, &scope.hosts);
  ReadNames(section, "origins", "a list of origins without a path, e.g. [\"https://rig.lab\"]", true,
            &scope.origins);
  section.Finish();
  return scope;
}

ScopeSection ScopeSectionOf(const std::string& config_text, const std::string& name) {
  const TomlNode root = ParseToml(config_text, name);
  SectionReader document(root, "");
  return ReadScope(document.Section("scope"));
}

}  // namespace hydro::settings
