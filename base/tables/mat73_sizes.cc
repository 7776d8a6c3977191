#include <hdf5.h>
#include <spdlog/fmt/fmt.h>

#include <limits>
#include <vector>

#include "base/input_error.h"
#include "base/mapped_file.h"
#include "base/tables/mat_sizes.h"
#include "base/text_file.h"

namespace hydro::tables {
namespace {

// A handle of HDF5, closed with its object; below 0: none.
class Hdf5Id {
 public:
  Hdf5Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

struct NumbersSoFar {
  size_t numbers = 0;
  size_t most = 0;
  std::string too_large;  // the dataset with which the numbers became too many
};

size_t NumbersOf(hid_t root, const char* name) {
  const Hdf5Id dataset(H5Dopen2(root, name, H5P_DEFAULT), H5Dclose);
  const Hdf5Id space(dataset < 0 ? -1 : H5Dget_space(dataset), H5Sclose);
  const int rank = space < 0 ? 0 : H5Sget_simple_extent_ndims(space);
  if (rank <= 0) return 1;
  std::vector<hsize_t> dimensions(static_cast<size_t>(rank));
  H5Sget_simple_extent_dims(space, dimensions.data(), nullptr);
  size_t product = 1;
  for (const hsize_t dimension : dimensions) {
    if (dimension == 0) return 0;
    if (__builtin_mul_overflow(product, dimension, &product)) return std::numeric_limits<size_t>::max();
  }
  return product;
}

// Counts numbers, and references to the parts of structs and cells, because matio allocates memory for each.
// A result other than 0 ends the visit.
herr_t AddDataset(hid_t root, const char* name, const H5O_info_t* info, void* to) {
  auto* const count = static_cast<NumbersSoFar*>(to);
  if (info->type != H5O_TYPE_DATASET) return 0;
  const size_t more = NumbersOf(root, name);
  if (more > count->most - count->numbers) {
    count->too_large = name;
    return 1;
  }
  count->numbers += more;
  return 0;
}

}  // namespace

void CheckMat73Sizes(const std::string& file) {
  const size_t bytes = MappedFile(file).size();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // this program reports the errors
  const Hdf5Id root(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (root < 0) throw InputError(file + ": found damaged HDF5, allowed is a whole file: save it again");
  NumbersSoFar count;
  count.most = MostNumbers(bytes);
  if (H5Ovisit2(root, H5_INDEX_NAME, H5_ITER_NATIVE, AddDataset, &count, H5O_INFO_BASIC) < 0)
    throw InputError(file + ": found damaged HDF5, allowed is a whole file: save it again");
  if (count.too_large.empty()) return;
  throw InputError(fmt::format(
      "{}: found dimensions of the variable {} with which the file has more than {} numbers, which "
      "is more than a file of {} bytes can be a recording of; save it again",
      file, Quoted(count.too_large), count.most, bytes));
}

}  // namespace hydro::tables
