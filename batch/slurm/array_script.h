// The script that a job of an array runs.
#pragma once

#include <string>

namespace hydro::batch {

struct ScriptRequest {
  std::string program;  // absolute path of hydro-batch
  std::string study;    // absolute path of the study's folder
  std::string array;    // absolute path of the array's folder (array_folder.h)
};

// A script for sh that runs the cases in the job's line of `cases`, on as many processors as Slurm gives the
// job. The paths may hold any character.
std::string ArrayScript(const ScriptRequest& request);

// Quotes `text` as one word for sh.
std::string ShellWord(const std::string& text);

// A name for sbatch: letters, digits and "._-" of `text`, with a limited length.
std::string PlainName(const std::string& text);

}  // namespace hydro::batch
