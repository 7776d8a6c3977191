// A folder while its files are being written: it has its name when it is whole, or not at all.
#pragma once

#include <string>

namespace hydro {

class NewFolder {
 public:
  // Makes FOLDER.part (or .part1 ..., where that name is taken) for a folder of this name, with or without a slash at its end. Throws
  // InputError when it cannot be made, and when something of its name is there that is not an empty folder.
  explicit NewFolder(const std::string& folder);
  // Without Finish(): removes what is in it.
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  // Where the files go until Finish().
  const std::string& path() const { return path_; }
  // Gives it its name. Throws WriteError (new_file.h).
  void Finish();

 private:
  std::string name_;
  std::string path_;  // empty after Finish()
};

}  // namespace hydro
