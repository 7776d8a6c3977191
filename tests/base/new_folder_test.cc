#include "base/new_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/input_error.h"
#include "tests/temporary_folder.h"

namespace hydro {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class NewFolderTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }
  std::string ErrorOf(const std::string& name) const {
    try {
      const NewFolder folder(Path(name));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  const TemporaryFolder folder_;
};

// Tests that the folder has its name with all files in it, or leaves nothing; an empty one of its name is
// replaced.
TEST_F(NewFolderTest, WholeOrNotAtAll) {
  {
    const NewFolder folder(Path("a"));
    std::ofstream(folder.path() + "/x.csv") << "x";
    EXPECT_FALSE(fs::exists(Path("a")));
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  fs::create_directory(Path("a"));
  fs::create_directory(Path("a.part"));  // somebody's
  NewFolder folder(Path("a/"));
  std::ofstream(folder.path() + "/x.csv") << "x";
  folder.Finish();
  EXPECT_TRUE(fs::exists(Path("a/x.csv")));
  EXPECT_TRUE(fs::is_empty(Path("a.part")));
  EXPECT_FALSE(fs::exists(Path("a.part1")));
}

// Tests that nothing that is there is overwritten, and that what cannot be made is said.
TEST_F(NewFolderTest, Refused) {
  fs::create_directory(Path("full"));
  std::ofstream(Path("full/x")) << "x";
  std::ofstream(Path("file")) << "x";
  EXPECT_THAT(ErrorOf("full/"), HasSubstr("full/: found something that is there already"));
  EXPECT_THAT(ErrorOf("file/"), HasSubstr("file/: found something that is there already"));
  EXPECT_THAT(ErrorOf("none/a/"), HasSubstr("none/a/: cannot be created: No such file or directory"));
  EXPECT_TRUE(fs::exists(Path("full/x")));
}

}  // namespace
}  // namespace hydro
