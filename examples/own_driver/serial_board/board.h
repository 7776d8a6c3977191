// A microcontroller on a serial port, whose sketch speaks lines of text, as a device.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "lines.h"
#include "plant/driver/device.h"

namespace serial_board {

// What termios calls this rate (B115200); none where Linux has no such rate, or this example no need of it.
std::optional<unsigned> RateOf(int baud);
std::string AllowedRates();

// A port for raw bytes that is ours alone; -1 where it cannot be opened: errno says why, `todo` what is
// needed.
int OpenPort(const std::string& path, unsigned rate, std::string* todo);

class SerialBoard : public hydro::plant::Device {
 public:
  // `port` is closed at the end. Throws DeviceError when the board does not answer within `patience`.
  SerialBoard(int port, std::string name, const hydro::bus::Clock& clock, bool drives,
              std::chrono::milliseconds patience);
  ~SerialBoard() override;

  hydro::plant::DeviceDescription Describe() const override;
  void Read(hydro::plant::DeviceReadings& readings) override;
  void Drive(double output) override;
  bool Zero(double output) noexcept override;
  double ReadBack() noexcept override;

 private:
  void Ask();
  bool Send(double volts) noexcept;
  bool Receive() noexcept;  // takes all that has come; returns whether an answer has
  bool Take(char c) noexcept;
  bool Wait(std::chrono::milliseconds patience) const noexcept;
  double Output() const noexcept;  // V, as the board measures it

  int port_;
  std::string name_;
  const hydro::bus::Clock& clock_;
  bool drives_;
  double output_ = 0;  // V, put out
  char line_[64];      // of the answer, as far as it has come
  size_t length_ = 0;
  Answer answer_;
  int unanswered_ = 0;                                 // commands
  hydro::bus::Clock::TimePoint asked_{}, measured_{};  // the newest command; the answer's
};

}  // namespace serial_board
