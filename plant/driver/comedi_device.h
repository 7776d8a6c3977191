// A data-acquisition board as a Device: the channels that [driver] names become inputs with the names of the
// signals.
#pragma once

#include <optional>
#include <vector>

#include "bus/clock.h"
#include "plant/driver/comedi_board.h"
#include "plant/driver/device.h"

namespace hydro::plant {

class ComediDevice : public Device {
 public:
  // Opens the board and checks the channels that the configuration names; with `drives`, it also checks those
  // that are written. Throws InputError when the board lacks a channel that the configuration names.
  ComediDevice(const settings::StackConfig& config, const bus::Clock& clock, bool drives);

  DeviceDescription Describe() const override;
  // Reads the clock right beside the board, channel by channel.
  void Read(DeviceReadings& readings) override;
  // Toggles the watchdog line once the board has accepted the output.
  void Drive(double output) override;
  // In libcomedi 0.11 comedi_data_write and comedi_dio_write fill a struct on the stack and make one ioctl;
  // an error is stored in a global int (and printed only at a log level that this project never sets).
  bool Zero(double output) noexcept override;
  double ReadBack() noexcept override;

 private:
  void AddInput(const char* name, const settings::SensorSection& section);

  const bus::Clock& clock_;
  ComediBoard board_;
  std::vector<BoardChannel> inputs_;
  std::vector<DeviceInput> described_;
  std::optional<BoardChannel> output_;
  std::optional<BoardChannel> watchdog_;
  bool watchdog_high_ = false;
};

}  // namespace hydro::plant
