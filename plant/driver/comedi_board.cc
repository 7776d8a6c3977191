#include "plant/driver/comedi_board.h"

#include <algorithm>
#include <cerrno>

#include "plant/rig.h"
#include "settings/toml/section_reader.h"

namespace hydro::plant {
namespace {

// A caught signal may interrupt the kernel driver's wait for a conversion, which is no error of the board.
template <class Call>
int Uninterrupted(const Call& call) {
  constexpr int kTries = 10;
  for (int i = 1;; ++i) {
    const int result = call();
    if (result >= 0 || comedi_errno() != EINTR || i == kTries) return result;
  }
}

std::string LastError() { return comedi_strerror(comedi_errno()); }

RigError BoardError(const BoardChannel& channel, const char* what, const std::string& name) {
  return RigError("board_error", channel.key + ": " + what + " subdevice " +
                                     std::to_string(channel.subdevice) + ", channel " +
                                     std::to_string(channel.channel) + " of " + name +
                                     " failed: " + LastError());
}

std::string UpTo(int count) { return count == 1 ? "0" : "0 to " + std::to_string(count - 1); }

unsigned Aref(settings::AnalogReference reference) {
  switch (reference) {
    case settings::AnalogReference::kGround:
      return AREF_GROUND;
    case settings::AnalogReference::kCommon:
      return AREF_COMMON;
    case settings::AnalogReference::kDifferential:
      return AREF_DIFF;
    case settings::AnalogReference::kOther:
      break;
  }
  return AREF_OTHER;
}

}  // namespace

ComediBoard::ComediBoard(const std::string& file, const std::string& device, int settle_ns)
    : file_(file),
      name_(device),
      settle_ns_(static_cast<unsigned>(settle_ns)),
      device_(comedi_open(device.c_str())) {
  if (device_ == nullptr) {
    const int error = comedi_errno();
    std::string allowed = "a Comedi device that can be opened; comedi_board_info lists what a board has";
    if (error == EACCES) allowed += ", and the group of the device file may use it";
    throw settings::KeyError(file_, "driver.device", Quoted(device) + " (" + comedi_strerror(error) + ")",
                             allowed);
  }
  if (const char* board = comedi_get_board_name(device_)) name_ += std::string(" (") + board + ")";
}

ComediBoard::~ComediBoard() { comedi_close(device_); }

BoardChannel ComediBoard::Channel(const std::string& key, const settings::BoardLine& line,
                                  std::initializer_list<int> types, const char* what) {
  BoardChannel channel;
  channel.key = key;
  channel.subdevice = static_cast<unsigned>(line.subdevice);
  channel.channel = static_cast<unsigned>(line.channel);
  const int subdevices = comedi_get_n_subdevices(device_);
  const bool there = line.subdevice < subdevices;
  const int type = there ? comedi_get_subdevice_type(device_, channel.subdevice) : -1;
  if (std::find(types.begin(), types.end(), type) == types.end()) {
    throw settings::KeyError(file_, key + ".subdevice", std::to_string(line.subdevice),
                             std::string("a subdevice of ") + name_ + " (0 to " +
                                 std::to_string(subdevices - 1) + ") that is " + what +
                                 "; comedi_board_info lists them");
  }
  const int channels = comedi_get_n_channels(device_, channel.subdevice);
  if (line.channel >= channels) {
    throw settings::KeyError(
        file_, key + ".channel", std::to_string(line.channel),
        UpTo(channels) + " (subdevice " + std::to_string(line.subdevice) + " of " + name_ + ")");
  }
  channel.converter.max_code = comedi_get_maxdata(device_, channel.subdevice, channel.channel);
  if (channel.converter.max_code == 0) {
    throw settings::KeyError(file_, key + ".channel", std::to_string(line.channel),
                             "a channel whose resolution " + name_ + " reports");
  }
  return channel;
}

void ComediBoard::AddRange(BoardChannel* channel, int range, settings::AnalogReference reference) {
  const int ranges = comedi_get_n_ranges(device_, channel->subdevice, channel->channel);
  const comedi_range* found = range < ranges ? comedi_get_range(device_, channel->subdevice, channel->channel,
                                                                static_cast<unsigned>(range))
                                             : nullptr;
  if (found == nullptr || !(found->min < found->max)) {
    throw settings::KeyError(file_, channel->key + ".range", std::to_string(range),
                             UpTo(ranges) + "; comedi_board_info lists what they are in V");
  }
  channel->range = static_cast<unsigned>(range);
  channel->reference = Aref(reference);
  channel->converter.minimum_V = found->min;
  channel->converter.maximum_V = found->max;
}

BoardChannel ComediBoard::AnalogInput(const std::string& key, const settings::SensorSection& section) {
  BoardChannel channel = Channel(key, section.line, {COMEDI_SUBD_AI}, "an analog input");
  AddRange(&channel, section.range, section.reference);
  return channel;
}

BoardChannel ComediBoard::Counter(const std::string& key, const settings::BoardLine& line) {
  return Channel(key, line, {COMEDI_SUBD_COUNTER}, "a counter");
}

BoardChannel ComediBoard::AnalogOutput(const std::string& key, const settings::AmplifierSection& section) {
  BoardChannel channel = Channel(key, section.line, {COMEDI_SUBD_AO}, "an analog output");
  AddRange(&channel, section.range, section.reference);
  return channel;
}

BoardChannel ComediBoard::DigitalOutput(const std::string& key, const settings::BoardLine& line) {
  BoardChannel channel = Channel(key, line, {COMEDI_SUBD_DO, COMEDI_SUBD_DIO}, "a digital output");
  if (comedi_get_subdevice_type(device_, channel.subdevice) == COMEDI_SUBD_DIO &&
      comedi_dio_config(device_, channel.subdevice, channel.channel, COMEDI_OUTPUT) < 0) {
    throw settings::KeyError(file_, key + ".channel", std::to_string(line.channel) + " (" + LastError() + ")",
                             "a line that can be configured as an output");
  }
  return channel;
}

uint32_t ComediBoard::Read(const BoardChannel& channel) {
  lsampl_t code = 0;
  const bool analog = channel.converter.minimum_V < channel.converter.maximum_V;
  const int result = Uninterrupted([&] {
    // The delayed form reads twice with a pause in between, for multiplexed inputs that need time to settle.
    return analog && settle_ns_ > 0
               ? comedi_data_read_delayed(device_, channel.subdevice, channel.channel, channel.range,
                                          channel.reference, &code, settle_ns_)
               : comedi_data_read(device_, channel.subdevice, channel.channel, channel.range,
                                  channel.reference, &code);
  });
  if (result < 0) throw BoardError(channel, "reading", name_);
  return code;
}

void ComediBoard::Write(const BoardChannel& output, uint32_t code) {
  const int result = Uninterrupted([&] {
    return comedi_data_write(device_, output.subdevice, output.channel, output.range, output.reference, code);
  });
  if (result < 0) throw BoardError(output, "writing", name_);
}

void ComediBoard::WriteLine(const BoardChannel& line, bool high) {
  const int result =
      Uninterrupted([&] { return comedi_dio_write(device_, line.subdevice, line.channel, high ? 1 : 0); });
  if (result < 0) throw BoardError(line, "writing", name_);
}

}  // namespace hydro::plant
