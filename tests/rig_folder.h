// A folder for what a hidden or a foreign rig writes, empty at the beginning of each test and gone after it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace hydro::testing {

class RigFolder : public ::testing::Test {
 protected:
  // `prefix` keeps tests of the same name in two programs apart.
  explicit RigFolder(const std::string& prefix)
      : folder_(std::filesystem::path(::testing::TempDir()) /
                (prefix + ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
  }
  ~RigFolder() override { std::filesystem::remove_all(folder_); }

  template <class Cases>
  static auto CaseIn(const Cases& cases, const std::string& name) {
    for (const auto& c : cases) {
      if (c.name == name) return c;
    }
    throw std::runtime_error("no case " + name);
  }
  static std::string Text(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }
  std::string Folder(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

}  // namespace hydro::testing
