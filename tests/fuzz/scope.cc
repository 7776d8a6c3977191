// What hydro-scope makes of what a browser sends.
#include <array>
#include <limits>

#include "scope/foxglove_conversation.h"
#include "scope/live_conversation.h"
#include "scope/wire/access.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace hydro::fuzz {
namespace {

class NoGhost : public scope::GhostSwitch {
 public:
  scope::Outcome Switch(uint32_t, bool, double) override { return {}; }
  scope::Outcome Sync(uint32_t) override { return {}; }
};

// Tells a conversation the lines one by one, and takes what it says after each, as a server does.
void Tell(scope::Conversation& conversation, std::string_view lines, bool binary) {
  constexpr int kMostAnswers = 1000;
  int turns = 0;
  while (!lines.empty() && ++turns < 100) {
    const size_t end = lines.find('\n');
    if (conversation.listens()) conversation.Hear(lines.substr(0, end), binary);
    lines = end == std::string_view::npos ? "" : lines.substr(end + 1);
    scope::Conversation::Message message;
    int answers = 0;
    while (conversation.Next(&message)) {
      Promise(!message.bytes.empty(), "a message says something");
      Promise(message.bytes.size() < (size_t{8} << 20), "a message is no longer than the limits allow");
      Promise(++answers < kMostAnswers, "there is an end of what it has to say");
    }
  }
}

}  // namespace

void Scope(const uint8_t* data, size_t size) {
  if (size == 0) return;
  const std::string_view text = Text(data + 1, size - 1);
  if (const auto target = scope::ParseTarget(text)) {
    Promise(target->path.find('\0') == std::string::npos, "a path has no zero byte");
  }
  scope::RunTable runs;
  auto& run = runs.StartLive("fuzz", "", 10000, 1 << 20);
  run.rate_hz = 1000;
  std::array<double, scope::kTickColumns> row{};
  for (int tick = 0; tick < 100; ++tick) {
    row.fill(tick % 7 == 0 ? std::numeric_limits<double>::quiet_NaN() : tick);
    run.ticks.Append(tick * 1e-3, row.data());
  }
  run.events.Add({0, 0.05, "fault", "plant", "code", "text"});
  scope::OperatorActions actions(nullptr, false, [](const std::function<void()>& work) { work(); }, {});
  NoGhost ghost;
  auto now = std::chrono::steady_clock::time_point() + std::chrono::hours(1);
  const scope::LiveContext context{.runs = runs,
                                   .actions = actions,
                                   .ghost = ghost,
                                   .silent_s = [](uint32_t) { return -1.0; },
                                   .now = [&now] { return now += std::chrono::milliseconds(20); },
                                   .frames = nullptr,
                                   .dropped = nullptr};
  scope::LiveConversation live(context);
  Tell(live, text, (data[0] & 1) != 0);
  scope::FoxgloveConversation foxglove(&runs);
  Tell(foxglove, text, (data[0] & 2) != 0);
}

}  // namespace hydro::fuzz
