#include "base/remarks.h"

#include <cstdio>
#include <utility>
#include <vector>

#include "base/text_file.h"

namespace hydro {
namespace {

std::vector<std::string>& Kept() {
  static std::vector<std::string> kept;
  return kept;
}

}  // namespace

void Remark(const std::string& line) { Kept().push_back(line); }

void SayRemarks() {
  for (const std::string& line : std::exchange(Kept(), {}))
    std::fprintf(stderr, "%s\n", Printable(line).c_str());
}

}  // namespace hydro
