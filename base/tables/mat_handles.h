// Closes and frees what matio opens and reads. For .cc files that use matio.
#pragma once

#include <matio.h>

#include <memory>

namespace hydro::tables {

struct CloseMat {
  void operator()(mat_t* mat) const { Mat_Close(mat); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, CloseMat>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

}  // namespace hydro::tables
