// A folder for what a rig writes, empty at the beginning of each test and gone after it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/foreign_rig/write.h"

namespace foreign_rig {

class RigFolder : public ::testing::Test {
 protected:
  RigFolder() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::remove_all(folder_);
  }
  ~RigFolder() override { std::filesystem::remove_all(folder_); }

  static Case CaseNamed(const std::string& name) {
    for (const Case& c : AllCases()) {
      if (c.name == name) return c;
    }
    throw std::runtime_error("no case " + name);
  }
  // Half a second of each run, in the folder of this name, and the answers beside it.
  Solved Write(const Case& c, const std::string& name) const {
    const Options options{0.5, 500};
    const Solved solved = Solve(c, options);
    WriteRuns(c, solved, options, Folder(name));
    WriteKey(c, solved, Folder(name) + ".json");
    return solved;
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

}  // namespace foreign_rig
