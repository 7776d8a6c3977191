// What a job of an array runs.
#pragma once

#include <string>

namespace hydro::batch {

struct ScriptRequest {
  std::string program;  // hydro-batch, absolute
  std::string study;    // the study's folder, absolute
  std::string array;    // the array's (array_folder.h), absolute
};

// A script for sh: runs the cases of the job's line in `cases` on as many processors as Slurm gives the job. The paths may hold any
// character.
std::string ArrayScript(const ScriptRequest& request);

// `text` as one word for sh.
std::string ShellWord(const std::string& text);

// A name for sbatch: letters, digits and "._-" of `text`, not too long.
std::string PlainName(const std::string& text);

}  // namespace hydro::batch
