// Writes the files that hydro-launch new-controller and new-driver make from the examples, as a start for the
// user.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace hydro::launch {

// Throws InputError, which begins with `option`, for a name that Python, CMake or a shell would not take
// unchanged.
void CheckNewName(const std::string& option, const std::string& name);

// Throws std::logic_error when `old` is not in `text`.
std::string Replaced(std::string text, const std::string& old, const std::string& by);

// The path of an installed file under share/hydro/config. Throws InputError when it is not there.
std::string InstalledConfig(const std::string& file);

// The steps that come before those of the files themselves, one to a line and indented, where this
// hydro-launch was built and not installed, or was installed without its development files.
struct FirstSteps {
  std::string python;         // for a program in Python; empty: none
  std::string cpp;            // for one in C++; empty: none
  std::string cmake_options;  // " -Dhydro_DIR=...", for CMake to find hydro; empty: it does
};
FirstSteps StepsToBuildOn();

struct NewFile {
  std::string path;
  std::string text;
  mode_t mode = 0666;
};

// Writes all of the files or none. Unlike other files, these never replace an existing file: somebody may
// have worked on it. Throws InputError.
void WriteNewFiles(const std::vector<NewFile>& files);

}  // namespace hydro::launch
