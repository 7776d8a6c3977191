// A driver for a servo drive on CAN with the profile CiA 402, in torque mode (docs/own_driver.md).
#include <filesystem>
#include <memory>

#include "drive.h"
#include "plant/driver/driver_main.h"

int main(int argc, char** argv) {
  return hydro::plant::RunDriver(
      argc, argv, "Drives a machine with a CANopen servo drive, in torque mode.",
      [](hydro::plant::DeviceSettings& settings) {
        int node = 0;
        settings.own.Integer("node", &node, 1, 126);
        settings.own.Require("node", "the drive's number on the CAN bus, 1 to 126");
        settings.own.Finish();
        const auto folder = std::filesystem::absolute(settings.config.file).parent_path().string();
        return std::make_unique<cia402::CanDrive>(
            cia402::OpenCan(settings.device, folder), static_cast<uint8_t>(node),
            settings.device + " node " + std::to_string(node), settings.clock, settings.drives);
      });
}
