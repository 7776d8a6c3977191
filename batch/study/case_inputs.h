// The configuration and the model of a case: the study's, with the case's values.
#pragma once

#include <string>
#include <vector>

#include "batch/study/study.h"
#include "model/terms/description.h"

namespace hydro::batch {

class CaseInputs {
 public:
  // The study must outlive it. Throws InputError where its texts cannot be read.
  explicit CaseInputs(const Study& study);

  // Empty where the study has none. `values`: of Study::Values(). Throws InputError where a key leads to nothing.
  std::string Config(const std::vector<Value>& values) const;
  std::string Model(const std::vector<Value>& values) const;

 private:
  const Study& study_;
  std::vector<std::string> keys_;
  settings::TomlNode config_;
  model::ModelDescription model_;
  bool config_varies_ = false, model_varies_ = false;
};

}  // namespace hydro::batch
