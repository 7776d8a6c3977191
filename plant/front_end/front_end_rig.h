// A real actuator behind a front end: the device samples and drives, and is the last line of safety
// (docs/front_end.md).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/clock.h"
#include "plant/front_end/connection.h"
#include "plant/front_end/output_watch.h"
#include "plant/front_end/sample_watch.h"
#include "plant/rig.h"
#include "pressure_ctrl/pressure_app.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// Extends a count that the device wraps modulo 2^32 to one that never wraps.
class DeviceCount {
 public:
  int64_t Update(int32_t count) {
    if (!known_) unwrapped_ = count;
    unwrapped_ += static_cast<int32_t>(static_cast<uint32_t>(count) - static_cast<uint32_t>(unwrapped_));
    known_ = true;
    return unwrapped_;
  }
  void Forget() { known_ = false; }

 private:
  bool known_ = false;
  int64_t unwrapped_ = 0;
};

class FrontEndRig : public Rig, public Pacemaker, public pressure_ctrl::DeviceLoop {
 public:
  // `config` has a [driver] of kind "front_end". By default, `link` is the configuration's and `session` is
  // random; tests pass their own.
  FrontEndRig(const settings::StackConfig& config, const bus::Clock& clock);
  FrontEndRig(const settings::StackConfig& config, const bus::Clock& clock, std::unique_ptr<Link> link,
              uint32_t session);
  // Puts out zero volts and reports what became of the frames.
  ~FrontEndRig() override;

  // Opens the link and waits until the device holds its settings and sends samples, for time.start_timeout_s
  // at most or until a stop signal comes. Throws InputError when there is no such device, it is the wrong
  // one, or another program has it.
  void Connect();

  // Takes one turn of the handshake. Returns whether the handshake is done.
  bool Poll();

  // Sets what else this process does; it is called in each tick, and while the run has not begun.
  void set_beside(std::function<void()> beside) { beside_ = std::move(beside); }

  std::string role() const override { return "driver"; }
  // The newest sample.
  model::Measurement Read(int64_t tick) override;
  // "device_silent", "device_fault", "output_differs", "sensor_NAME". Faults that tripped the device are
  // listed in at least one reading.
  const std::vector<RigFault>& faults() const override { return faults_; }
  void Attend() override;
  void Obey(int64_t command_tick) override { command_tick_ = command_tick; }
  // Arms the device with the first command that is obeyed. Returns what the device reports: the voltage that
  // acts from the sample of the last Read() on, until the device takes the new one.
  double Drive(double voltage) override;
  int64_t lost_messages() const override { return connection_.counts().lost; }

  Pacemaker* pacemaker() override { return this; }
  std::optional<int64_t> Arrived() override;
  int descriptor() const override { return connection_.link().descriptor(); }
  int64_t acting_command_tick() const override { return acting_command_tick_; }

  // With the pressure loop on the device (driver.mode = "loop_on_device"), sends the reference at once, and
  // again in each Drive().
  Answer Follow(const state_t& state, double pressure_ref,
                const pressure_ctrl::PressureLawSettings& law) override;
  void Release() override { followed_.reset(); }

  // Asks for zero volts, and waits for up to half a second until the device reports that its output is at
  // zero.
  OutputLeft Zero() noexcept override;
  // Sends the same request once and waits for nothing. Async-signal-safe.
  void ZeroAtOnce() const noexcept { connection_.Zero(); }

  // The same, and returns when the frame has left this machine. Async-signal-safe.
  void ZeroAndDrain() const noexcept {
    connection_.Zero();
    connection_.link().AwaitGone();
  }

  const Connection& connection() const { return connection_; }
  std::string Describe() const;  // "serial:/dev/ttyACM0 (posix, firmware 1.0.0, 5000 ticks/s)"

 protected:
  // Called before and after each turn: the link's descriptor, -1 while it is cut. Between two calls it is not
  // closed and opened again.
  virtual void OnLink(int /*descriptor*/) {}

 private:
  struct Followed {
    float pressure_ref = 0;
    hydro_gains gains{};
    bool sent = false;  // since the last Drive()
  };

  void CheckSpeed() const;
  bool MayDrive() const { return command_tick_ >= 0 && faults_.empty(); }
  bool Armed() const { return connection_.is_up() && read_.state == HYDRO_ARMED; }
  void AskForZero();
  bool Disregards(bool commanded);
  hydro_voltage_range Range() const;
  void SendVoltage(double voltage);
  void SendFollowed();
  model::Measurement Measured();
  bool FindSilence();
  void TakeTurn();
  void FindSensorFaults(const hydro_sample& sample);
  void HoldSensorFault(int sensor, size_t faults_before);
  void FindContradictions();
  void FindJumps();
  void ForgetDevice();
  void FindDeviceFaults(const hydro_sample& sample);
  void FindUnaskedArming(const hydro_sample& sample);
  void FindOldCommands(const hydro_sample& sample);
  void Add(std::string code, std::string text, double value = NAN, double limit = NAN);

  const settings::StackConfig config_;
  const bus::Clock& clock_;
  Connection connection_;
  const bus::Clock::Duration stale_time_;
  const double ticks_per_s_;
  const double voltage_limit_;  // V, +/-
  OutputWatch output_;
  const SensorEnds ends_;
  SampleWatch watch_;
  std::vector<RigFault> faults_;
  std::function<void()> beside_;

  int64_t tick_ = 0;
  bus::Clock::TimePoint now_{};
  int64_t command_tick_ = -1;         // of the command that Drive() puts out; -1: zero
  int64_t acting_command_tick_ = -1;  // of what the device puts out
  hydro_sample read_{};               // of the last Read(); the connection may have a newer one
  bool polled_ = false;               // since the last Read()
  int64_t arrived_before_ = 0;        // number of samples, at the last Arrived()
  std::optional<Followed> followed_;
  std::optional<int64_t> driving_since_;  // tick of the first command since the device was last armed
  std::optional<bus::Clock::TimePoint> arming_since_;
  std::optional<bus::Clock::TimePoint> asked_to_arm_at_;  // of late; while it is armed, when that was
  bool asked_for_zero_ = false;                           // since it was last asked to arm
  std::optional<int64_t> zero_since_;  // tick of the first command of zero since the last of volts
  std::optional<uint32_t> trips_;      // of the device, at the last reading
  int64_t resets_ = 0, jumps_ = 0;     // at the last reading
  bool has_read_back_ = false;         // a sample has said what the output holds
  // A sensor's newest fault, and its good readings in a row since; it ends with kGoodReadings of them.
  struct SensorFault {
    std::optional<RigFault> fault;
    int good_readings = 0;
  };
  std::array<SensorFault, HYDRO_SENSORS> sensor_faults_ = {};
  DeviceCount motor_count_, arm_count_;
};

}  // namespace hydro::plant
