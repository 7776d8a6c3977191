#include "base/text_file.h"

#include "base/mapped_file.h"
#include "base/read_files.h"
#include "tests/settings/texts.h"

namespace hydro {
namespace {

using ::testing::HasSubstr;

// Tests that text stays as it is, and that control sequences never reach a terminal.
TEST(TextFileTest, Printable) {
  for (const char* text : {"", "a b\tc", "\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80\xc2\xa0"}) {
    EXPECT_EQ(Printable(text), text);
  }
  EXPECT_EQ(Printable("\033[31m\r\n\a\x7f"), "\\x1b[31m\\x0d\\x0a\\x07\\x7f");
  EXPECT_EQ(Printable("\x9b"
                      "2J \xc2\x9b"
                      "2J"),
            "\\x9b2J \\xc2\\x9b2J");
  EXPECT_EQ(Printable("\xff \xc3 \xe2\x82"), "\\xff \\xc3 \\xe2\\x82");
  EXPECT_EQ(Printable("\xed\xa0\x80 \xc1\xbf \xe0\x9f\xbf"), "\\xed\\xa0\\x80 \\xc1\\xbf \\xe0\\x9f\\xbf");
  EXPECT_EQ(Printable(std::string_view("\0x", 2)), "\\x00x");
}

// Tests that line ends stay, and that a missing last one stays missing.
TEST(TextFileTest, PrintableLines) {
  EXPECT_EQ(PrintableLines("a\n\n\033b\n"), "a\n\n\\x1bb\n");
  EXPECT_EQ(PrintableLines("a\nb"), "a\nb");
  EXPECT_EQ(PrintableLines(""), "");
}

// Tests that an error line stays a line when a file has a million columns.
TEST(TextFileTest, QuotedListOfManyNames) {
  EXPECT_EQ(QuotedList(std::vector<std::string>{"a", "b", "c"}), "\"a\", \"b\" or \"c\"");
  EXPECT_TRUE(QuotedList(std::vector<std::string>(100, "a")).ends_with("\"a\" or \"a\""));
  const std::string list = QuotedList(std::vector<std::string>(1'000'000, "a"));
  EXPECT_TRUE(list.ends_with("\"a\", \"a\", ... (999900 more)"));
  EXPECT_LT(list.size(), 1000u);
}

class TextFileFolderTest : public settings::FolderTest {};

// Tests that a file is not overwritten while it is being read, under any of its names; other files and
// devices may be.
TEST_F(TextFileFolderTest, CheckKeeps) {
  const std::string file = Write("a", "x");
  const std::string other = Write("b", "x");
  std::filesystem::create_symlink(file, folder_ / "link");
  for (const std::string& name : {file, (folder_ / "." / "a").string(), (folder_ / "link").string()}) {
    EXPECT_THAT(settings::InputErrorOf([&] {
                  CheckKeeps(name, {other, file});
                }),
                HasSubstr(name + ": found the name of a file"));
  }
  for (const std::string& name :
       {std::string(), other, (folder_ / "none").string(), std::string("/dev/null")}) {
    EXPECT_EQ(settings::InputErrorOf([&] { CheckKeeps(name, {file, "", "/dev/null"}); }), "") << name;
  }
}

// Tests that a device is no input, by any name: some have no end.
TEST_F(TextFileFolderTest, RefusesDevices) {
  std::filesystem::create_symlink("/dev/zero", folder_ / "link.csv");
  for (const std::string& name : {std::string("/dev/zero"), (folder_ / "link.csv").string()}) {
    EXPECT_EQ(settings::InputErrorOf([&] { ReadTextFile(name); }),
              name + ": found a device, allowed: a file");
    EXPECT_EQ(settings::InputErrorOf([&] { MappedFile{name}; }), name + ": found a device, allowed: a file");
  }
}

// Tests that two outputs may not be one file, whether it is there or not.
TEST_F(TextFileFolderTest, CheckDistinct) {
  const std::string file = Write("a", "x");
  std::filesystem::create_symlink(file, folder_ / "link");
  const auto error = [](const std::vector<std::string>& outputs) {
    return settings::InputErrorOf([&] { CheckDistinct(outputs); });
  };
  EXPECT_EQ(error({file, (folder_ / "b").string(), "", "", "/dev/null", "/dev/null"}), "");
  EXPECT_THAT(error({"new", "./new"}),
              HasSubstr("./new: found two outputs of this name (the other is written new)"));
  EXPECT_THAT(error({file, (folder_ / "link").string()}), HasSubstr("found two outputs"));
}

}  // namespace
}  // namespace hydro
