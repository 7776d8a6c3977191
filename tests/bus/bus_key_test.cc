#include "bus/seal/bus_key.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/input_error.h"

namespace hydro::bus {
namespace {

using testing::HasSubstr;

class BusKeyTest : public testing::Test {
 protected:
  BusKeyTest() : folder_(testing::TempDir() + "bus_key_test." + std::to_string(getpid())) {
    std::filesystem::create_directory(folder_);
  }
  ~BusKeyTest() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return folder_ + "/" + name; }
  std::string Write(const std::string& text, mode_t mode = 0600) const {
    const std::string file = Path("key");
    std::ofstream(file) << text;
    chmod(file.c_str(), mode);
    return file;
  }
  // The text of the InputError for the file; "" when the file is accepted.
  static std::string ErrorOf(const std::string& file) {
    try {
      ReadBusKey(file);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      EXPECT_THAT(error.what(), HasSubstr(file));
      return error.what();
    }
    return "";
  }

  std::string folder_;
};

const char kHex[] = "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f";
const char kBase64[] = "AAECAwQFBgcICQoLDA0ODxAREhMUFRYXGBkaGxwdHh8=";

// Tests that hexadecimal digits and base64 give the same 32 bytes, with and without what editors add.
TEST_F(BusKeyTest, ReadsHexAndBase64) {
  for (const std::string& text :
       {std::string(kHex), kHex + std::string("\n"), kBase64 + std::string("\r\n"),
        "  " + std::string(kHex) + " ", std::string(kBase64, 43),
        std::string("000102030405060708090A0B0C0D0E0F101112131415161718191a1b1c1d1e1f")}) {
    const BusKey key = ReadBusKey(Write(text));
    for (size_t i = 0; i < kBusKeySize; ++i) EXPECT_EQ(key.bytes()[i], i) << text;
  }
}

// Tests that anything else is refused without being shown.
TEST_F(BusKeyTest, RefusesWhatIsNoKey) {
  const std::string hex = kHex;
  for (const std::string& text :
       {std::string(), std::string("\n"), std::string("secret"), hex.substr(2), hex + "00", hex + "\n" + hex,
        hex.substr(0, 63) + "g", "0x" + hex, std::string(kBase64, 42), std::string(kBase64) + "=",
        std::string(300, '0'), std::string(100000, 'A'), std::string(32, '\x01'), std::string(64, '\0')}) {
    const std::string error = ErrorOf(Write(text));
    EXPECT_THAT(error, HasSubstr("64 hexadecimal digits")) << text;
    EXPECT_EQ(error.find("secret"), std::string::npos);
    EXPECT_EQ(error.find("0001020304"), std::string::npos);
  }
}

// Tests that a file that others may read or write is refused, naming the permissions and the remedy.
TEST_F(BusKeyTest, RefusesWidePermissions) {
  for (const mode_t mode : {0640, 0604, 0620, 0602, 0610, 0777, 0660}) {
    const std::string file = Write(kHex, mode);
    EXPECT_THAT(ErrorOf(file), HasSubstr("chmod 600 " + file));
  }
  for (const mode_t mode : {0600, 0700, 0400}) EXPECT_EQ(ErrorOf(Write(kHex, mode)), "");
}

// Tests that a missing file, a folder and a device are refused.
TEST_F(BusKeyTest, RefusesWhatIsNoFile) {
  EXPECT_THAT(ErrorOf(Path("none")), HasSubstr("--make-key"));
  std::filesystem::create_directory(Path("folder"));
  EXPECT_THAT(ErrorOf(Path("folder")), HasSubstr("not a file"));
  EXPECT_THAT(ErrorOf("/dev/zero"), HasSubstr("not a file"));
}

// Tests that an existing but unreadable file brings no advice to make a new key, which would lock others out.
TEST_F(BusKeyTest, UnreadableFile) {
  const std::string file = Write(kHex, 0000);
  const uid_t user = geteuid();
  if (user == 0) {  // root may read anything
    ASSERT_EQ(seteuid(65534), 0);
  }
  const std::string error = ErrorOf(file);
  ASSERT_EQ(seteuid(user), 0);
  EXPECT_THAT(error, testing::AllOf(HasSubstr("Permission denied"), HasSubstr("own it")));
  EXPECT_EQ(error.find("--make-key"), std::string::npos) << error;
  EXPECT_EQ(ErrorOf(file + "/key").find("--make-key"), std::string::npos);
}

// Tests that the key everybody tries first is refused.
TEST_F(BusKeyTest, RefusesZeros) {
  for (const std::string& text : {std::string(64, '0'), std::string(42, 'A') + "A="}) {
    EXPECT_THAT(ErrorOf(Write(text)), testing::AllOf(HasSubstr("zeros"), HasSubstr("--make-key")));
  }
  EXPECT_EQ(ErrorOf(Write(std::string(63, '0') + "1")), "");
}

// Tests that a new key can be read, by its owner alone, differs each time, and replaces no file.
TEST_F(BusKeyTest, MakesKeys) {
  MakeBusKeyFile(Path("a"));
  MakeBusKeyFile(Path("b"));
  EXPECT_NE(ReadBusKey(Path("a")).bytes(), ReadBusKey(Path("b")).bytes());
  struct stat status {};
  ASSERT_EQ(stat(Path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777U, 0600U);
  const auto before = ReadBusKey(Path("a")).bytes();
  EXPECT_THROW(MakeBusKeyFile(Path("a")), InputError);
  EXPECT_EQ(ReadBusKey(Path("a")).bytes(), before);
  EXPECT_THROW(MakeBusKeyFile(Path("none/a")), InputError);
}

}  // namespace
}  // namespace hydro::bus
