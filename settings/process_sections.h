// The sections [[process]]: which programs a stack consists of, both ours and the user's own.
#pragma once

#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

// Reads a command: the program and its arguments, as a list of texts such as `example`. Returns an empty list
// when there is none. Throws InputError.
std::vector<std::string> ReadCommand(SectionReader& section, const std::string& key,
                                     const std::string& example);

// Reads the sections. Without any, a stack has the three programs of a simulated stack. Throws InputError.
void ReadProcesses(SectionReader& document, std::vector<ProcessSection>* processes);

// The section of the user's own program for that role; null when our program has the role.
const ProcessSection* OwnProgramFor(const StackConfig& config, const std::string& role);

// The name of a program in messages: "hydro-plant", or the words of the user's own command with its role,
// "./pid.py (position_ctrl)".
std::string NameOf(const ProcessSection& process);

// `config` with our own programs in place of the user's, for callers that run a stack without processes.
StackConfig WithoutOwnPrograms(const StackConfig& config);

}  // namespace hydro::settings
