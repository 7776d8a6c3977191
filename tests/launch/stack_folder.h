// A folder with a copy of hydro-launch, fake programs beside it, and a configuration: a private stack.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/free_udp_port.h"
#include "tests/launch/launched_program.h"
#include "tests/settings/small_texts.h"
#include "tests/temporary_folder.h"

namespace hydro::launch {

class StackFolder {
 public:
  explicit StackFolder(const std::vector<std::string>& programs = {"hydro-plant", "hydro-pressure-ctrl",
                                                                   "hydro-position-ctrl", "hydro-logger"}) {
    // hydro-launch looks in its own folder: it must be a copy, not a link to elsewhere.
    std::filesystem::copy_file(HYDRO_LAUNCH, folder_ / "hydro-launch");
    for (const std::string& program : programs) {
      std::filesystem::create_symlink(HYDRO_FAKE_PROGRAM, folder_ / program);
    }
    environment["HYDRO_FAKE_URL"] = url_;
    environment["HYDRO_FAKE_plant"] = "status ready;wait;status done";
    environment["HYDRO_FAKE_pressure_ctrl"] = "status ready;wait;status done";
    environment["HYDRO_FAKE_position_ctrl"] = "status ready;wait;status done";
    environment["HYDRO_FAKE_logger"] = "status ready;wait-term;status done";
    WriteConfig("");
  }

  std::map<std::string, std::string> environment;

  // What a fake program does; see fake_program.cc.
  void Script(const std::string& role, const std::string& commands) {
    environment["HYDRO_FAKE_" + role] = commands;
  }

  // A valid configuration with `more` at its end.
  void WriteConfig(const std::string& more) {
    std::ofstream(folder_ / "model.toml") << settings::kModelText;
    std::ofstream(config())
        << "[model]\nfile = \"model.toml\"\n[bus]\nurl = \"" << url_
        << "\"\n[plant]\nrate_hz = 1000\n[pressure]\nnatural_frequency_rad_s = 150.0\n"
           "damping_ratio = 0.5\n[position]\nsample_interval_s = 0.005\nc1 = 350.0\nc2 = 11.0\n"
           "[reference]\nsignal = \"arm_angle\"\nkind = \"steps\"\nsteps = [[0.1, 0.1]]\n"
        << more;
  }

  std::string config() const { return (folder_ / "stack.toml").string(); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  const std::string& url() const { return url_; }

  // hydro-launch stack.toml arguments...
  std::unique_ptr<LaunchedProgram> Launch(std::vector<std::string> arguments = {}) {
    arguments.insert(arguments.begin(), {file("hydro-launch"), config()});
    return std::make_unique<LaunchedProgram>(arguments, environment);
  }

 private:
  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
  std::string url_ = FreeBusUrl();
};

}  // namespace hydro::launch
