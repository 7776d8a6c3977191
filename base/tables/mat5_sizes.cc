#include <libdeflate.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "base/input_error.h"
#include "base/mapped_file.h"
#include "base/tables/mat_sizes.h"
#include "base/text_file.h"

namespace hydro::tables {
namespace {

using Bytes = std::span<const uint8_t>;

constexpr size_t kHeaderSize = 128;
constexpr size_t kTagSize = 8;     // of each element's tag: its type and byte count
constexpr int kDeepestArray = 32;  // arrays within arrays
constexpr size_t kMostDimensions = 64;
constexpr uint32_t kComplex = 0x800;

enum Type : uint32_t { kInt8 = 1, kInt32 = 5, kUint32 = 6, kMatrix = 14, kCompressed = 15, kUtf8 = 16 };
enum Class : uint32_t { kCell = 1, kStruct = 2, kObject = 3, kSparse = 5, kFunction = 16, kOpaque = 17 };

// The number of bytes of a number of that type; 0 when the type is not a number.
size_t SizeOf(uint32_t type) {
  constexpr size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8, 0, 0, 1, 2, 4};
  return type < std::size(kSizes) ? kSizes[type] : 0;
}

struct Element {
  uint32_t type = 0;
  Bytes data;
};

// Checks one top-level element of a file and everything in it.
class Walk {
 public:
  Walk(const std::string& file, size_t offset, bool swapped, size_t most_numbers)
      : file_(file), offset_(offset), swapped_(swapped), most_numbers_(most_numbers) {}

  // Removes the element at the beginning of `rest`, and returns it.
  Element Take(Bytes* rest) const {
    if (rest->size() < kTagSize) Fail("ends within an element");
    const uint32_t first = Number(*rest, 0);
    Element element;
    if (first >> 16 != 0) {  // a small element: the bytes are in the tag
      if (first >> 16 > 4) Fail("has an element of more bytes than its tag holds");
      element = {first & 0xffff, rest->subspan(4, first >> 16)};
      *rest = rest->subspan(kTagSize);
      return element;
    }
    const size_t size = Number(*rest, 4);
    if (size > rest->size() - kTagSize) {
      Fail(fmt::format("has an element of {} bytes where {} are left", size, rest->size() - kTagSize));
    }
    element = {first, rest->subspan(kTagSize, size)};
    // Each element begins at a multiple of 8; after the last one nothing need follow.
    *rest = rest->subspan(std::min(rest->size(), kTagSize + (size + 7) / 8 * 8));
    return element;
  }

  void Array(const Element& array, int depth) {
    if (array.type != kMatrix)
      Fail(fmt::format("has an element of type {} where an array is needed", array.type));
    if (array.data.empty() && depth > 0) return;  // an empty cell or field
    if (depth > kDeepestArray) Fail(fmt::format("is nested more than {} deep", kDeepestArray));
    Bytes rest = array.data;
    const Element flags = Take(&rest);
    if (flags.type != kUint32 || flags.data.size() != 8) Fail("has no array flags");
    const uint32_t kind = Number(flags.data, 0) & 0xff;
    if (kind < kCell || kind > kOpaque) Fail(fmt::format("is of class {}", kind));
    if (kind == kOpaque) return Rest(rest, depth);  // an object of MATLAB's, of which nothing is read
    const size_t count = Product(Take(&rest));
    const Element name = Take(&rest);
    if (name.type != kInt8 && name.type != kUtf8) Fail("has no name");
    if (depth == 0) name_.assign(reinterpret_cast<const char*>(name.data.data()), name.data.size());
    switch (kind) {
      case kCell:
      case kFunction:
        return Arrays(rest, count, 1, depth);
      case kObject:
        Take(&rest);  // its class
        [[fallthrough]];
      case kStruct:
        return Fields(rest, count, depth);
      case kSparse:
        return Sparse(rest, (Number(flags.data, 0) & kComplex) != 0);
      default:
        Numbers(&rest, count);
        if ((Number(flags.data, 0) & kComplex) != 0) Numbers(&rest, count);
    }
  }

  [[noreturn]] void Fail(const std::string& what) const {
    const std::string variable = name_.empty() ? "a variable" : "the variable " + Quoted(name_);
    throw InputError(fmt::format(
        "{}: byte {}: found {} that {}; allowed is a file that holds all it speaks of: save it again", file_,
        offset_, variable, what));
  }

  size_t numbers() const { return numbers_; }

 private:
  uint32_t Number(Bytes bytes, size_t at) const {
    uint32_t number = 0;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return swapped_ ? __builtin_bswap32(number) : number;
  }

  // The product of dimensions; the largest size when the product overflows.
  size_t Product(const Element& dimensions) const {
    const size_t count = dimensions.data.size() / 4;
    if (dimensions.type != kInt32 || dimensions.data.size() % 4 != 0) Fail("has no dimensions");
    if (count < 2 || count > kMostDimensions) Fail(fmt::format("has {} dimensions", count));
    size_t product = 1;
    for (size_t i = 0; i < count; ++i) {
      const auto dimension = static_cast<int32_t>(Number(dimensions.data, 4 * i));
      if (dimension < 0) Fail(fmt::format("has {} as a dimension", dimension));
      if (dimension == 0) return 0;
      if (__builtin_mul_overflow(product, static_cast<size_t>(dimension), &product)) product = SIZE_MAX;
    }
    return product;
  }

  void Numbers(Bytes* rest, size_t count) {
    if (count == 0 && rest->empty()) return;
    const Element data = Take(rest);
    const size_t size = SizeOf(data.type);
    if (size == 0 || data.data.size() / size < count) {
      Fail(fmt::format("has {} numbers by its dimensions and {} bytes of them", count, data.data.size()));
    }
    numbers_ += count;
    if (numbers_ > most_numbers_) {
      Fail(fmt::format("has {} numbers, which is more than a file of this size can be a recording of",
                       numbers_));
    }
  }

  // Checks `count` times `each` arrays. Each has at least a tag, so the bytes limit the count.
  void Arrays(Bytes rest, size_t count, size_t each, int depth) {
    size_t wanted = 0;
    if (__builtin_mul_overflow(count, each, &wanted) || wanted > rest.size() / kTagSize) {
      Fail(fmt::format("has {} arrays by its dimensions and {} bytes of them", wanted == 0 ? count : wanted,
                       rest.size()));
    }
    for (size_t i = 0; i < wanted; ++i) Array(Take(&rest), depth + 1);
  }

  void Fields(Bytes rest, size_t count, int depth) {
    const Element length = Take(&rest), names = Take(&rest);
    const size_t each = length.data.size() == 4 ? Number(length.data, 0) : 0;
    if (each == 0 || names.data.size() % each != 0) Fail("has names of fields that are damaged");
    for (size_t at = 0; at < names.data.size(); at += each) {
      const Bytes one = names.data.subspan(at, each);
      if (std::find(one.begin(), one.end(), uint8_t{0}) == one.end())
        Fail("has a name of a field without an end");
    }
    if (count > names.data.size() + rest.size()) Fail(fmt::format("has {} structs by its dimensions", count));
    Arrays(rest, count, names.data.size() / each, depth);
  }

  // Checks rows, starts of columns, and numbers: matio would read beyond the end for missing ones.
  void Sparse(Bytes rest, bool complex) const {
    const Element rows = Take(&rest), columns = Take(&rest), numbers = Take(&rest);
    const bool indices = rows.type == kInt32 && columns.type == kInt32;
    if (!indices || SizeOf(numbers.type) == 0 || (complex && SizeOf(Take(&rest).type) == 0))
      Fail("is a sparse matrix without its numbers");
  }

  // Checks elements of which only the sizes matter.
  void Rest(Bytes rest, int depth) {
    while (!rest.empty()) {
      const Element element = Take(&rest);
      if (element.type == kMatrix) Array(element, depth + 1);
    }
  }

  const std::string& file_;
  const size_t offset_;
  const bool swapped_;
  const size_t most_numbers_;
  std::string name_;
  size_t numbers_ = 0;
};

struct FreeDecompressor {
  void operator()(libdeflate_decompressor* one) const { libdeflate_free_decompressor(one); }
};

// Empty when there are more than `most` bytes, or when the compressed data are damaged.
std::vector<uint8_t> Decompressed(Bytes compressed, size_t most) {
  const std::unique_ptr<libdeflate_decompressor, FreeDecompressor> decompressor(
      libdeflate_alloc_decompressor());
  std::vector<uint8_t> bytes;
  for (size_t room = std::min(most, std::max<size_t>(4096, 4 * compressed.size()));;
       room = std::min(most, 4 * room)) {
    bytes.resize(room);
    size_t size = 0;
    const libdeflate_result result = libdeflate_zlib_decompress(decompressor.get(), compressed.data(),
                                                                compressed.size(), bytes.data(), room, &size);
    if (result == LIBDEFLATE_INSUFFICIENT_SPACE && room < most) continue;
    bytes.resize(result == LIBDEFLATE_SUCCESS ? size : 0);
    return bytes;
  }
}

}  // namespace

size_t MostNumbers(size_t file_bytes) {
  constexpr size_t kAlways = size_t{1} << 22;
  constexpr size_t kPerByte = 256;
  return std::max(kAlways, kPerByte * file_bytes);
}

void CheckMat5Sizes(const std::string& file) {
  const MappedFile contents(file);
  const bool swapped = contents.size() >= kHeaderSize && contents.data()[kHeaderSize - 2] == 'M';
  const size_t most = MostNumbers(contents.size());
  size_t numbers = 0;
  for (size_t offset = kHeaderSize; offset < contents.size();) {
    Walk walk(file, offset, swapped, most - numbers);
    const Bytes left(contents.data() + offset, contents.size() - offset);
    Bytes rest = left;
    Element element = walk.Take(&rest);
    std::vector<uint8_t> bytes;
    if (element.type == kCompressed) {
      bytes = Decompressed(element.data, most);
      if (bytes.empty()) walk.Fail(fmt::format("is damaged, or compressed from more than {} bytes", most));
      Bytes inside(bytes);
      const Element compressed = element;
      element = walk.Take(&inside);
      if (!inside.empty()) walk.Fail("ends before what was compressed does");  // matio would read on
      // Compressed elements are not padded, although their size need not be a multiple of 8.
      rest = left.subspan(kTagSize + compressed.data.size());
    }
    walk.Array(element, 0);
    numbers += walk.numbers();
    offset = contents.size() - rest.size();
  }
}

}  // namespace hydro::tables
