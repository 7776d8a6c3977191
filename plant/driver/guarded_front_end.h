// A front end as hydro-driver uses it: with zero volts on every way out of the process, and with the pressure
// loop of a device that runs one.
#pragma once

#include <functional>
#include <memory>

#include "bus/bus.h"
#include "plant/driver/device.h"
#include "plant/driver/zero_guardian.h"
#include "plant/front_end/front_end_rig.h"

namespace hydro::plant {

// Connects to the device. From then on, each way out of this process in which the process can still act first
// asks the device for zero volts. After any other way out its guardian, which shares the open link, asks for
// them (zero_guardian.h). If that fails too, the device hears nothing and goes to zero volts by itself
// (driver.watchdog_s).
class GuardedFrontEnd : public FrontEndRig {
 public:
  // Throws InputError like FrontEndRig::Connect().
  GuardedFrontEnd(const settings::StackConfig& config, const bus::Clock& clock);
  ~GuardedFrontEnd() override;

  double Drive(double voltage) override;

 private:
  void OnLink(int descriptor) override;

  // The rig as far as zero_guardian.h needs one.
  class ZeroRequest : public Device {
   public:
    ZeroRequest(const FrontEndRig& rig, bool drains) : rig_(rig), drains_(drains) {}
    DeviceDescription Describe() const override { return {}; }
    void Read(DeviceReadings&) override {}
    void Drive(double) override {}
    bool Zero(double) noexcept override {
      drains_ ? rig_.ZeroAndDrain() : rig_.ZeroAtOnce();
      return true;
    }

   private:
    const FrontEndRig& rig_;
    const bool drains_;
  };

  ZeroRequest zero_{*this, false}, guardians_zero_{*this, true};
  std::unique_ptr<ZeroGuardian> guardian_;  // while the link is open, once the device was up
  int guarded_ = -1;                        // its descriptor
};

// With driver.mode = "loop_on_device" this process is also the stack's pressure loop: it leads the loop on
// the device. Returns the function that ends it, or nothing in other stacks.
std::function<void()> LeadLoopOnDevice(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                                       Rig& rig);

}  // namespace hydro::plant
