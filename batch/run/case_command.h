// The commands of a case, with its values in the place of placeholders:
//   {case}        the case's number
//   {value:KEY}   the case's value of a varied key
//   {folder}      the folder that the case runs in
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

// Throws InputError for a placeholder that is none.
std::vector<std::string> CaseCommand(const Step& step, const std::vector<std::string>& keys,
                                     const std::vector<Value>& values, const CasePlace& place);

// Where a program is that a study names: as given when it has a slash, else beside this program, else in PATH. Throws InputError.
std::string ProgramPath(const std::string& name);

// Throws InputError when the study's commands have placeholders or programs that are none.
void CheckCommands(const Study& study);

}  // namespace hydro::batch
