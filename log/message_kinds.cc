#include "log/message_kinds.h"

#include "bus/channels.h"
#include "hydro/arm_reference_t.hpp"
#include "hydro/fault_t.hpp"
#include "hydro/introduction_t.hpp"
#include "hydro/log_progress_t.hpp"
#include "hydro/loop_histogram_t.hpp"
#include "hydro/loop_statistics_t.hpp"
#include "hydro/motor_command_t.hpp"
#include "hydro/pressure_command_t.hpp"
#include "hydro/process_status_t.hpp"
#include "hydro/rearm_t.hpp"
#include "hydro/run_description_t.hpp"
#include "hydro/state_t.hpp"
#include "hydro/stop_t.hpp"

namespace hydro::log {
namespace {

template <class Message>
MessageKind Kind(const std::string& channel) {
  return {channel, std::string("hydro.") + Message::getTypeName(), Message::getHash(),
          [](const LogEvent& event) {
            Message message;
            return DecodeAs(event, message);
          }};
}

}  // namespace

const std::vector<MessageKind>& MessageKinds() {
  static const std::vector<MessageKind> kinds = [] {
    const bus::Channels channels;
    return std::vector<MessageKind>{Kind<state_t>(channels.state),
                                    Kind<motor_command_t>(channels.motor_command),
                                    Kind<pressure_command_t>(channels.pressure_command),
                                    Kind<arm_reference_t>(channels.arm_reference),
                                    Kind<run_description_t>(channels.run),
                                    Kind<loop_statistics_t>(channels.loop_statistics),
                                    Kind<loop_histogram_t>(channels.loop_histogram),
                                    Kind<fault_t>(channels.fault),
                                    Kind<stop_t>(channels.stop),
                                    Kind<rearm_t>(channels.rearm),
                                    Kind<process_status_t>(channels.process_status),
                                    Kind<log_progress_t>(channels.log_progress),
                                    Kind<introduction_t>(channels.introduction)};
  }();
  return kinds;
}

const MessageKind* KindOfChannel(std::string_view channel) {
  for (const MessageKind& kind : MessageKinds()) {
    if (channel.starts_with(kind.channel)) return &kind;
  }
  return nullptr;
}

}  // namespace hydro::log
