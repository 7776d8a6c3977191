// A CANopen drive with the profile CiA 402 as a device, over a CAN socket.
#pragma once

#include <string>

#include "frames.h"
#include "plant/driver/device.h"

namespace cia402 {

// A socket for the CAN interface `name`, e.g. "can0", or to a program that stands for the bus, "unix:PATH".
// Throws DeviceError.
int OpenCan(const std::string& name, const std::string& folder);

class CanDrive : public hydro::plant::Device {
 public:
  // `socket`: frames go and come through it, a struct can_frame each; it is closed at the end. Starts the
  // node and sets torque mode. Throws DeviceError when it does not answer.
  CanDrive(int socket, uint8_t node, std::string name, const hydro::bus::Clock& clock, bool drives);
  ~CanDrive() override;

  hydro::plant::DeviceDescription Describe() const override;
  void Read(hydro::plant::DeviceReadings& readings) override;
  // Also leads the drive to "operation enabled", step by step; until it is, its target is zero torque.
  void Drive(double output) override;
  bool Zero(double output) noexcept override;
  double ReadBack() noexcept override;

 private:
  bool Send(const can_frame& frame) const noexcept;
  void Receive() noexcept;
  void AwaitTorqueMode();

  int socket_;
  uint8_t node_;
  std::string name_;
  const hydro::bus::Clock& clock_;
  bool drives_;
  Said said_;
  unsigned ticks_ = 0;
  hydro::bus::Clock::TimePoint asked_{};  // the newest SYNC: the drive measures then
  hydro::bus::Clock::TimePoint motion_at_{}, inputs12_at_{}, input3_at_{};
};

}  // namespace cia402
