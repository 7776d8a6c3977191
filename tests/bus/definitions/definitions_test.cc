#include <gmock/gmock.h>

#include <cstring>
#include <hydro/messages.hpp>

#include "base/input_error.h"
#include "bus/definitions/encoded_values.h"
#include "bus/definitions/message_definition.h"
#include "bus/messages.h"
#include "bus/seal_trailer.h"

namespace hydro::definitions {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <class Message>
std::vector<uint8_t> Encoded(const Message& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return bytes;
}

bool Read(const char* channel, const std::vector<uint8_t>& bytes, std::vector<Value>* values) {
  return ReadValues(*DefinitionOf(channel), bytes.data(), static_cast<int>(bytes.size()), values);
}

tuned_settings_t Settings() {
  tuned_settings_t settings{};
  settings.tick = -3;
  settings.stage = tuned_settings_t::IN_FORCE;
  settings.source = "hydro-set";
  settings.count = 2;
  settings.names = {"pressure.k_p", ""};
  settings.values = {0.25, -1e300};
  return settings;
}

// Tests that every message of the stack has a definition with all that its type encodes: an empty message
// reads to its end.
TEST(DefinitionsTest, AllMessages) {
  EXPECT_EQ(Definitions().size(), bus::kMessageCount);
  EXPECT_EQ(DefinitionTexts().size(), bus::kMessageCount);
  size_t index = 0;
  bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>& row) {
    const MessageDefinition& definition = Definitions()[index++];
    EXPECT_EQ(definition.channel, row.channel);
    EXPECT_EQ(definition.type, Message::getTypeName());
    EXPECT_FALSE(definition.description.empty()) << definition.type;
    for (const Field& field : definition.fields) {
      EXPECT_FALSE(field.description.empty()) << definition.type << '.' << field.name;
    }
    std::vector<Value> values;
    EXPECT_TRUE(Read(definition.channel.c_str(), Encoded(Message{}), &values)) << definition.type;
    EXPECT_EQ(values.size(), definition.fields.size());
  });
  EXPECT_EQ(DefinitionOf("HYDRO_STATE_2"), DefinitionOf("HYDRO_STATE"));
  EXPECT_EQ(DefinitionOf("OTHER"), nullptr);
}

// Tests units, meanings over several lines, lists and constants.
TEST(DefinitionsTest, Fields) {
  const MessageDefinition& state = *DefinitionOf("HYDRO_STATE");
  EXPECT_EQ(state.fields[9].name, "p1");
  EXPECT_EQ(state.fields[9].unit, "psi");
  EXPECT_EQ(state.fields[9].description, "pressure of side 1, eq. (13). NaN: not measured");
  const MessageDefinition& histogram = *DefinitionOf("HYDRO_LOOP_HISTOGRAM");
  EXPECT_EQ(histogram.fields.back().count, "buckets");
  EXPECT_THAT(histogram.fields[5].description, HasSubstr("between two runs of the loop; latency: ns"));
  const MessageDefinition& command = *DefinitionOf("HYDRO_MOTOR_COMMAND");
  EXPECT_EQ(command.constants[1].name, "OPEN_LOOP");
  EXPECT_EQ(command.constants[1].value, "1");
  EXPECT_EQ(DefinitionOf("HYDRO_FAULT")->fields[8].unit, "") << "its unit is said elsewhere: [as value]";
}

// Tests the values of every kind of field, lists and empty texts among them.
TEST(DefinitionsTest, Values) {
  std::vector<Value> values;
  ASSERT_TRUE(Read("HYDRO_SETTINGS", Encoded(Settings()), &values));
  EXPECT_EQ(std::get<int64_t>(values[1]), -3);
  EXPECT_EQ(std::get<int64_t>(values[5]), tuned_settings_t::IN_FORCE);
  EXPECT_EQ(std::get<std::string>(values[6]), "hydro-set");
  EXPECT_EQ(std::get<std::string>(values[7]), "");
  EXPECT_THAT(std::get<std::vector<std::string>>(values[11]), ElementsAre("pressure.k_p", ""));
  EXPECT_THAT(std::get<std::vector<double>>(values[12]), ElementsAre(0.25, -1e300));
}

// Tests that a seal after the message is passed over, and that any other bytes, every cut and another type's
// message are refused.
TEST(DefinitionsTest, WrongBytes) {
  std::vector<Value> values;
  const std::vector<uint8_t> bytes = Encoded(Settings());
  std::vector<uint8_t> sealed = bytes;
  sealed.insert(sealed.end(), bus::kSealMagic.begin(), bus::kSealMagic.end());
  sealed.resize(bytes.size() + bus::kSealSize);
  EXPECT_TRUE(Read("HYDRO_SETTINGS", sealed, &values));
  sealed.push_back(0);
  EXPECT_FALSE(Read("HYDRO_SETTINGS", sealed, &values));
  for (size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(
        Read("HYDRO_SETTINGS", {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}, &values));
  }
  EXPECT_FALSE(Read("HYDRO_STATE", bytes, &values));
  // A list of as many elements as 32 bits can count takes no memory.
  arm_plan_t plan{};
  std::vector<uint8_t> endless = Encoded(plan);
  std::memset(endless.data() + 8 + 32, 0x7f, 4);
  EXPECT_FALSE(Read("HYDRO_ARM_PLAN", endless, &values));
}

// Tests that what is no definition of ours is refused, with its line.
TEST(DefinitionsTest, WrongTexts) {
  const std::pair<const char*, const char*> cases[] = {
      {"struct a_t\n{\n  other_t b;\n}\n", "x.lcm: line 3: found the type \"other_t\""},
      {"struct a_t\n{\n  double b[3];\n}\n", "line 3: found \"double b[3];\""},
      {"struct a_t\n{\n  double b[count];\n}\n", "line 3: found the length \"count\""},
      {"struct a_t\n{\n  double b;\n", "found the end of the text"},
      {"struct a_t\n{\n}\nstruct b_t\n{\n}\n", "line 4: found \"struct b_t\""},
      {"double a;\n", "line 1: found \"double a;\", allowed one struct"},
  };
  for (const auto& [text, says] : cases) {
    try {
      ParseDefinition(text, "x.lcm");
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(says));
    }
  }
}

}  // namespace
}  // namespace hydro::definitions
