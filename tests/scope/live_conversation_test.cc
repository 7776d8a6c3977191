#include "scope/live_conversation.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/scope/decoded_bins.h"
#include "tests/scope/made_run.h"

namespace hydro::scope {
namespace {

using nlohmann::json;

class NoGhost : public GhostSwitch {
 public:
  Outcome Switch(uint32_t, bool, double) override { return {false, "no ghost", {}}; }
  Outcome Sync(uint32_t) override { return {false, "no ghost", {}}; }
};

class LiveConversationTest : public ::testing::Test {
 protected:
  LiveConversationTest() {
    auto& run = runs_.StartLive("test.toml", "", 100000, 1 << 20);
    run.rate_hz = 1000;
    for (int64_t tick = 0; tick <= 1000; ++tick) AddTick(&run, tick, static_cast<double>(tick));
  }
  std::unique_ptr<LiveConversation> Converse() {
    return std::make_unique<LiveConversation>(LiveContext{.runs = runs_,
                                                          .actions = actions_,
                                                          .ghost = ghost_,
                                                          .silent_s = [](uint32_t) { return 0.0; },
                                                          .now = [this] { return now_; },
                                                          .frames = &frames_,
                                                          .dropped = &dropped_});
  }
  // All that it has to say now.
  static std::vector<Conversation::Message> All(Conversation* conversation) {
    std::vector<Conversation::Message> messages;
    for (Conversation::Message message; conversation->Next(&message) && messages.size() < 10000;)
      messages.push_back(message);
    return messages;
  }
  static std::vector<json> Texts(Conversation* conversation) {
    std::vector<json> texts;
    for (const auto& message : All(conversation)) {
      if (!message.binary) texts.push_back(json::parse(message.bytes));
    }
    return texts;
  }
  static json Reply(Conversation* conversation, const std::string& request) {
    conversation->Hear(request, false);
    for (const json& text : Texts(conversation)) {
      if (text["op"] == "reply") return text;
    }
    return {};
  }

  RunTable runs_;
  OperatorActions actions_{nullptr, false, [](const std::function<void()>& work) { work(); }, {}};
  NoGhost ghost_;
  std::chrono::steady_clock::time_point now_{};
  int64_t frames_ = 0;
  int64_t dropped_ = 0;
};

// Tests that it begins with what there is, and all events so far.
TEST_F(LiveConversationTest, Greets) {
  for (int i = 0; i < 500; ++i) runs_.live()->events.Add({0, 0.1, "fault", "plant", "code", "text"});
  const auto conversation = Converse();
  const auto texts = Texts(conversation.get());
  EXPECT_EQ(texts[0]["op"], "hello");
  EXPECT_EQ(texts[0]["control"], false);
  EXPECT_EQ(texts[0]["runs"][0]["kind"], "live");
  EXPECT_EQ(texts[0]["runs"][0]["last"], 1.0);
  for (int i = 1; i <= 500; ++i) EXPECT_EQ(texts[static_cast<size_t>(i)]["n"], i);
  runs_.live()->events.Add({0, 0.2, "fault", "", "", ""});
  EXPECT_EQ(Texts(conversation.get())[0]["n"], 501);
}

// Tests that a get is answered with the very samples, and values exactly.
TEST_F(LiveConversationTest, Answers) {
  const auto conversation = Converse();
  All(conversation.get());
  conversation->Hear(R"({"op":"get","id":8,"run":0,"channels":["p1"],"t0":0.1,"t1":0.2,"pixels":1000})",
                     false);
  const auto answer = All(conversation.get());
  ASSERT_TRUE(answer.at(0).binary);
  const DecodedBins bins = Decode(answer[0].bytes);
  EXPECT_EQ(bins.id, 8u);
  EXPECT_EQ(bins.flags, uint32_t{kAnswerToGet});
  EXPECT_EQ(bins.min[0].front(), 100);
  EXPECT_EQ(bins.max[0].back(), 200);
  const json values =
      Reply(conversation.get(), R"({"op":"values","id":9,"run":0,"channels":["p1","p2"],"t":0.1234})");
  EXPECT_EQ(values["id"], 9);
  EXPECT_EQ(values["data"]["t"], 0.123);
  EXPECT_EQ(values["data"]["values"], json::parse("[123.0, null]"));
  const json none = Reply(conversation.get(), R"({"op":"values","id":9,"run":0,"channels":["p1"],"t":-1})");
  EXPECT_EQ(none["data"]["t"], json());
}

// Tests that what cannot be done is answered with why: unknown channels and runs, and what a log or a
// read-only scope refuses.
TEST_F(LiveConversationTest, RefusesWithAReason) {
  const auto conversation = Converse();
  for (const char* request :
       {R"({"op":"get","id":1,"run":5,"channels":["p1"],"t0":0,"t1":1})",
        R"({"op":"get","id":1,"run":0,"channels":["p3"],"t0":0,"t1":1})",
        R"({"op":"view","id":1,"run":0,"channels":["p3"],"span":1})", R"({"op":"arm","id":1})",
        R"({"op":"stop","id":1})", R"({"op":"rearm","id":1})", R"({"op":"set","id":1,"entries":[]})",
        R"({"op":"undo","id":1})", R"({"op":"ghost","id":1})", R"({"op":"nothing","id":1})"}) {
    const json reply = Reply(conversation.get(), request);
    EXPECT_EQ(reply["ok"], false) << request;
    EXPECT_EQ(reply["id"], 1) << request;
    EXPECT_NE(reply["text"], "") << request;
  }
}

// Tests that it stops listening rather than keep requests without end, and listens again when answers were
// taken.
TEST_F(LiveConversationTest, ListensToSoMuch) {
  const auto conversation = Converse();
  int heard = 0;
  while (conversation->listens() && heard < 1000) {
    conversation->Hear(R"({"op":"get","id":8,"run":0,"channels":["p1"],"t0":0,"t1":1,"pixels":100})", false);
    ++heard;
  }
  EXPECT_EQ(heard, 64);
  Conversation::Message message;
  EXPECT_TRUE(conversation->Next(&message));  // hello
  EXPECT_TRUE(conversation->Next(&message));
  EXPECT_TRUE(conversation->listens());
}

// Tests that views and triggers are limited, and that a client of nonsense is given up.
TEST_F(LiveConversationTest, Limits) {
  const auto conversation = Converse();
  const auto ask = [&](const std::string& op, int id) {
    return Reply(conversation.get(),
                 R"({"op":")" + op + R"(","id":)" + std::to_string(id) +
                     R"(,"run":0,"channels":["p1"],"channel":"p1","span":1,"pixels":100})");
  };
  for (int id = 0; id < 16; ++id) EXPECT_TRUE(ask("view", id).is_null());
  EXPECT_EQ(ask("view", 16)["ok"], false);
  EXPECT_TRUE(ask("view", 3).is_null());  // another in its place
  for (int id = 20; id < 28; ++id) EXPECT_TRUE(ask("trigger", id).is_null());
  EXPECT_EQ(ask("trigger", 28)["ok"], false);
  for (int i = 0; i < 19; ++i) conversation->Hear("nonsense", false);
  EXPECT_TRUE(conversation->over());
}

// Tests that a mark is an event, and that marks cannot push out what a run has to tell.
TEST_F(LiveConversationTest, Marks) {
  const auto conversation = Converse();
  runs_.live()->events.Add({0, 0.1, "fault", "", "", "the first"});
  EXPECT_EQ(Reply(conversation.get(), R"({"op":"mark","id":1,"run":0,"t":0.5,"text":"here"})")["ok"], true);
  EXPECT_EQ(runs_.live()->events.At(2).kind, "mark");
  json reply;
  for (int i = 0; i < 20000 && (reply.is_null() || reply["ok"] == true); ++i) {
    reply = Reply(conversation.get(), R"({"op":"mark","id":1,"run":0,"t":0.5,"text":"again"})");
  }
  EXPECT_EQ(reply["ok"], false);
  EXPECT_EQ(runs_.live()->events.At(1).text, "the first");
}

// Tests that the frames of several views come in turn, and what a slow client missed is told.
TEST_F(LiveConversationTest, TellsWhatWasDropped) {
  const auto conversation = Converse();
  for (const char* id : {"1", "2"}) {
    conversation->Hear(
        std::string(R"({"op":"view","id":)") + id + R"(,"run":0,"channels":["p1"],"span":0.1,"pixels":100})",
        false);
  }
  All(conversation.get());
  EXPECT_EQ(frames_, 2);
  now_ += std::chrono::seconds(10);
  for (int64_t tick = 1001; tick <= 11000; ++tick) AddTick(runs_.live(), tick, 0);
  All(conversation.get());
  now_ += std::chrono::seconds(2);
  bool told = false;
  for (const json& text : Texts(conversation.get())) {
    if (text["op"] != "dropped") continue;
    told = true;
    EXPECT_EQ(text["bins"], 2 * 9900);
    EXPECT_GT(text["frames"], 1000);
  }
  EXPECT_TRUE(told);
}

// Tests that a restart is told, the new run's events are numbered anew, and the old run stays under another
// number.
TEST_F(LiveConversationTest, FollowsARestart) {
  runs_.live()->session = 1;
  runs_.live()->events.Add({0, 0.1, "fault", "", "", "before"});
  const auto conversation = Converse();
  All(conversation.get());
  auto& run = runs_.RestartLive();
  run.session = 2;
  run.events.Add({0, 0, "restart", "", "", "again"});
  now_ += std::chrono::seconds(1);
  bool restarted = false;
  bool listed = false;
  for (const json& text : Texts(conversation.get())) {
    restarted = restarted ||
                (text["op"] == "event" && text["run"] == 0 && text["n"] == 1 && text["kind"] == "restart");
    listed =
        listed || (text["op"] == "runs" && text["runs"].size() == 2 && text["runs"][1]["kind"] == "past");
  }
  EXPECT_TRUE(restarted);
  EXPECT_TRUE(listed);
}

// Tests that of a limb each joint is a live run, with a clock of its own, and begins anew by itself.
TEST_F(LiveConversationTest, TheJointsOfALimb) {
  auto& knee = runs_.StartLive("knee", "_knee", 1000, 1 << 20);
  AddTick(&knee, 0, 1);
  const auto conversation = Converse();
  std::set<int> clocks;
  for (const json& text : Texts(conversation.get())) {
    if (text["op"] == "clock") clocks.insert(text["run"].get<int>());
  }
  EXPECT_EQ(clocks, (std::set<int>{0, 1}));
  auto& again = runs_.RestartLive(1);
  EXPECT_EQ(again.id, 1u);
  EXPECT_EQ(again.suffix, "_knee");
  EXPECT_EQ(runs_.AllLive().size(), 2u);
  EXPECT_EQ(runs_.All().size(), 3u);
  EXPECT_FALSE(runs_.Close(1));
  EXPECT_TRUE(runs_.Close(2));  // the knee's run before
}

}  // namespace
}  // namespace hydro::scope
