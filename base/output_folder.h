// The folder that takes a program's results.
#pragma once

#include <filesystem>
#include <string>

namespace hydro {

class OutputFolder {
 public:
  // Makes the folder, with those above it. `option`: what it was given as, for the error. Throws InputError
  // when it cannot be made, or cannot be written to.
  OutputFolder(const std::string& folder, const std::string& option);
  // Removes what the constructor made and nothing was written to, so that a program that failed leaves no
  // folder.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::filesystem::path folder_;
  std::filesystem::path first_made_;  // of this folder and those above it; empty if none was
};

}  // namespace hydro
