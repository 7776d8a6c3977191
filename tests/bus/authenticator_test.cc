#include "bus/seal/authenticator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hydro/motor_command_t.hpp>
#include <memory>
#include <string>
#include <vector>

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;
using Verdict = Authenticator::Verdict;
using Bytes = std::vector<uint8_t>;

const std::string kIntroductions = "INTRODUCTION";
const std::string kCommand = "COMMAND";
const std::string kOther = "OTHER";

BusKey KeyOf(uint8_t byte) {
  std::array<uint8_t, kBusKeySize> bytes{};
  bytes.fill(byte);
  return BusKey(bytes);
}

Bytes Encoded(const introduction_t& introduction) {
  Bytes bytes(static_cast<size_t>(introduction.getEncodedSize()));
  introduction.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

// One process's end of the bus. The test delivers the messages.
class Station {
 public:
  explicit Station(uint8_t key = 1) : authenticator_(KeyOf(key), {kIntroductions, kCommand, kOther}) {}

  Bytes Seal(const Bytes& message, const std::string& channel = kCommand) {
    Bytes bytes = message;
    bytes.resize(static_cast<size_t>(authenticator_.Seal(channel, &bytes, static_cast<int>(message.size()))));
    return bytes;
  }
  Verdict Open(const Bytes& bytes, const std::string& channel = kCommand) {
    return authenticator_.Open(channel, bytes.data(), static_cast<int>(bytes.size()), now).verdict;
  }

  // Takes an introduction; returns the sealed answer, or nothing.
  Bytes Hear(const Bytes& bytes, bool* admitted = nullptr) {
    const auto opened =
        authenticator_.Open(kIntroductions, bytes.data(), static_cast<int>(bytes.size()), now);
    if (opened.verdict == Verdict::kRefused) return {};
    introduction_t introduction{};
    EXPECT_EQ(introduction.decode(bytes.data(), 0, opened.size), opened.size);
    bool proved = false;
    const auto answer = authenticator_.Hear(introduction, opened, &proved);
    if (admitted != nullptr) *admitted = proved;
    return answer ? Seal(Encoded(*answer), kIntroductions) : Bytes{};
  }
  Bytes Greet() { return Seal(Encoded(authenticator_.Greeting()), kIntroductions); }
  Authenticator& authenticator() { return authenticator_; }
  const RefusedMessages& refused() const { return authenticator_.refused(); }

  Authenticator::TimePoint now{1h};

 private:
  Authenticator authenticator_;
};

// `newcomer` starts and `other` hears it, as over a network that loses nothing.
void Introduce(Station& newcomer, Station& other) {
  Bytes message = newcomer.Greet();
  Station* receiver = &other;
  Station* sender = &newcomer;
  for (int i = 0; !message.empty(); ++i, std::swap(receiver, sender)) {
    ASSERT_LT(i, 4) << "they do not stop introducing themselves";
    message = receiver->Hear(message);
  }
}

const Bytes kMessage = {1, 2, 3, 4, 5, 6, 7, 8, 9};

// Tests that each station accepts what the other seals, in both directions, after three introductions.
TEST(AuthenticatorTest, RightKeyPasses) {
  Station plant, loop;
  const Bytes greeting = loop.Greet();
  bool admitted = true;
  const Bytes answer = plant.Hear(greeting, &admitted);
  EXPECT_FALSE(admitted) << "a greeting proves nothing";
  const Bytes last = loop.Hear(answer, &admitted);
  EXPECT_TRUE(admitted);
  EXPECT_TRUE(plant.Hear(last, &admitted).empty());
  EXPECT_TRUE(admitted);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(plant.Open(loop.Seal(kMessage)), Verdict::kAccepted);
    EXPECT_EQ(loop.Open(plant.Seal(kMessage)), Verdict::kAccepted);
  }
  EXPECT_EQ(plant.refused().total(), 0);
}

// Tests that a message comes out as it went in, and that a station passes its own messages, which multicast
// brings back.
TEST(AuthenticatorTest, SizeWithoutTheSeal) {
  Station plant;
  const Bytes sealed = plant.Seal(kMessage);
  ASSERT_EQ(sealed.size(), kMessage.size() + kSealSize);
  EXPECT_TRUE(std::equal(kMessage.begin(), kMessage.end(), sealed.begin()));
  const auto opened =
      plant.authenticator().Open(kCommand, sealed.data(), static_cast<int>(sealed.size()), plant.now);
  EXPECT_EQ(opened.verdict, Verdict::kAccepted);
  EXPECT_EQ(opened.size, static_cast<int>(kMessage.size()));
}

// Tests that other channels are left alone, whatever arrives on them.
TEST(AuthenticatorTest, OtherChannelsArePlain) {
  Station plant;
  EXPECT_EQ(plant.Seal(kMessage, "MINE"), kMessage);
  EXPECT_EQ(plant.Open(kMessage, "MINE"), Verdict::kPlain);
  EXPECT_EQ(plant.Open({}, "MINE"), Verdict::kPlain);
}

// Tests that a sender with another key is refused, introductions included.
TEST(AuthenticatorTest, WrongKeyIsRefused) {
  Station plant(1), stranger(2);
  Introduce(stranger, plant);
  Introduce(plant, stranger);
  EXPECT_EQ(plant.refused().wrong_seal, 1);
  EXPECT_EQ(plant.Open(stranger.Seal(kMessage)), Verdict::kRefused);
  EXPECT_EQ(plant.refused().wrong_seal, 2);
  EXPECT_EQ(plant.refused().last_channel, kCommand);
}

// Tests that a change of any single bit of a sealed message, seal included, is noticed.
TEST(AuthenticatorTest, FlippedBitsAreRefused) {
  Station plant, loop;
  Introduce(loop, plant);
  const Bytes sealed = loop.Seal(kMessage);
  for (size_t bit = 0; bit < 8 * sealed.size(); ++bit) {
    Bytes changed = sealed;
    changed[bit / 8] = static_cast<uint8_t>(changed[bit / 8] ^ (1 << bit % 8));
    EXPECT_EQ(plant.Open(changed), Verdict::kRefused) << "bit " << bit;
  }
  const int64_t magic_bits = 8 * static_cast<int64_t>(kSealMagic.size());
  EXPECT_EQ(plant.refused().unsealed, magic_bits);
  EXPECT_EQ(plant.refused().wrong_seal, 8 * static_cast<int64_t>(sealed.size()) - magic_bits);
  EXPECT_EQ(plant.Open(sealed), Verdict::kAccepted) << "refusing must not use up the counter";
}

// Tests that a message is valid on its own channel only: not on another of the stack, nor in another stack.
TEST(AuthenticatorTest, OtherChannelIsRefused) {
  Station plant, loop;
  Introduce(loop, plant);
  EXPECT_EQ(plant.Open(loop.Seal(kMessage, kCommand), kOther), Verdict::kRefused);
  EXPECT_EQ(plant.refused().wrong_seal, 1);
}

// Tests that every truncation, the plain message, an empty one and longer ones are refused.
TEST(AuthenticatorTest, TruncatedAndPlainAreRefused) {
  Station plant, loop;
  Introduce(loop, plant);
  const Bytes sealed = loop.Seal(kMessage);
  for (size_t size = 0; size < sealed.size(); ++size) {
    EXPECT_EQ(plant.Open(Bytes(sealed.begin(), sealed.begin() + static_cast<std::ptrdiff_t>(size))),
              Verdict::kRefused)
        << size;
    EXPECT_EQ(plant.Open(Bytes(sealed.end() - static_cast<std::ptrdiff_t>(size), sealed.end())),
              Verdict::kRefused)
        << size;
  }
  Bytes longer = sealed;
  longer.push_back(0);
  EXPECT_EQ(plant.Open(longer), Verdict::kRefused);
  EXPECT_EQ(plant.Open(kMessage), Verdict::kRefused);
}

// Tests that a message counts once, that an overtaken one is refused, and that each channel has its own
// order.
TEST(AuthenticatorTest, ReplayIsRefused) {
  Station plant, loop;
  Introduce(loop, plant);
  const Bytes first = loop.Seal(kMessage), second = loop.Seal(kMessage), third = loop.Seal(kMessage, kOther);
  EXPECT_EQ(plant.Open(third, kOther), Verdict::kAccepted);
  EXPECT_EQ(plant.Open(second), Verdict::kAccepted);
  EXPECT_EQ(plant.Open(second), Verdict::kRefused);
  EXPECT_EQ(plant.Open(first), Verdict::kRefused);
  EXPECT_EQ(plant.refused().repeated, 2);
  EXPECT_EQ(plant.Open(loop.Seal(kMessage)), Verdict::kAccepted);
}

// Tests that a receiver that was not there refuses a recording of an earlier run, introductions and all, at
// first as a message that waits for its sender's introduction, and meanwhile accepts the live sender.
TEST(AuthenticatorTest, EarlierRunIsRefused) {
  std::vector<Bytes> introductions, commands;
  {
    Station plant, loop;
    introductions.push_back(loop.Greet());
    introductions.push_back(plant.Hear(introductions.back()));
    introductions.push_back(loop.Hear(introductions.back()));
    plant.Hear(introductions.back());
    for (int i = 0; i < 10; ++i) commands.push_back(loop.Seal(kMessage));
    ASSERT_EQ(plant.Open(commands.back()), Verdict::kAccepted);
  }
  Station plant;
  for (const Bytes& introduction : introductions) {
    bool admitted = true;
    plant.Hear(introduction, &admitted);
    EXPECT_FALSE(admitted);
  }
  for (const Bytes& command : commands) EXPECT_EQ(plant.Open(command), Verdict::kWaiting);
  EXPECT_EQ(plant.refused().total(), 0);
  plant.now += Authenticator::kIntroductionTime + 1ms;
  for (const Bytes& command : commands) EXPECT_EQ(plant.Open(command), Verdict::kRefused);
  EXPECT_EQ(plant.refused().unknown_sender, 10);

  Station loop;
  Introduce(loop, plant);
  EXPECT_EQ(plant.Open(loop.Seal(kMessage)), Verdict::kAccepted);
  EXPECT_EQ(plant.Open(commands.back()), Verdict::kRefused);
}

// Tests that a restarted sender is accepted once it has introduced itself, and that what it sent before the
// restart is still refused.
TEST(AuthenticatorTest, RestartIsAccepted) {
  Station plant;
  auto loop = std::make_unique<Station>();
  Introduce(*loop, plant);
  const Bytes before = loop->Seal(kMessage);
  ASSERT_EQ(plant.Open(before), Verdict::kAccepted);
  loop = std::make_unique<Station>();
  EXPECT_EQ(plant.Open(loop->Seal(kMessage)), Verdict::kWaiting);
  Introduce(*loop, plant);
  EXPECT_EQ(plant.Open(loop->Seal(kMessage)), Verdict::kAccepted);
  EXPECT_EQ(plant.Open(before), Verdict::kRefused);
}

// Tests that a restarted receiver takes nothing that was sent before its sender answered it.
TEST(AuthenticatorTest, RestartedReceiverRefusesWhatWasBefore) {
  Station loop;
  Station first_plant;
  Introduce(loop, first_plant);
  const Bytes before = loop.Seal(kMessage);
  Station plant;
  const Bytes answer = loop.Hear(plant.Greet());
  EXPECT_EQ(plant.Open(before), Verdict::kWaiting);
  plant.Hear(answer);
  EXPECT_EQ(plant.Open(before), Verdict::kRefused);
  EXPECT_EQ(plant.refused().repeated, 1);
  EXPECT_EQ(plant.Open(loop.Seal(kMessage)), Verdict::kAccepted);
}

// Tests that a lost introduction is made up for: a waiting sender is asked, at most every 10 ms, and may
// answer late.
TEST(AuthenticatorTest, WaitingSendersAreAsked) {
  Station plant, loop;
  loop.Greet();  // lost
  EXPECT_EQ(plant.Open(loop.Seal(kMessage)), Verdict::kWaiting);
  const auto question = plant.authenticator().Ask(loop.authenticator().session(), plant.now);
  ASSERT_TRUE(question.has_value());
  EXPECT_EQ(question->answers, loop.authenticator().session());
  EXPECT_FALSE(plant.authenticator().Ask(loop.authenticator().session(), plant.now + 9ms).has_value());
  EXPECT_TRUE(plant.authenticator().Ask(loop.authenticator().session(), plant.now + 10ms).has_value());
  plant.now += 10s;
  EXPECT_EQ(plant.Open(loop.Seal(kMessage)), Verdict::kRefused);
  plant.Hear(loop.Hear(plant.Seal(Encoded(*question), kIntroductions)));
  EXPECT_EQ(plant.Open(loop.Seal(kMessage)), Verdict::kAccepted);
}

// Tests that an introduction between two stations proves nothing to a third.
TEST(AuthenticatorTest, IntroductionsAreForOne) {
  Station plant, loop, logger;
  const Bytes answer = plant.Hear(loop.Greet());
  bool admitted = true;
  EXPECT_TRUE(logger.Hear(answer, &admitted).empty());
  EXPECT_FALSE(admitted);
  EXPECT_EQ(logger.Open(plant.Seal(kMessage)), Verdict::kWaiting);
}

// Tests that many recordings at once neither fill the memory nor lock out a live sender.
TEST(AuthenticatorTest, ManyUnknownSenders) {
  Station plant;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(plant.Open(Station().Seal(kMessage)), Verdict::kWaiting);
    plant.now += 1ms;
  }
  Station loop;
  Introduce(loop, plant);
  EXPECT_EQ(plant.Open(loop.Seal(kMessage)), Verdict::kAccepted);
}

// Tests that the table holds every channel of a stack once, the introductions first, and that even with the
// longest suffix a name with REFUSED_ in front still fits a log.
TEST(AuthenticatedChannelsTest, AreAll) {
  const Channels channels(std::string(32, 'x'));
  const std::vector<std::string> table = AuthenticatedChannels(channels);
  EXPECT_EQ(table.front(), channels.Of<introduction_t>());
  EXPECT_THAT(table, testing::UnorderedElementsAreArray(channels.names()));
  for (const std::string& channel : table) EXPECT_LE(("REFUSED_" + channel).size(), 63u);
}

// Tests that a decoder without a key takes a sealed message, but nothing else that is too long.
TEST(MessageSealTest, DecodersLeaveTheSealOut) {
  motor_command_t command{};
  command.tick = 77;
  Bytes bytes(static_cast<size_t>(command.getEncodedSize()));
  command.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  Station loop;
  Bytes sealed = loop.Seal(bytes);
  const MessageType& type = TypeOf<motor_command_t>();
  motor_command_t decoded{};
  ASSERT_TRUE(type.decode_into(&decoded, sealed.data(), static_cast<int>(sealed.size())));
  EXPECT_EQ(decoded.tick, 77);
  EXPECT_NE(type.decode(sealed.data(), static_cast<int>(sealed.size())), nullptr);
  EXPECT_FALSE(type.decode_into(&decoded, sealed.data(), static_cast<int>(sealed.size()) - 1));
  sealed.push_back(0);
  EXPECT_FALSE(type.decode_into(&decoded, sealed.data(), static_cast<int>(sealed.size())));
}

// Tests that the tag depends on where one input ends and the next begins.
TEST(MessageSealTest, InputsDoNotRunTogether) {
  const std::array<uint8_t, kBusKeySize> key{};
  EXPECT_NE(SealTag(key, "AB", 1, 1, "CD", 2), SealTag(key, "ABC", 1, 1, "D", 1));
  EXPECT_NE(SealTag(key, "A", 1, 2, "", 0), SealTag(key, "A", 2, 1, "", 0));
  EXPECT_EQ(SealTag(key, "A", 1, 2, "", 0), SealTag(key, "A", 1, 2, nullptr, 0));
}

}  // namespace
}  // namespace hydro::bus
