// Reads the vectors of numbers in a MAT file.
#pragma once

#include <string>
#include <vector>

namespace hydro::tables {

struct MatVector {
  std::string name;  // "p1"; "data.p1" in a struct
  std::vector<double> values;
  std::string wrong;  // why it is not a vector of numbers: "found ...; ... is needed"
};

struct MatContents {
  std::vector<MatVector> vectors;  // all that the file has, in the file's order
  bool structs = false;            // some of it in structs
};

// Reads a MAT file of version 5 or 7.3. Throws InputError when it cannot be read, is not a MAT file, or is
// cut off.
MatContents ReadMatContents(const std::string& file);

}  // namespace hydro::tables
