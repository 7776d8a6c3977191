// A folder while its files are being written: it gets its name when it is whole, or not at all.
#pragma once

#include <string>

namespace hydro {

class NewFolder {
 public:
  // Makes FOLDER.part (or .part1 ..., if that name is taken) for a folder of this name, with or without a
  // slash at its end. Throws InputError when it cannot be made, and when the name leads to something other
  // than an empty folder.
  explicit NewFolder(const std::string& folder);
  // Unless Finish() was called, removes the folder and its contents.
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  // The folder that takes the files until Finish().
  const std::string& path() const { return path_; }
  // Gives the folder its name. Throws WriteError (new_file.h).
  void Finish();

 private:
  std::string name_;
  std::string path_;  // empty after Finish()
};

}  // namespace hydro
