// The table of docs/effects.md, from the catalogue: `effects_table` fails when the document differs,
// `effects_table --write` updates it.
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "model/terms/parameter_info.h"

namespace hydro {
namespace {

constexpr const char* kBegin = "<!-- effects_table --write writes this -->\n";
constexpr const char* kEnd = "<!-- effects_table ends -->\n";

std::string Number(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string Cell(const model::ParameterInfo& parameter) {
  std::string cell = "`" + parameter.name + "` (" + parameter.unit;
  if (!parameter.is_name()) cell += ", " + Number(parameter.example);
  if (parameter.optional) cell += "; standard " + parameter.standard.text();
  return cell + ")";
}

std::string Table() {
  std::string table =
      "| id | what it is | equation | parameters (unit, example) | confused with |\n|---|---|---|---|---|\n";
  for (const model::EffectInfo& effect : model::EffectCatalogue()) {
    table += "| `" + effect.id + "` | " + effect.summary + " | " + effect.equation + " | ";
    for (size_t i = 0; i < effect.parameters.size(); ++i)
      table += (i > 0 ? ", " : "") + Cell(effect.parameters[i]);
    table += " | " + effect.confused_with + " |\n";
  }
  return table;
}

// The document with the table between its two marks; "" without marks.
std::string WithTable(const std::string& document) {
  const size_t begin = document.find(kBegin), end = document.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return "";
  return document.substr(0, begin) + kBegin + Table() + document.substr(end);
}

int Run(const std::string& program, const std::string& option) {
  std::ifstream file(HYDRO_EFFECTS_DOCUMENT);
  std::stringstream document;
  document << file.rdbuf();
  const std::string current = WithTable(document.str());
  if (current.empty()) {
    std::cerr << HYDRO_EFFECTS_DOCUMENT << ": found no marks of the table, needs the lines\n"
              << kBegin << kEnd;
    return 1;
  }
  if (option == "--write") {
    std::ofstream(HYDRO_EFFECTS_DOCUMENT) << current;
    return 0;
  }
  if (current == document.str()) return 0;
  std::cerr << HYDRO_EFFECTS_DOCUMENT << ": the table is not that of the catalogue. Write it with\n  "
            << program << " --write\n";
  return 1;
}

}  // namespace
}  // namespace hydro

int main(int argc, char** argv) { return hydro::Run(argv[0], argc > 1 ? argv[1] : ""); }
