#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "launch/child_process.h"

namespace hydro::launch {
namespace {

std::vector<std::string> LinesOf(const std::vector<std::string>& pieces) {
  LineAssembler assembler;
  std::vector<std::string> lines;
  const auto keep = [&](std::string_view line) { lines.emplace_back(line); };
  for (const std::string& piece : pieces) assembler.Feed(piece, keep);
  assembler.Finish(keep);
  return lines;
}

// Tests that a text gives the same lines wherever it is cut.
TEST(LineAssemblerTest, CutsDoNotMatter) {
  const std::string text = "one\n\nthree has words\nfour";
  const std::vector<std::string> expected{"one", "", "three has words", "four"};
  for (std::size_t first = 0; first <= text.size(); ++first) {
    for (std::size_t second = first; second <= text.size(); ++second) {
      EXPECT_EQ(LinesOf({text.substr(0, first), text.substr(first, second - first), text.substr(second)}),
                expected)
          << first << " " << second;
    }
  }
}

// Tests that a line without an end is passed on in pieces, and that none of it is lost.
TEST(LineAssemblerTest, EndlessLineComesInPieces) {
  const std::string endless(3 * LineAssembler::kLongestLine + 5, 'x');
  for (const std::size_t cut :
       {std::size_t{1}, LineAssembler::kLongestLine, 2 * LineAssembler::kLongestLine + 1}) {
    const std::vector<std::string> lines =
        LinesOf({endless.substr(0, cut), endless.substr(cut) + "\nnext\n"});
    std::string together;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
      EXPECT_LE(lines[i].size(), LineAssembler::kLongestLine);
      together += lines[i];
    }
    EXPECT_EQ(together, endless);
    EXPECT_EQ(lines.back(), "next");
  }
}

// Tests that a line of exactly the longest length is one line and adds no empty one.
TEST(LineAssemblerTest, LongestLineIsOneLine) {
  const std::string longest(LineAssembler::kLongestLine, 'x');
  EXPECT_EQ(LinesOf({longest + "\nnext\n"}), (std::vector<std::string>{longest, "next"}));
}

}  // namespace
}  // namespace hydro::launch
