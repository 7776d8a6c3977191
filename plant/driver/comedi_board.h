// A data-acquisition board behind Comedi: the few functions that a rig needs, with errors that say what is
// wrong.
#pragma once

#include <comedilib.h>

#include <cstdint>
#include <string>

#include "plant/driver/signal_conditioning.h"
#include "settings/driver_section.h"

namespace hydro::plant {

// One channel of the board, which was checked to exist.
struct BoardChannel {
  std::string key;  // configuration key, e.g. driver.p1; for errors
  unsigned subdevice = 0;
  unsigned channel = 0;
  unsigned range = 0;
  unsigned reference = 0;
  ConverterRange converter;  // a counter or a digital line has only max_code
};

class ComediBoard {
 public:
  // `file` is the configuration file, for errors. Throws InputError when the device cannot be opened.
  ComediBoard(const std::string& file, const std::string& device, int settle_ns);
  ~ComediBoard();
  ComediBoard(const ComediBoard&) = delete;
  ComediBoard& operator=(const ComediBoard&) = delete;

  // These check that the board has such a channel, and throw an InputError that names `key` when it does not.
  // DigitalOutput() also configures a bidirectional line as an output.
  BoardChannel AnalogInput(const std::string& key, const settings::SensorSection& section);
  BoardChannel Counter(const std::string& key, const settings::BoardLine& line);
  BoardChannel AnalogOutput(const std::string& key, const settings::AmplifierSection& section);
  BoardChannel DigitalOutput(const std::string& key, const settings::BoardLine& line);

  // An analog input's code or a counter's count. Throws RigError "board_error".
  uint32_t Read(const BoardChannel& channel);
  // These throw RigError "board_error".
  void Write(const BoardChannel& output, uint32_t code);
  void WriteLine(const BoardChannel& line, bool high);

  comedi_t* device() const { return device_; }
  const std::string& name() const { return name_; }  // "/dev/comedi0 (pci-6221)"

 private:
  BoardChannel Channel(const std::string& key, const settings::BoardLine& line,
                       std::initializer_list<int> types, const char* what);
  void AddRange(BoardChannel* channel, int range, settings::AnalogReference reference);

  std::string file_;
  std::string name_;
  unsigned settle_ns_;
  comedi_t* device_;
};

}  // namespace hydro::plant
