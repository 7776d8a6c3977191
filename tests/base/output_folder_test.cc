#include "base/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "base/input_error.h"
#include "tests/temporary_folder.h"

namespace hydro {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OutputFolderTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }

  const TemporaryFolder folder_;
};

// Tests that folders that were made for nothing go again, with those above them, and no other does.
TEST_F(OutputFolderTest, LeavesNoEmptyFolder) {
  fs::create_directory(Path("a"));
  for (const char* name : {"a/b/c", "a/b/c/", "a/b//c"}) {
    std::optional<OutputFolder> made(std::in_place, Path(name), "--out");
    EXPECT_TRUE(fs::is_directory(Path("a/b/c"))) << name;
    made.reset();
    EXPECT_FALSE(fs::exists(Path("a/b"))) << name;
    EXPECT_TRUE(fs::exists(Path("a"))) << name;
  }
  { const OutputFolder there(Path("a"), "--out"); }
  EXPECT_TRUE(fs::exists(Path("a")));
}

// Tests that what holds a file stays, with all that is above it.
TEST_F(OutputFolderTest, KeepsWhatWasWritten) {
  {
    const OutputFolder made(Path("a/b"), "--out");
    std::ofstream(Path("a/x.csv")) << "x";
  }
  EXPECT_FALSE(fs::exists(Path("a/b")));
  EXPECT_TRUE(fs::exists(Path("a/x.csv")));
}

// Tests that what cannot be a folder to write to is said, under the name it was given as, and leaves nothing.
TEST_F(OutputFolderTest, SaysWhatCannotBe) {
  std::ofstream(Path("file")) << "x";
  const std::pair<std::string, std::string> cases[] = {{Path("file"), "Not a directory"},
                                                       {Path("file/b"), "Not a directory"},
                                                       {"/proc/none/deep", "No such file or directory"}};
  for (const auto& [name, reason] : cases) {
    try {
      const OutputFolder folder(name, "DIR");
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  HasSubstr("DIR: found \"" + name + "\", a folder that cannot be written (" + reason + ")"));
    }
  }
}

}  // namespace
}  // namespace hydro
