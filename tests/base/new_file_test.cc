#include "base/new_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "tests/temporary_folder.h"

// The calls that this process makes, in their order: these take the place of the library's own.
namespace {
std::vector<std::string> calls;
int fsync_error = 0;
std::function<void()> after_lstat;  // what another process does when this one has looked for a free name
}  // namespace

extern "C" int fsync(int fd) {
  struct stat status {};
  fstat(fd, &status);
  calls.emplace_back(S_ISDIR(status.st_mode) ? "fsync folder" : "fsync " + std::to_string(status.st_size));
  errno = fsync_error;
  return fsync_error == 0 ? 0 : -1;
}

extern "C" int rename(const char* from, const char* to) noexcept {
  calls.emplace_back("rename");
  return static_cast<int>(syscall(SYS_rename, from, to));
}

extern "C" int lstat(const char* path, struct stat* status) noexcept {
  const auto result = static_cast<int>(syscall(SYS_newfstatat, AT_FDCWD, path, status, AT_SYMLINK_NOFOLLOW));
  const int error = errno;
  if (const auto then = std::exchange(after_lstat, nullptr)) then();
  errno = error;
  return result;
}

namespace hydro {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string ErrorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

class NewFileTest : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }
  std::string Make(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name)) << text;
    return Path(name);
  }
  static std::string TextOf(const std::string& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  const TemporaryFolder folder_;
};

// Tests that a file that this process has read is never replaced, whatever path names it.
TEST_F(NewFileTest, KeepsWhatWasRead) {
  const std::string input = Make("input.toml", "precious");
  std::filesystem::create_symlink(input, Path("symlink"));
  std::filesystem::create_hard_link(input, Path("hardlink"));
  EXPECT_EQ(ReadTextFile(Path("symlink")), "precious");
  for (const std::string& name : {input, Path("symlink"), Path("hardlink"), folder_ / "./input.toml"}) {
    for (const Opening opening : {Opening::kDirect, Opening::kTemporary}) {
      EXPECT_THAT(ErrorOf([&] { NewFile(name, opening); }), HasSubstr("a file that is read")) << name;
    }
    EXPECT_THAT(ErrorOf([&] { CheckCanBeCreated(name); }), HasSubstr("a file that is read")) << name;
  }
  EXPECT_EQ(TextOf(input), "precious");
  EXPECT_TRUE(std::filesystem::exists(Path("hardlink")));
  WriteWholeFile(Make("other", "old"), "new");  // what was not read may be replaced
  EXPECT_EQ(TextOf(Path("other")), "new");
}

// Tests that what was put in the place of a file that was read, or is to be replaced on purpose, is no input.
TEST_F(NewFileTest, ForgetsWhatItIsTold) {
  const std::string input = Make("input", "old");
  ReadTextFile(input);
  ForgetRead(input);
  WriteWholeFile(input, "new");
  EXPECT_EQ(TextOf(input), "new");
}

// Tests that a file which happens to have the temporary name is neither replaced nor removed.
TEST_F(NewFileTest, KeepsAForeignPart) {
  Make("out.part", "somebody's");
  ASSERT_EQ(mkfifo(Path("out.part1").c_str(), 0600), 0);
  WriteWholeFile(Path("out"), "text");
  EXPECT_EQ(TextOf(Path("out")), "text");
  EXPECT_EQ(TextOf(Path("out.part")), "somebody's");
  { const NewFile unfinished(Path("out"), Opening::kTemporary); }
  EXPECT_EQ(TextOf(Path("out.part")), "somebody's");
  EXPECT_FALSE(std::filesystem::exists(Path("out.part2")));
}

// Tests that kKept keeps a file with contents unless told otherwise, says what to do, and takes an empty
// file's or a device's place.
TEST_F(NewFileTest, KeepsWhatIsThere) {
  const std::string log = Make("run.lcmlog", "yesterday");
  for (const Opening opening : {Opening::kDirect, Opening::kTemporary}) {
    const auto open = [&] { NewFile(log, opening, Existing::kKept); };
    EXPECT_THAT(ErrorOf(open), AllOf(HasSubstr(log), HasSubstr("--force")));
  }
  EXPECT_THAT(ErrorOf([&] { CheckCanBeCreated(log); }), HasSubstr("--force"));
  EXPECT_THAT(ErrorOf([&] { WriteTextFile(log, "today"); }), HasSubstr("--force"));
  EXPECT_EQ(TextOf(log), "yesterday");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}),
            1);  // nothing is left beside it
  WriteTextFile(Make("empty", ""), "today");
  EXPECT_EQ(TextOf(Path("empty")), "today");
  CheckIsNew("/dev/null");
  AllowReplacing();
  WriteTextFile(log, "today");
  AllowReplacing(false);
  EXPECT_EQ(TextOf(log), "today");
}

// Tests that a file has its name only when its bytes are on the disk, and the name itself then; that a disk
// that cannot say so fails, and leaves what was there; and that a file system without fsync() does.
TEST_F(NewFileTest, OnTheDiskBeforeItsName) {
  calls.clear();
  WriteWholeFile(Path("a"), "12345");
  EXPECT_THAT(calls, ElementsAre("fsync 5", "rename", "fsync folder"));
  fsync_error = EIO;
  EXPECT_THROW(WriteWholeFile(Path("a"), "other"), WriteError);
  EXPECT_EQ(TextOf(Path("a")), "12345");
  EXPECT_FALSE(std::filesystem::exists(Path("a.part")));
  fsync_error = EINVAL;
  WriteWholeFile(Path("a"), "new");
  EXPECT_EQ(TextOf(Path("a")), "new");
  fsync_error = 0;
  calls.clear();
  NewFile direct(Path("direct"), Opening::kDirect);  // it has its name from the start
  direct.Finish();
  EXPECT_THAT(calls, IsEmpty());
}

// Tests that a file which appears while another of its name is being written is kept, and so is what was
// written.
TEST_F(NewFileTest, KeepsWhatAppears) {
  NewFile file(Path("run"), Opening::kTemporary, Existing::kKept);
  file.Write("ours", 4);
  Make("run", "theirs");
  EXPECT_THROW(file.Finish(), WriteError);
  EXPECT_EQ(TextOf(Path("run")), "theirs");
  EXPECT_EQ(TextOf(Path("run.part")), "ours");
}

// Tests that a file which another is writing is never replaced: not with --force, not by what replaces
// everything, and not while it is still empty; and that an asking CheckIsNew() does not pass for a writer.
TEST_F(NewFileTest, KeepsWhatIsBeingWritten) {
  NewFile recording(Path("run"), Opening::kDirect);
  for (const bool forced : {false, true}) {
    AllowReplacing(forced);
    for (const char* const contents : {"", "so far"}) {
      recording.Write(contents, std::strlen(contents));
      EXPECT_THAT(ErrorOf([&] { CheckIsNew(Path("run")); }), HasSubstr("is being written"));
      EXPECT_THAT(ErrorOf([&] { CheckCanBeCreated(Path("run")); }), HasSubstr("is being written"));
      EXPECT_THAT(ErrorOf([&] { WriteTextFile(Path("run"), "new"); }), HasSubstr("is being written"));
      for (const Opening opening : {Opening::kDirect, Opening::kTemporary})
        for (const Existing existing : {Existing::kKept, Existing::kReplaced})
          EXPECT_THAT(ErrorOf([&] { NewFile(Path("run"), opening, existing); }),
                      HasSubstr("is being written"));
    }
  }
  AllowReplacing(false);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
  recording.Finish();
  EXPECT_EQ(TextOf(Path("run")), "so farso far");
  const int asking = open(Path("run").c_str(), O_RDONLY);
  ASSERT_EQ(flock(asking, LOCK_SH), 0);
  EXPECT_FALSE(IsBeingWritten(Path("run")));
  close(asking);
}

// Tests that a file which another process begins to write, while one that replaces it is being written, is
// kept, and so is what was written.
TEST_F(NewFileTest, KeepsARecordingThatBegins) {
  NewFile file(Path("run"), Opening::kTemporary, Existing::kReplaced);
  file.Write("ours", 4);
  NewFile recording(Path("run"), Opening::kDirect);
  recording.Write("theirs", 6);
  EXPECT_THROW(file.Finish(), WriteError);
  EXPECT_EQ(TextOf(Path("run")), "theirs");
  EXPECT_EQ(TextOf(Path("run.part")), "ours");
}

// Tests that the names of what a killed process leaves are told from others.
TEST_F(NewFileTest, NamesTheWholeOfAPart) {
  EXPECT_EQ(WholeOfPart("a.csv.part"), "a.csv");
  EXPECT_EQ(WholeOfPart("a.csv.part12"), "a.csv");
  for (const char* name : {"a.csv", "a.parts", "a.part.csv", "a.part1b"})
    EXPECT_EQ(WholeOfPart(name), "") << name;
}

// Tests that two at a time are refused under each temporary name.
TEST_F(NewFileTest, OneWriterAtATime) {
  Make("out.part", "somebody's");
  const NewFile first(Path("out"), Opening::kTemporary);
  EXPECT_THAT(ErrorOf([&] { NewFile(Path("out"), Opening::kTemporary); }), HasSubstr("is being written"));
}

// Tests that a pipe that nobody writes to is refused instead of waited for.
TEST_F(NewFileTest, PipesAreNoInputs) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  EXPECT_THAT(ErrorOf([&] { ReadTextFile(Path("pipe")); }), HasSubstr("found a pipe"));
}

// Tests that of two writers that find the same temporary name free in the same instant, the later one says
// that the other writes, or takes another name when the other's file is only there.
TEST_F(NewFileTest, TemporaryNameTakenInTheSameInstant) {
  const std::string name = Path("table.csv");
  const auto both = [&] { const NewFile file(name, Opening::kTemporary); };
  int other = -1;
  after_lstat = [&] {
    other = open((name + ".part").c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
    flock(other, LOCK_EX);
  };
  EXPECT_THAT(ErrorOf(both), HasSubstr("table.csv: is being written by another process"));
  close(other);
  unlink((name + ".part").c_str());
  after_lstat = [&] { std::ofstream(name + ".part") << "another's"; };
  EXPECT_EQ(ErrorOf(both), "no error");
  EXPECT_EQ(ReadTextFile(name + ".part"), "another's");
}

}  // namespace
}  // namespace hydro
