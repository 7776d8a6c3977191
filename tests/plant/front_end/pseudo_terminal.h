// A pseudo terminal of which a test holds the device's end.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <string>
#include <vector>

namespace hydro::plant {

class PseudoTerminal {
 public:
  PseudoTerminal() : device_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    EXPECT_EQ(grantpt(device_), 0);
    EXPECT_EQ(unlockpt(device_), 0);
    char name[64] = {};
    EXPECT_EQ(ptsname_r(device_, name, sizeof name), 0);
    path_ = name;
  }
  ~PseudoTerminal() { Unplug(); }

  // The cable is pulled: the port hangs up and its file disappears.
  void Unplug() {
    if (device_ >= 0) close(device_);
    device_ = -1;
  }

  int device() const { return device_; }
  const std::string& path() const { return path_; }

  void Send(const std::vector<uint8_t>& bytes) const {
    EXPECT_EQ(write(device_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  std::vector<uint8_t> Receive() const {
    std::vector<uint8_t> bytes(65536);
    const ssize_t got = read(device_, bytes.data(), bytes.size());
    bytes.resize(static_cast<size_t>(got > 0 ? got : 0));
    return bytes;
  }

 private:
  int device_;
  std::string path_;
};

}  // namespace hydro::plant
