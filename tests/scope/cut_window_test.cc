#include "scope/signals/cut_window.h"

#include <gtest/gtest.h>

#include <map>

#include "scope/signals/message_store.h"
#include "tests/scope/recorded_run.h"

namespace hydro::scope {
namespace {

// Tests that a cut has the states of its window and the answers to them, described, and nothing else.
TEST(CutWindowTest, KeepsTheWindow) {
  MessageStore store(64 << 20);
  for (const RecordedMessage& message : Record(DemoConfig({"time.mode=lockstep", "time.duration_s=2"}))) {
    store.Add({message.channel, message.data.data(), message.data.size(), message.utime}, 0);
  }
  int64_t session = 0;
  store.Take().ForEach([&](const MessageStore::Message& message) {
    state_t state;
    if (message.channel == "HYDRO_STATE" && state.decode(message.data, 0, static_cast<int>(message.size)) > 0)
      session = state.session;
  });
  CutWindow window("", session, 0.5, 0.75);
  std::map<std::string, int> kept;
  store.Take().ForEach([&](const MessageStore::Message& message) {
    if (window.Keeps(message.channel, message.data, static_cast<int>(message.size)))
      ++kept[std::string(message.channel)];
  });
  EXPECT_EQ(window.states(), 251);
  EXPECT_EQ(kept["HYDRO_STATE"], 251);
  EXPECT_EQ(kept["HYDRO_MOTOR_COMMAND"], 251);
  EXPECT_EQ(kept["HYDRO_PRESSURE_COMMAND"], 51);
  EXPECT_EQ(kept["HYDRO_ARM_REFERENCE"], 51);
  EXPECT_EQ(kept["HYDRO_RUN"], 1);
}

// Tests that another plant's states, and channels of another stack, are left out.
TEST(CutWindowTest, LeavesOthersOut) {
  CutWindow window("", 5, 0, 1);
  state_t state{};
  state.session = 5;
  const auto keeps = [&](const std::string& channel) {
    const RecordedMessage message = Encoded(channel, state, 0);
    return window.Keeps(message.channel, message.data.data(), static_cast<int>(message.data.size()));
  };
  EXPECT_TRUE(keeps("HYDRO_STATE"));
  EXPECT_FALSE(keeps("HYDRO_STATE_2"));
  EXPECT_FALSE(keeps("CAMERA"));
  state.session = 6;
  EXPECT_FALSE(keeps("HYDRO_STATE"));
}

// Tests that a store is bounded, keeps the newest, and that a snapshot stays what it was.
TEST(MessageStoreTest, IsBounded) {
  MessageStore store(4 << 20);
  const std::vector<uint8_t> data(1000, 1);
  const auto count = [](const MessageStore::Snapshot& snapshot) {
    std::pair<int, int64_t> result;
    snapshot.ForEach([&](const MessageStore::Message& message) {
      ++result.first;
      result.second = message.utime;
    });
    return result;
  };
  for (int64_t i = 0; i < 1000; ++i)
    store.Add({"CHANNEL", data.data(), data.size(), i}, static_cast<double>(i));
  const auto snapshot = store.Take();
  EXPECT_EQ(count(snapshot), std::pair(1000, int64_t{999}));
  for (int64_t i = 1000; i < 100000; ++i)
    store.Add({"CHANNEL", data.data(), data.size(), i}, static_cast<double>(i));
  EXPECT_LE(store.memory(), size_t{5} << 20);
  EXPECT_EQ(count(store.Take()).second, 99999);
  EXPECT_EQ(count(snapshot), std::pair(1000, int64_t{999}));
  store.DropBefore(1e9);
  EXPECT_EQ(store.memory(), size_t{1} << 20);
}

}  // namespace
}  // namespace hydro::scope
