#include "tune/live/tuning_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <hydro/process_status_t.hpp>
#include <hydro/state_t.hpp>
#include <hydro/stop_t.hpp>

#include "bus/in_process_bus.h"

namespace hydro::tuning {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr int64_t kPlant = 11, kNextPlant = 12, kLoop = 21;

class TuningClientTest : public ::testing::Test {
 protected:
  void State(int64_t session) {
    state_t state{};
    state.session = session;
    bus_.Publish("HYDRO_STATE", state);
    Handle();
  }
  void Stop(int64_t addressee, const std::string& source, const std::string& reason) {
    stop_t stop{};
    stop.addressee = addressee;
    stop.source = source;
    stop.reason = reason;
    bus_.Publish("HYDRO_STOP", stop);
    Handle();
  }
  void Left(int64_t session, const std::string& role, const std::string& text) {
    process_status_t status{};
    status.session = session;
    status.role = role;
    status.state = process_status_t::DONE;
    status.text = text;
    bus_.Publish("HYDRO_PROCESS_STATUS", status);
    Handle();
  }
  void Handle() {
    clock_.AdvanceTo(clock_.Now() + 1ms);
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
  }

  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  TuningClient client_{bus_, clock_, bus::Channels(), "test"};
};

// Tests that a run's end is heard from a stop for its plant or for all, and from a plant that leaves; and not
// from what ends another process.
TEST_F(TuningClientTest, HearsTheEnd) {
  State(kPlant);
  Stop(kLoop, "launch", "another process");
  Left(kLoop, "pressure_ctrl", "the loop has left");
  EXPECT_EQ(client_.ending(), "");
  Stop(kPlant, "launch", "Ctrl-C");
  EXPECT_EQ(client_.ending(), "launch: Ctrl-C");
  State(kPlant);
  EXPECT_EQ(client_.ending(), "launch: Ctrl-C") << "its last states are no new run";
  State(kNextPlant);
  EXPECT_EQ(client_.ending(), "") << "started again";
  Left(kNextPlant, "driver", "the run is complete");
  EXPECT_EQ(client_.ending(), "driver: the run is complete");
}

// Tests one who comes when the stop has already been sent: the states that still come belong to that run.
TEST_F(TuningClientTest, ComesDuringTheStop) {
  for (const int64_t addressee : {int64_t{0}, kPlant}) {
    TuningClient late(bus_, clock_, bus::Channels(), "late");
    Stop(addressee, "", " \t");
    EXPECT_EQ(late.ending(), "an unnamed process: no reason is given");
    State(kPlant);
    EXPECT_NE(late.ending(), "");
    State(kNextPlant);
    EXPECT_EQ(late.ending(), "");
  }
}

// Tests that a request that is open when the stack stops is refused at once, with that reason.
TEST_F(TuningClientTest, RefusesAtTheEnd) {
  State(kPlant);
  tuned_settings_t in_force{};
  in_force.session = kPlant;
  in_force.stage = tuned_settings_t::IN_FORCE;
  bus_.Publish("HYDRO_SETTINGS", in_force);
  Handle();
  client_.Set("position.c2 = 900");
  client_.Poll();
  EXPECT_FALSE(client_.TakeAnswer());
  Stop(kPlant, "page", "STOP");
  client_.Poll();
  const auto answer = client_.TakeAnswer();
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->accepted);
  EXPECT_THAT(answer->text, HasSubstr("the stack stops (page: STOP) before it has answered"));
}

}  // namespace
}  // namespace hydro::tuning
