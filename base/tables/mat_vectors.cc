#include "base/tables/mat_vectors.h"

#include <matio.h>

#include <cstdint>

#include "base/input_error.h"
#include "base/mapped_file.h"
#include "base/read_files.h"
#include "base/tables/mat_handles.h"
#include "base/tables/mat_sizes.h"
#include "base/text_file.h"

namespace hydro::tables {
namespace {

constexpr int kDeepest = 16;  // structs within structs

template <class Number>
std::vector<double> ToDoubles(const matvar_t& variable, size_t count) {
  const Number* numbers = static_cast<const Number*>(variable.data);
  return std::vector<double>(numbers, numbers + count);
}

std::string Dimensions(const matvar_t& variable) {
  std::string text;
  for (int k = 0; k < variable.rank; ++k) text += (k > 0 ? "x" : "") + std::to_string(variable.dims[k]);
  return text;
}

using ToNumbers = std::vector<double> (*)(const matvar_t& variable, size_t count);

// The function that reads the elements of a variable of this class; null when they are not numbers.
ToNumbers ReaderOf(matio_classes type) {
  switch (type) {
    case MAT_C_DOUBLE:
      return ToDoubles<double>;
    case MAT_C_SINGLE:
      return ToDoubles<float>;
    case MAT_C_INT8:
      return ToDoubles<int8_t>;
    case MAT_C_UINT8:
      return ToDoubles<uint8_t>;
    case MAT_C_INT16:
      return ToDoubles<int16_t>;
    case MAT_C_UINT16:
      return ToDoubles<uint16_t>;
    case MAT_C_INT32:
      return ToDoubles<int32_t>;
    case MAT_C_UINT32:
      return ToDoubles<uint32_t>;
    case MAT_C_INT64:
      return ToDoubles<int64_t>;
    case MAT_C_UINT64:
      return ToDoubles<uint64_t>;
    default:
      return nullptr;
  }
}

// `mat` is null for a variable that has been read already, with the struct that contains it.
MatVector VectorOf(mat_t* mat, matvar_t* variable, const std::string& name) {
  MatVector vector{name, {}, {}};
  const ToNumbers to_numbers = ReaderOf(variable->class_type);
  if (variable->isComplex != 0) {
    vector.wrong = "found complex numbers; real ones are needed";
  } else if (to_numbers == nullptr) {
    vector.wrong =
        "found text, a structure, a cell array, a sparse matrix or an object of MATLAB's; a vector of "
        "numbers is needed";
  } else if (variable->rank != 2 || (variable->dims[0] != 1 && variable->dims[1] != 1)) {
    vector.wrong = "found " + Dimensions(*variable) + " numbers; a vector is needed";
  } else if (const size_t count = variable->dims[0] * variable->dims[1]; count > 0) {
    if ((mat != nullptr && Mat_VarReadDataAll(mat, variable) != 0) || variable->data == nullptr ||
        variable->nbytes != count * static_cast<size_t>(variable->data_size)) {
      vector.wrong = "found damaged or missing data; " + std::to_string(count) + " numbers are needed";
    } else {
      vector.values = to_numbers(*variable, count);
    }
  }
  return vector;
}

void AppendFields(matvar_t* variable, const std::string& name, int depth, std::vector<MatVector>* vectors) {
  const auto one = [](const matvar_t& of) {
    return of.rank == 2 && of.dims[0] == 1 && of.dims[1] == 1 && of.data != nullptr;
  };
  if (!one(*variable) || depth == kDeepest) {
    const std::string found =
        depth == kDeepest ? "structs in structs, too deep" : Dimensions(*variable) + " structs";
    vectors->push_back({name, {}, "found " + found + "; one struct of vectors is needed"});
    return;
  }
  const unsigned count = Mat_VarGetNumberOfFields(variable);
  char* const* const names = Mat_VarGetStructFieldnames(variable);
  for (unsigned i = 0; i < count; ++i) {
    matvar_t* const field = Mat_VarGetStructFieldByIndex(variable, i, 0);
    const std::string field_name = name + "." + (names != nullptr && names[i] != nullptr ? names[i] : "");
    if (field == nullptr) {
      vectors->push_back({field_name, {}, "found nothing; a vector of numbers is needed"});
    } else if (field->class_type == MAT_C_STRUCT) {
      AppendFields(field, field_name, depth + 1, vectors);
    } else {
      vectors->push_back(VectorOf(nullptr, field, field_name));
    }
  }
}

// Appends the vectors of a variable that matio has described: the variable itself, or the fields of a struct
// in their order.
void AppendVectors(mat_t* mat, matvar_t* variable, std::vector<MatVector>* vectors) {
  const std::string name = variable->name != nullptr ? variable->name : "";
  if (variable->class_type != MAT_C_STRUCT) {
    vectors->push_back(VectorOf(mat, variable, name));
  } else if (Mat_VarReadDataAll(mat, variable) != 0) {
    vectors->push_back({name, {}, "found a damaged struct; one struct of vectors is needed"});
  } else {
    AppendFields(variable, name, 1, vectors);
  }
}

}  // namespace

MatContents ReadMatContents(const std::string& file) {
  Mat_LogInitFunc("hydro", [](int, char*) {});  // our own errors name the place; matio's, on stderr, do not
  { const MappedFile readable(file); }          // throws the system's reason if it is not readable
  CheckIsFile(file);
  RememberRead(file);
  const MatFile mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  if (mat == nullptr || Mat_GetVersion(mat.get()) == MAT_FT_MAT4) {
    throw InputError(file + ": found no MAT file of version 5 or 7.3; these are allowed");
  }
  // When a file is cut off, matio returns unfilled memory for the missing values, and it allocates as much as
  // the dimensions state.
  Mat_GetVersion(mat.get()) == MAT_FT_MAT5 ? CheckMat5Sizes(file) : CheckMat73Sizes(file);
  MatContents found;
  while (const Variable variable{Mat_VarReadNextInfo(mat.get())}) {
    found.structs = found.structs || variable->class_type == MAT_C_STRUCT;
    AppendVectors(mat.get(), variable.get(), &found.vectors);
  }
  return found;
}

}  // namespace hydro::tables
