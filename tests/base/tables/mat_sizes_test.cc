// Files that speak of more than they hold.
#include "base/tables/mat_sizes.h"

#include <gmock/gmock.h>
#include <hdf5.h>
#include <libdeflate.h>
#include <matio.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/tables/table.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::tables {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// The bytes of a MAT 5 file, in either byte order.
class Mat5 {
 public:
  explicit Mat5(bool swapped = false) : swapped_(swapped) {}

  std::string Word(uint32_t word) const {
    std::string bytes(4, '\0');
    for (size_t i = 0; i < 4; ++i) bytes[swapped_ ? 3 - i : i] = static_cast<char>(word >> (8 * i));
    return bytes;
  }
  std::string Element(uint32_t type, const std::string& data) const {
    return Word(type) + Word(static_cast<uint32_t>(data.size())) + data +
           std::string((8 - data.size() % 8) % 8, '\0');
  }
  // Flags, dimensions and a name; then what is in it.
  std::string Array(uint32_t kind, const std::vector<uint32_t>& dimensions, const std::string& name,
                    const std::string& content, uint32_t flags = 0) const {
    std::string sizes;
    for (const uint32_t one : dimensions) sizes += Word(one);
    return Element(14,
                   Element(6, Word(kind | flags) + Word(0)) + Element(5, sizes) + Element(1, name) + content);
  }
  std::string Doubles(const std::vector<double>& numbers) const {
    std::string bytes;
    for (const double number : numbers) {
      std::string one(reinterpret_cast<const char*>(&number), sizeof number);
      if (swapped_) std::reverse(one.begin(), one.end());
      bytes += one;
    }
    return Element(9, bytes);
  }
  // A struct with one field, "f".
  std::string Struct(const std::vector<uint32_t>& dimensions, const std::string& name,
                     const std::string& content) const {
    return Array(2, dimensions, name,
                 Word(4 << 16 | 5) + Word(8) + Element(1, std::string("f\0\0\0\0\0\0\0", 8)) + content);
  }
  std::string File(const std::string& elements) const {
    std::string header = "MATLAB 5.0 MAT-file";
    header.resize(124, ' ');
    header += swapped_ ? std::string("\x01\0MI", 4) : std::string("\0\x01IM", 4);
    return header + elements;
  }

 private:
  bool swapped_;
};

std::string Compressed(const std::string& bytes) {
  libdeflate_compressor* const compressor = libdeflate_alloc_compressor(6);
  std::string out(libdeflate_zlib_compress_bound(compressor, bytes.size()), '\0');
  out.resize(libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), out.data(), out.size()));
  libdeflate_free_compressor(compressor);
  const auto size = static_cast<uint32_t>(out.size());
  return Mat5().Word(15) + Mat5().Word(size) + out;
}

int64_t LargestMemory_kB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

class MatSizesTest : public log::LogTest {
 protected:
  std::string ErrorOf(const std::string& bytes) {
    ForgetRead(Path("x.mat"));
    log::WriteBytes(Path("x.mat"), bytes);
    try {
      ReadTable(Path("x.mat"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

// Tests that a file that claims gigabytes in a few bytes is refused, with its name, before anything of that
// size is allocated.
TEST_F(MatSizesTest, ClaimsAreHeldAgainstTheFile) {
  const Mat5 mat;
  const std::string one = mat.Doubles({1});
  const std::string empty = mat.Element(14, "");
  std::string nested = one;
  for (int i = 0; i < 100; ++i)
    nested = mat.Array(1, {1, 1}, "", i == 0 ? mat.Array(6, {1, 1}, "", one) : nested);
  const struct {
    std::string elements;
    const char* says;
  } cases[] = {
      {mat.Array(6, {1, 1000000000}, "a", one),
       "the variable \"a\" that has 1000000000 numbers by its dimensions"},
      {mat.Array(9, {1000000000, 1}, "a", mat.Element(2, "x")),
       "1000000000 numbers by its dimensions and 1 bytes"},
      {mat.Array(6, {2147483647, 2147483647, 2147483647}, "a", one), "numbers by its dimensions"},
      {mat.Array(6, {4294967295u, 1}, "a", one), "has -1 as a dimension"},
      {mat.Array(6, {1}, "a", one), "has 1 dimensions"},
      {mat.Array(6, {1, 2}, "a", mat.Doubles({1, 2}), 0x800), "ends within an element"},
      {mat.Array(4, {1, 1000000}, "a", mat.Element(16, "abc")),
       "1000000 numbers by its dimensions and 3 bytes"},
      {mat.Array(1, {1000000000, 1}, "a", empty), "1000000000 arrays by its dimensions"},
      {mat.Struct({1, 1000000000}, "a", mat.Array(6, {1, 1}, "", one)),
       "1000000000 structs by its dimensions"},
      {mat.Struct({1, 1}, "a", mat.Array(6, {1, 1000000000}, "", one)),
       "the variable \"a\" that has 1000000000 numbers"},
      {mat.Struct({1, 1}, "a", mat.Array(1, {1, 1000000000}, "", empty)), "1000000000 arrays"},
      {mat.Array(1, {1, 1}, "a", nested), "is nested more than 32 deep"},
      {mat.Array(6, {1, 1}, "a", mat.Word(9) + mat.Word(4000000000u)),
       "has an element of 4000000000 bytes where 0 are left"},
      {mat.Word(14) + mat.Word(4000000000u),
       "byte 128: found a variable that has an element of 4000000000 bytes"},
      {Compressed(mat.Element(14, "") + mat.Array(6, {1, 1000000000}, "a", one).substr(8)),
       "ends before what was compressed does"},
      {mat.Element(14, ""), "ends within an element"},
      {mat.Struct({1, 1}, "a", mat.Array(5, {1, 3}, "", mat.Element(1, std::string(24, 'x')))),
       "ends within an element"},
      {Compressed(mat.Array(6, {1, 1000000000}, "a", one)), "1000000000 numbers by its dimensions"},
      {Compressed(mat.Array(9, {1, 1u << 28}, "a", mat.Element(2, std::string(1u << 26, '\0')))),
       "compressed from more than"},
  };
  const int64_t before = LargestMemory_kB();
  for (const auto& c : cases) {
    EXPECT_THAT(ErrorOf(mat.File(c.elements)),
                AllOf(HasSubstr(Path("x.mat") + ": byte 128: found "), HasSubstr(c.says)));
  }
  EXPECT_LT(LargestMemory_kB() - before, 300'000) << "kB; the compressed zeros above are 64 MiB themselves";
}

// Tests that what is as large as it says is read: both byte orders, plain and compressed, in structs, and
// beside arrays of kinds that are no signals.
TEST_F(MatSizesTest, WholeFilesAreRead) {
  for (const bool swapped : {false, true}) {
    const Mat5 mat(swapped);
    const std::string vector = mat.Array(6, {1, 3}, "a", mat.Doubles({1, 2, 3}));
    EXPECT_EQ(ErrorOf(mat.File(vector)), "");
    const Table table = ReadTable(Path("x.mat"));
    ASSERT_EQ(table.columns.size(), 1u);
    EXPECT_EQ(table.columns[0].values, (std::vector<double>{1, 2, 3}));
  }
  const Mat5 mat;
  const std::string vector = mat.Array(6, {1, 3}, "", mat.Doubles({1, 2, 3}));
  const std::string cells = mat.Array(1, {1, 2}, "c", vector + mat.Element(14, ""));
  const std::string complex = mat.Array(6, {1, 2}, "z", mat.Doubles({1, 2}) + mat.Doubles({3, 4}), 0x800);
  const std::string none = mat.Array(6, {0, 0}, "n", mat.Element(9, ""));
  const std::string sparse = mat.Array(5, {1000000, 1000000}, "s",
                                       mat.Element(5, "") + mat.Element(5, mat.Word(0)) + mat.Element(9, ""));
  const std::string all = mat.Struct({1, 1}, "d", vector) + cells + complex + none + sparse;
  EXPECT_EQ(ErrorOf(mat.File(all)), "");
  EXPECT_EQ(ErrorOf(mat.File(Compressed(mat.Struct({1, 1}, "d", vector)) + Compressed(complex))), "");
  const Table table = ReadTable(Path("x.mat"));
  ASSERT_EQ(table.columns.size(), 1u);
  EXPECT_EQ(table.columns[0].name, "d.f");
}

// Tests that the many equal numbers of a signal at rest, which compress to almost nothing, are a recording
// beside a time.
TEST_F(MatSizesTest, ASignalAtRestIsNoClaim) {
  Table table;
  table.columns = {{"t", {}}, {"u", std::vector<double>(100000, 0)}};
  for (int i = 0; i < 100000; ++i) table.columns[0].values.push_back(i * 1e-3);
  WriteTable(table, Path("rest.mat"));
  EXPECT_EQ(ReadTable(Path("rest.mat")).rows(), 100000u);
}

// Adds a dataset of which nothing is written, as matio would name a vector of doubles.
void AddUnwritten(const std::string& file, hsize_t numbers) {
  const hid_t root = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(root, 0);
  const hsize_t dimensions[2] = {numbers, 1}, chunk[2] = {100, 1};
  const hid_t space = H5Screate_simple(2, dimensions, nullptr);
  const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(how, 2, chunk);
  const hid_t dataset = H5Dcreate2(root, "a", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, how, H5P_DEFAULT);
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, 6);
  const hid_t scalar = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(dataset, "MATLAB_class", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
  EXPECT_GE(H5Awrite(attribute, text, "double"), 0);
  H5Aclose(attribute);
  H5Sclose(scalar);
  H5Tclose(text);
  H5Dclose(dataset);
  H5Pclose(how);
  H5Sclose(space);
  H5Fclose(root);
}

// Tests the same of version 7.3, whose numbers take no room before they are written.
TEST_F(MatSizesTest, UnwrittenNumbersOfHdf5) {
  for (const hsize_t numbers : {hsize_t{1000}, hsize_t{1000000000}, hsize_t{1} << 62}) {
    const std::string file = Path("h" + std::to_string(numbers) + ".mat");
    Mat_Close(Mat_CreateVer(file.c_str(), nullptr, MAT_FT_MAT73));
    AddUnwritten(file, numbers);
    const int64_t before = LargestMemory_kB();
    if (numbers == 1000) {
      EXPECT_EQ(ReadTable(file).rows(), 1000u);
      continue;
    }
    const std::string error = log::InputErrorOf([&] { ReadTable(file); });
    EXPECT_THAT(error, AllOf(HasSubstr(file + ": found dimensions of the variable \"a\""),
                             HasSubstr("more than 4194304 numbers")));
    EXPECT_LT(LargestMemory_kB() - before, 100'000) << "kB";
  }
}

}  // namespace
}  // namespace hydro::tables
