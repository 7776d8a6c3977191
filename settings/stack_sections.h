// Reads each section of the configuration and checks keys, types and ranges. Checks across several keys are
// in stack_checks.h.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

// Whether a configuration may have that key, "section.key". Of [reference], the keys of kind = "csv" count;
// of sections whose keys depend on others, any.
bool KnowsKey(const std::string& dotted_key);

// Throws InputError for a key that stands outside any section, and names the sections that have such a key.
void CheckKeysHaveSections(const TomlNode& root);

// Reads the section [reference]. Throws InputError.
void ReadReference(SectionReader section, const std::string& config_file, ReferenceSection* reference);

// Fills every section of `config` from the document, except the model's description, and notes in `asked`
// (unless it is null) the keys that the document may have. Throws InputError.
void ReadSections(const TomlNode& root, const std::string& config_file, StackConfig* config,
                  std::vector<AskedKey>* asked = nullptr);

}  // namespace hydro::settings
