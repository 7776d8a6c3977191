// Bare LCM: handle() in a loop, as in its tutorial, with the stack's own message types.
#include <hydro/motor_command_t.hpp>
#include <hydro/state_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "bench/echo_peers.h"
#include "tests/free_udp_port.h"

namespace hydro {
namespace {

const std::string kState = "HYDRO_STATE";
const std::string kCommand = "HYDRO_MOTOR_COMMAND";

class Echo {
 public:
  explicit Echo(const std::string& url) : lcm_(url) {
    lcm_.subscribe(kState, &Echo::OnState, this)->setQueueCapacity(0);
  }
  void Run() {
    while (lcm_.handle() == 0) {
    }
  }

 private:
  void OnState(const lcm::ReceiveBuffer*, const std::string&, const state_t* state) {
    motor_command_t command{};
    command.tick = state->tick;
    lcm_.publish(kCommand, &command);
  }
  lcm::LCM lcm_;
};

class LcmPinger : public Pinger {
 public:
  explicit LcmPinger(const std::string& url) : lcm_(url) {
    lcm_.subscribe(kCommand, &LcmPinger::OnCommand, this)->setQueueCapacity(0);
  }
  bool Trip(int64_t number) override {
    state_t state{};
    state.tick = number;
    lcm_.publish(kState, &state);
    while (answered_ != number) {
      if (lcm_.handleTimeout(1000) <= 0) return false;
    }
    return true;
  }

 private:
  void OnCommand(const lcm::ReceiveBuffer*, const std::string&, const motor_command_t* command) {
    answered_ = command->tick;
  }
  lcm::LCM lcm_;
  int64_t answered_ = -1;
};

}  // namespace

Peer LcmPeer() {
  const std::string url = FreeBusUrl();
  return {"bare LCM", [url] { Echo(url).Run(); }, [url] { return std::make_unique<LcmPinger>(url); }};
}

}  // namespace hydro
