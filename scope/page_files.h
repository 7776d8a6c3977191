// The page's files, from inside the program or, for work on the page, from a folder.
#pragma once

#include <optional>
#include <string>

#include "scope/wire/site.h"

namespace hydro::scope {

class PageFiles {
 public:
  // `folder`: that of the sources, with node_modules/uplot in it; empty: the files in the program. Throws
  // InputError when the folder has no index.html.
  explicit PageFiles(std::string folder);

  // Whether a path is that of a file of the page, there or not: "/" and "/assets/...".
  static bool Has(const std::string& path);

  // The file; 404 when there is none of that name.
  Response Answer(const std::string& path) const;

 private:
  std::optional<std::string> Find(const std::string& name) const;

  std::string folder_;
};

// A file as it lies in the program, made by cmake/EmbedFiles.cmake.
struct EmbeddedFile {
  const char* name;  // "scope.js", "uplot/uPlot.min.css"
  const unsigned char* bytes;
  unsigned long size;
};
extern const EmbeddedFile kPageFiles[];
extern const unsigned long kPageFileCount;

}  // namespace hydro::scope
