// The commands of a case, with its values in place of the placeholders:
//   {case}        the case's number
//   {value:KEY}   the case's value of a varied key
//   {folder}      the folder in which the case runs
//   {inputs}      the folder with the study's files
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "batch/study/study.h"

namespace hydro::batch {

struct CasePlace {
  int64_t index = 0;
  std::string folder, inputs;  // absolute paths
};

// Throws InputError for an unknown placeholder.
std::vector<std::string> CaseCommand(const Step& step, const std::vector<std::string>& keys,
                                     const std::vector<Value>& values, const CasePlace& place);

// The path of a program that a study names: as given when the name has a slash, or else beside this program,
// or else in PATH. Throws InputError.
std::string ProgramPath(const std::string& name);

// Throws InputError when the study's commands have unknown placeholders or programs that do not exist.
void CheckCommands(const Study& study);

}  // namespace hydro::batch
