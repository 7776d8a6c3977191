#include "scope/live_request.h"

#include <gtest/gtest.h>

#include "base/input_error.h"

namespace hydro::scope {
namespace {

// Tests that a request's fields arrive.
TEST(LiveRequestTest, Reads) {
  uint32_t id = 0;
  const LiveRequest view = ParseLiveRequest(
      R"({"op":"view","id":3,"run":1,"channels":["dp","p1"],"span":2.5,"pixels":1200,"fps":30})", &id);
  EXPECT_EQ(view.op, LiveRequest::Op::kView);
  EXPECT_EQ(id, 3u);
  EXPECT_EQ(view.view.id, 3u);
  EXPECT_EQ(view.view.run, 1u);
  EXPECT_EQ(view.view.channels, (std::vector<std::string>{"dp", "p1"}));
  EXPECT_EQ(view.view.span, 2.5);
  EXPECT_EQ(view.view.pixels, 1200u);
  EXPECT_EQ(view.view.fps, 30);
  const LiveRequest trigger = ParseLiveRequest(
      R"({"op":"trigger","id":4,"channel":"dp","level":100,"edge":"falling","hysteresis":1,"holdoff":0.1,"pre":0.5,)"
      R"("mode":"single","on":"fault","span":0.5,"pixels":800,"channels":["dp"]})",
      &id);
  EXPECT_EQ(trigger.trigger.edge, TriggerRequest::Edge::kFalling);
  EXPECT_EQ(trigger.trigger.mode, TriggerRequest::Mode::kSingle);
  EXPECT_EQ(trigger.trigger.on, TriggerRequest::On::kFault);
  EXPECT_EQ(trigger.trigger.level, 100);
  EXPECT_EQ(trigger.trigger.pre, 0.5);
  EXPECT_EQ(trigger.trigger.pixels, 800u);
  EXPECT_EQ(trigger.trigger.channels, std::vector<std::string>{"dp"});
  EXPECT_EQ(ParseLiveRequest(R"({"op":"set","entries":["position.c2=900"]})", &id).entries.at(0),
            "position.c2=900");
}

// Tests that whatever is wrong is named, with what is allowed, and the request's number is known where it has
// one.
TEST(LiveRequestTest, RefusesNonsense) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "allowed is a JSON object"},
      {"[1]", "allowed is a JSON object"},
      {"{", "allowed is a JSON object"},
      {std::string(10000, '['), "allowed is a JSON object"},
      {R"({"id":7})", "op: found nothing"},
      {R"({"id":7,"op":"fly"})", "\"view\""},
      {R"({"id":7,"op":5})", "op: found"},
      {R"({"id":7,"op":"foo"})", R"(op: found "foo")"},
      {R"({"id":7,"op":"view","channels":"dp","span":1})", "channels: found"},
      {R"({"id":7,"op":"view","channels":[1],"span":1})", "channels: found"},
      {R"({"id":7,"op":"view","channels":["dp"]})", "span: found nothing"},
      {R"({"id":7,"op":"view","channels":["dp"],"span":"1"})", "span: found"},
      {R"({"id":7,"op":"view","span":1,"pixels":-1})", "pixels: found"},
      {R"({"id":7,"op":"view","span":1,"pixels":1.5})", "pixels: found"},
      {R"({"id":7,"op":"get","t0":0})", "t1: found nothing"},
      {R"({"id":7,"op":"values","t":1e999})", "allowed is a JSON object"},
      {R"({"id":7,"op":"trigger","edge":"up"})", "\"rising\""},
      {R"({"id":7,"op":"mark","t":1,"text":")" + std::string(400, 'x') + "\"}", "300 bytes"},
  };
  for (const auto& [message, named] : cases) {
    uint32_t id = 0;
    try {
      ParseLiveRequest(message, &id);
      ADD_FAILURE() << message;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
      const bool has_id = named != "allowed is a JSON object";
      EXPECT_EQ(id, has_id ? 7u : 0u) << message;
    }
  }
}

}  // namespace
}  // namespace hydro::scope
