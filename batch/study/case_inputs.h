// The configuration, the model and the machine of a case: those of the study, with the case's values.
#pragma once

#include <string>
#include <vector>

#include "batch/study/study.h"
#include "model/terms/description.h"
#include "settings/toml/toml_document.h"

namespace hydro::batch {

class CaseInputs {
 public:
  // The study must outlive this object. Throws InputError where its texts cannot be read.
  explicit CaseInputs(const Study& study);

  // Empty where the study has none. `values` come from Study::Values(). Throws InputError where a key leads
  // to nothing.
  std::string Config(const std::vector<Value>& values) const;
  std::string Model(const std::vector<Value>& values) const;
  // The machine that hydro-sim simulates in place of the model (--machine); empty where no key of the study
  // changes it.
  std::string Machine(const std::vector<Value>& values) const;

 private:
  model::ModelDescription Changed(const std::vector<Value>& values, bool machine) const;

  const Study& study_;
  std::vector<std::string> keys_;
  settings::TomlNode config_;
  model::ModelDescription model_;
  bool config_varies_ = false, model_varies_ = false, machine_varies_ = false;
};

// Checks a study's values before anything runs.

// The place where a study's file names a varied key; `which` is 0 for the first such place. Without one,
// returns the place of its list, or of the whole file.
std::string PlaceOfKey(const settings::TomlNode& root, const std::string& key, size_t which = 0);

// Checks that every value of the grid, of the list's first rows and of the first draws gives a configuration
// that can run. Throws InputError naming the place in `root`, which was read from `file`, the key and its
// value.
void CheckConfigurations(const Study& study, const settings::TomlNode& root, const std::string& file);

}  // namespace hydro::batch
