// The vectors of numbers in a variable of a MAT file.
#pragma once

#include <matio.h>

#include <string>
#include <vector>

namespace hydro::tables {

struct MatVector {
  std::string name;  // "p1"; "data.p1" in a struct
  std::vector<double> values;
  std::string wrong;  // why it is no vector of numbers: "found ...; ... is needed"
};

// Reads a variable of which matio has told what it is, and appends what is in it: itself, or in a struct its fields, in their order.
void AppendVectors(mat_t* mat, matvar_t* variable, std::vector<MatVector>* vectors);

}  // namespace hydro::tables
