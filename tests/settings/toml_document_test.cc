#include "settings/toml/toml_document.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::HasSubstr;

// Tests that keys keep the document's order and each node knows its line.
TEST(TomlDocumentTest, KeepsOrderAndLines) {
  const TomlNode root =
      ParseToml("z = 1\na = [1,\n 2.5]\n[section]\nb = \"x\"\n[[list]]\nc = true\n", "f.toml");
  ASSERT_EQ(root.members.size(), 4u);
  EXPECT_EQ(root.members[0].first, "z");
  EXPECT_EQ(root.members[1].first, "a");
  EXPECT_EQ(root.Find("a")->items[1].place, "f.toml:3");
  EXPECT_EQ(root.Find("section")->place, "f.toml:4");
  EXPECT_EQ(root.Find("section")->Find("b")->place, "f.toml:5");
  EXPECT_EQ(root.Find("list")->items[0].place, "f.toml:6");
  EXPECT_EQ(root.Find("none"), nullptr);
}

// Tests that text that is not TOML is refused on one line with its place.
TEST(TomlDocumentTest, RefusesWhatIsNotToml) {
  for (const char* text :
       {"a = 1\nb = \n", "a = 1\n[x\n", "a = 1\na = 2\n", "a = 1\n\"x\n\" = 3\n", "a = 1\nb = \xff\xfe\n"}) {
    const std::string error = InputErrorOf([&] { ParseToml(text, "f.toml"); });
    EXPECT_THAT(error, HasSubstr("f.toml:2: syntax: ")) << text;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

// Tests that a key of very many parts is refused instead of exhausting the stack, wherever it stands, and
// that dots elsewhere are no keys.
TEST(TomlDocumentTest, RefusesVeryDeepKeys) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "\"a\" . b.";
  for (const std::string& text :
       {"x = 1\n" + deep + "c = 1\n", "x = 1\n[" + deep + "c]\n", "x = 1\ny = {" + deep + "c = 1}\n"}) {
    EXPECT_THAT(InputErrorOf([&] { ParseToml(text, "f.toml"); }),
                HasSubstr("f.toml:2: syntax: found a key of"));
  }
  const std::string dots(1000, '.');
  std::string numbers;
  for (int i = 0; i < 100; ++i) numbers += "1.5, ";
  const TomlNode root = ParseToml("a = \"" + dots + "\\\"" + dots + "\" # " + dots + "\nb = \"\"\"\n\"" +
                                      dots + "\n\"\"\"\nc.d.e = [" + numbers + "]\n",
                                  "f.toml");
  EXPECT_EQ(root.Find("c")->Find("d")->Find("e")->items.size(), 100u);
}

void ExpectSame(const TomlNode& a, const TomlNode& b) {
  ASSERT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.text, b.text);
  EXPECT_EQ(a.integer, b.integer);
  EXPECT_EQ(a.boolean, b.boolean);
  if (std::isnan(a.number)) {
    EXPECT_TRUE(std::isnan(b.number));
  } else {
    EXPECT_EQ(a.number, b.number);
    EXPECT_EQ(std::signbit(a.number), std::signbit(b.number));
  }
  ASSERT_EQ(a.items.size(), b.items.size());
  for (size_t i = 0; i < a.items.size(); ++i) ExpectSame(a.items[i], b.items[i]);
  ASSERT_EQ(a.members.size(), b.members.size());
  for (size_t i = 0; i < a.members.size(); ++i) {
    EXPECT_EQ(a.members[i].first, b.members[i].first);
    ExpectSame(a.members[i].second, b.members[i].second);
  }
}

// Tests that what is written reads back as the same tree, whatever its strings and numbers.
TEST(TomlDocumentTest, FormatReadsBack) {
  TomlNode root;
  TomlNode numbers;
  std::mt19937_64 random(7);
  std::vector<TomlNode> values;
  for (int i = 0; i < 2000; ++i) {
    const uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    values.push_back(NumberNode(std::isnan(value) ? std::nan("") : value));
  }
  for (double value : {0.0, -0.0, 1.0, 1e22, 1e-320, 5e-324, 1.7976931348623157e308, 0.1,
                       std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    values.push_back(NumberNode(value));
  }
  root.members.push_back(
      {"strings", ArrayNode({StringNode("plain"), StringNode("\"quoted\" \\ \n\t\r\x01\x7f"),
                             StringNode("\xC3\xA4 \xE2\x82\xAC"), StringNode("")})});
  numbers.members.push_back({"of every size", ArrayNode(std::move(values))});
  TomlNode item;
  item.members.push_back({"pump.stribeck", StringNode("a key with a dot")});
  TomlNode list = ArrayNode({item, item});
  root.members.push_back({"numbers", numbers});
  root.members.push_back({"list", list});
  numbers.members.push_back({"inner", item});
  root.members.push_back({"nested", numbers});
  const TomlNode back = ParseToml(FormatToml(root), "f.toml");
  ExpectSame(root, back);
  EXPECT_EQ(FormatToml(back), FormatToml(root));
}

}  // namespace
}  // namespace hydro::settings
