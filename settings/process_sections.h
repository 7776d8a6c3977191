// The sections [[process]]: which programs a stack consists of, ours and the user's own.
#pragma once

#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

// A command, the program and its arguments as a list of texts such as `example`; empty when there is none.
// Throws InputError.
std::vector<std::string> ReadCommand(SectionReader& section, const std::string& key,
                                     const std::string& example);

// Reads them; without any, the three programs of a simulated stack. Throws InputError.
void ReadProcesses(SectionReader& document, std::vector<ProcessSection>* processes);

// The section of a program of the user's own for that role; null when our program has it.
const ProcessSection* OwnProgramFor(const StackConfig& config, const std::string& role);

// What to call a program in a message: "hydro-plant", or the words of the user's own command with its role,
// "./pid.py (position_ctrl)".
std::string NameOf(const ProcessSection& process);

// `config` with our own programs in the place of the user's, for whoever runs a stack without processes.
StackConfig WithoutOwnPrograms(const StackConfig& config);

}  // namespace hydro::settings
