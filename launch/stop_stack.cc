#include "launch/stop_stack.h"

#include "launch/local_stop.h"
#include "launch/logic/operator_request.h"
#include "process/stack_bus.h"

namespace hydro::launch {

OperatorResult StopStack(const settings::StackConfig& config, const Asker& asker,
                         const OperatorTiming& timing) {
  LocalStop local(config, asker);
  local.StopMotor();
  OperatorResult result{1, ""};
  std::string remark;
  try {
    const auto bus = process::OpenStackBus(config.bus);
    result = StopOverBus(*bus, bus::WallClock(), config, local, timing, asker);
  } catch (const bus::BusError& error) {
    if (local.found() == 0) throw;
    remark = std::string(" (over their local sockets: ") + error.what() + ")";
  }
  if (result.exit_code == 0 || local.found() == 0) return result;
  local.StopRest(timing.end);
  const std::string left = local.Left();
  if (!left.empty()) return {1, "has not ended: " + left};
  return {0, Stopped(static_cast<size_t>(local.found())) + remark};
}

}  // namespace hydro::launch
