#include "plant/driver/comedi_device.h"

#include <comedilib.h>
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <utility>

namespace hydro::plant {
namespace {

using Source = settings::SensorSection::Source;
constexpr int kReadTries = 10;

bool IsAnalog(const BoardChannel& channel) {
  return channel.converter.minimum_V < channel.converter.maximum_V;
}

}  // namespace

ComediDevice::ComediDevice(const settings::StackConfig& config, const bus::Clock& clock, bool drives)
    : clock_(clock), board_(config.file, config.driver->device, config.driver->settle_ns) {
  const settings::DriverSection& driver = *config.driver;
  if (drives) output_ = board_.AnalogOutput("driver.voltage", driver.voltage);
  AddInput("p1", driver.p1);
  AddInput("p2", driver.p2);
  AddInput("motor_angle", driver.motor_angle);
  AddInput("motor_speed", driver.motor_speed);
  AddInput("arm_angle", driver.arm_angle);
  AddInput("arm_speed", driver.arm_speed);
  if (drives && driver.watchdog) watchdog_ = board_.DigitalOutput("driver.watchdog", *driver.watchdog);
}

void ComediDevice::AddInput(const char* name, const settings::SensorSection& section) {
  const bool analog = section.source == Source::kAnalog;
  if (!analog && section.source != Source::kCounter) return;
  const std::string key = std::string("driver.") + name;
  const BoardChannel channel = analog ? board_.AnalogInput(key, section) : board_.Counter(key, section.line);
  DeviceInput input;
  input.name = name;
  input.place = fmt::format("{} {}/{}", analog ? "analog" : "counter", channel.subdevice, channel.channel);
  if (analog) {
    input.low = channel.converter.Volts(0);
    input.high = channel.converter.Volts(channel.converter.max_code);
  } else {
    input.kind = DeviceInput::Kind::kCount;
    input.highest_count = channel.converter.max_code;
  }
  inputs_.push_back(channel);
  described_.push_back(std::move(input));
}

DeviceDescription ComediDevice::Describe() const {
  DeviceDescription description{
      .name = board_.name(), .inputs = described_, .files = {comedi_fileno(board_.device())}};
  if (output_) {
    description.output.low = output_->converter.minimum_V;
    description.output.high = output_->converter.maximum_V;
  }
  return description;
}

void ComediDevice::Read(DeviceReadings& readings) {
  for (size_t i = 0; i < inputs_.size(); ++i) {
    Reading& reading = readings.inputs[i];
    reading.at = clock_.Now();
    const uint32_t code = board_.Read(inputs_[i]);
    reading.raw = code;
    reading.value = IsAnalog(inputs_[i]) ? inputs_[i].converter.Volts(code) : code;
  }
}

void ComediDevice::Drive(double output) {
  board_.Write(*output_, output_->converter.Code(output));
  if (!watchdog_) return;
  watchdog_high_ = !watchdog_high_;
  board_.WriteLine(*watchdog_, watchdog_high_);
}

bool ComediDevice::Zero(double output) noexcept {
  const BoardChannel& channel = *output_;
  const bool taken = comedi_data_write(board_.device(), channel.subdevice, channel.channel, channel.range,
                                       channel.reference, channel.converter.Code(output)) >= 0;
  if (watchdog_) comedi_dio_write(board_.device(), watchdog_->subdevice, watchdog_->channel, 0);
  return taken;
}

double ComediDevice::ReadBack() noexcept {
  lsampl_t code = 0;
  const BoardChannel& channel = *output_;
  for (int i = 0; i < kReadTries; ++i) {
    if (comedi_data_read(board_.device(), channel.subdevice, channel.channel, channel.range,
                         channel.reference, &code) >= 0)
      return channel.converter.Volts(code);
  }
  return NAN;
}

}  // namespace hydro::plant
