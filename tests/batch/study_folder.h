// A folder for a test with a study file in it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/text_file.h"
#include "batch/study/study.h"
#include "tests/temporary_folder.h"

namespace hydro::batch {

class StudyFolder {
 public:
  std::string operator/(const std::string& name) const { return folder_ / name; }

  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  Study Read(const std::string& text) const { return ReadStudy(Write("study.toml", text)); }

  // The one line with which a study is refused, without the folder's name; empty: it is not.
  std::string Refusal(const std::string& text) const {
    try {
      Read(text);
    } catch (const InputError& error) {
      std::string line = error.what();
      if (line.starts_with(folder_.path())) line.erase(0, folder_.path().size() + 1);
      return line;
    }
    return "";
  }

 private:
  const TemporaryFolder folder_;
};

// A study whose cases are a command of the shell; the keys k and l vary.
inline const std::string kShellStudy = R"(
name = "shell"
[[grid]]
key = "k"
values = [1, 2, 3]
[[grid]]
key = "l"
values = [10.5, 20.5]
[[step]]
run = ["sh", "-c", "printf '[%s, %s]' {value:k} {value:l} > out.json"]
[collect]
k_again = "out.json:/0"
l_again = "out.json:/1"
)";

}  // namespace hydro::batch
