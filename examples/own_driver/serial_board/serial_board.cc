// A driver for a microcontroller on a serial port whose sketch speaks lines of text, and stays as it is
// (docs/own_driver.md). Where you may change the firmware, docs/front_end.md has the better way.
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "board.h"
#include "plant/driver/driver_main.h"

namespace {

std::unique_ptr<hydro::plant::Device> Open(hydro::plant::DeviceSettings& settings) {
  int baud = 0, patience = 5000;
  settings.own.Integer("baud", &baud, 1, 10000000);
  settings.own.Require("baud", "bits per second, as the sketch has them in Serial.begin()");
  settings.own.Integer("answer_ms", &patience, 1, 60000);
  settings.own.Finish();
  const auto rate = serial_board::RateOf(baud);
  if (!rate) throw settings.own.Error("baud", std::to_string(baud), serial_board::AllowedRates());
  const auto folder = std::filesystem::absolute(settings.config.file).parent_path();
  const std::string path = folder / settings.device;
  std::string todo;
  const int port = serial_board::OpenPort(path, *rate, &todo);
  if (port < 0) {
    const std::string why = std::strerror(errno);
    throw hydro::settings::KeyError(settings.config.file, "driver.device", "\"" + path + "\" (" + why + ")",
                                    todo);
  }
  return std::make_unique<serial_board::SerialBoard>(port, path, settings.clock, settings.drives,
                                                     std::chrono::milliseconds(patience));
}

}  // namespace

int main(int argc, char** argv) {
  return hydro::plant::RunDriver(argc, argv, "Drives a machine behind a microcontroller on a serial port.",
                                 Open);
}
