#include "plant/driver/described_device.h"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <string_view>

#include "base/number_text.h"
#include "base/text_file.h"
#include "bus/output_left.h"

namespace hydro::plant {
namespace {

// A counter that wraps sooner loses its angle when it moves by one: that is a quarter of its range.
constexpr uint32_t kLeastHighestCount = 7;

// Such texts may be buffers of a device, with the NUL that ends them and with what stands behind it.
std::string Shown(std::string_view text) { return Printable(text.substr(0, text.find('\0'))); }

}  // namespace

DeviceError::DeviceError(const std::string& text)
    : RigError("board_error", bus::ReasonText(text, "the device's driver gives no reason")) {}

DeviceDescription Described(const Device& device, const std::string& file) {
  DeviceDescription description = device.Describe();
  const auto refuse = [&](const std::string& found, const std::string& allowed) {
    return settings::KeyError(file, "driver.device", found + ", as its driver describes it", allowed);
  };
  description.name = bus::ReasonText(Shown(description.name), "the device");
  DeviceOutput& output = description.output;
  output.unit = Shown(output.unit);
  // With an output that has no range, no limit would hold.
  if (!(output.low < output.high)) {
    throw refuse("an output from " + ShortestNumber(output.low) + " to " + ShortestNumber(output.high) + " " +
                     output.unit,
                 "one whose lower end is below its upper one (DeviceOutput::low, high)");
  }
  if (!(output.tolerance >= 0)) {
    throw refuse("an output with a tolerance of " + ShortestNumber(output.tolerance) + " " + output.unit,
                 "a number of at least 0 (DeviceOutput::tolerance)");
  }
  for (DeviceInput& input : description.inputs) {
    for (std::string* text : {&input.name, &input.unit, &input.place}) *text = Shown(*text);
    if (input.kind == DeviceInput::Kind::kCount && input.highest_count < kLeastHighestCount) {
      throw refuse(
          fmt::format("a counter {} that wraps after {}", Quoted(input.name), input.highest_count),
          fmt::format("one that counts to {} at least (DeviceInput::highest_count)", kLeastHighestCount));
    }
    if (input.kind == DeviceInput::Kind::kValue && !(input.low < input.high)) {
      throw refuse(fmt::format("an input {} from {} to {} {}", Quoted(input.name), ShortestNumber(input.low),
                               ShortestNumber(input.high), input.unit),
                   "one whose lower end is below its upper one (DeviceInput::low, high)");
    }
  }
  // Without an open file, the guardian could write no zero.
  for (const int each : description.files) {
    if (fcntl(each, F_GETFD) >= 0) continue;
    throw settings::KeyError(
        file, "driver.device",
        fmt::format("the descriptor {}, which is not open, among the files of {}", each, description.name),
        "those that its Zero() needs, opened before (DeviceDescription::files)");
  }
  return description;
}

void ReadDevice(Device& device, const DeviceDescription& description, DeviceReadings& readings) {
  device.Read(readings);
  readings.fault = Shown(readings.fault);
  const auto clip = [](Reading& reading) { reading.at = std::max(reading.at, bus::Clock::TimePoint{}); };
  std::for_each(readings.inputs.begin(), readings.inputs.end(), clip);
  clip(readings.output);
  const size_t given = readings.inputs.size(), described = description.inputs.size();
  if (given == described) return;
  readings.inputs.resize(described);
  throw DeviceError(
      fmt::format("{} gives {} readings; allowed are {}, one for each input that its driver describes",
                  description.name, given, described));
}

}  // namespace hydro::plant
