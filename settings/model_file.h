// Model files: TOML with the paper's parameters and the effects added to its equations.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "base/input_error.h"
#include "model/terms/description.h"

namespace hydro::settings {

// Reads and checks a model file. Throws InputError naming file, line and key.
model::ModelDescription LoadModelFile(const std::string& file);
model::ModelDescription ParseModel(const std::string& text, const std::string& name_for_messages);

// A model file and its whole text. The text includes the effects that the model takes from files of their
// own, so that it is complete.
struct ModelWithText {
  std::string text;
  model::ModelDescription description;
};
ModelWithText LoadModelWithText(const std::string& file);

// The units that a model states, whatever else its text holds. Throws InputError for text that is not TOML
// and for unknown units.
UnitSystem ParseModelUnits(const std::string& text, const std::string& name_for_messages);

// Reads each model file once, however many joints of a limb share it, and however often a program asks.
class ModelFiles {
 public:
  // As ParseModelUnits().
  const UnitSystem& Units(const std::string& file);
  // As LoadModelWithText().
  const ModelWithText& Model(const std::string& file);

 private:
  struct File {
    std::string text;
    std::optional<UnitSystem> units = {};
    std::optional<ModelWithText> model = {};
  };
  File& Read(const std::string& file);

  std::map<std::string, File> files_;
};

// A text that states these units alone; empty for the paper's units, which need not be stated.
std::string UnitsText(const UnitSystem& units);

// The TOML text of a model; ParseModel gives the same description back, bit by bit.
std::string FormatModel(const model::ModelDescription& description);

}  // namespace hydro::settings
