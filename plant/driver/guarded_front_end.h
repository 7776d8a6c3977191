// A front end as hydro-driver uses it: with zero volts on every way out of the process, and with the pressure
// loop of a device that runs one.
#pragma once

#include <functional>

#include "bus/bus.h"
#include "plant/driver/device.h"
#include "plant/front_end/front_end_rig.h"

namespace hydro::plant {

// Connects to the device. From then on, each way out of this process in which the process can still act first
// asks the device for zero volts (zero_output.h). After any other way out, the device hears nothing and goes
// to zero volts by itself (driver.watchdog_s).
class GuardedFrontEnd : public FrontEndRig {
 public:
  // Throws InputError like FrontEndRig::Connect().
  GuardedFrontEnd(const settings::StackConfig& config, const bus::Clock& clock);
  ~GuardedFrontEnd() override;

 private:
  // Implements as much of a Device as zero_output.h needs.
  class ZeroRequest : public Device {
   public:
    explicit ZeroRequest(const FrontEndRig& rig) : rig_(rig) {}
    DeviceDescription Describe() const override { return {}; }
    void Read(DeviceReadings&) override {}
    void Drive(double) override {}
    bool Zero(double) noexcept override {
      rig_.ZeroAtOnce();
      return true;
    }

   private:
    const FrontEndRig& rig_;
  };

  ZeroRequest zero_{*this};
};

// With driver.mode = "loop_on_device" this process is also the stack's pressure loop: it leads the loop on
// the device. Returns the function that ends it, or nothing in other stacks.
std::function<void()> LeadLoopOnDevice(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                                       Rig& rig);

}  // namespace hydro::plant
