#include "settings/toml/toml_document.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "settings/toml/section_reader.h"
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

// Tests that what a file defines twice is named as it stands there, with the line that has it first.
TEST(TomlDocumentTest, RefusesWhatIsDefinedTwice) {
  const auto error = [](const std::string& text) { return InputErrorOf([&] { ParseToml(text, "m.toml"); }); };
  EXPECT_EQ(error("[effects.\"pump.stribeck\"]\nspeed = 3\n\n[ effects.\"pump.stribeck\" ] # again\n"),
            "m.toml:4: syntax: found [effects.\"pump.stribeck\"] again, which line 1 has, allowed each "
            "section once: write the keys of both in one");
  EXPECT_EQ(error("[a]\nb = 1\n[c]\nb = 1\n b= 2\n"),
            "m.toml:5: syntax: found b again, which line 4 has, allowed each key once: leave one of the two "
            "out");
  for (const char* text : {"p.a = 1\np = 1\n", "\np = {a = 1, a = 2}\n", "[q]\n[[q]]\n"}) {
    EXPECT_EQ(error(text),
              "m.toml:2: syntax: found what the file has already, allowed each key and each section once");
  }
}

// Tests that a file of another program is told what it is and who reads it, instead of which of its bytes is
// no TOML.
TEST(TomlDocumentTest, FilesOfOtherPrograms) {
  EXPECT_EQ(InputErrorOf([&] { ParseToml("\xed\xa1\xda\x01....", "run.lcmlog"); }),
            "run.lcmlog: found an LCM event log, allowed a TOML file; hydro-log info run.lcmlog says what is "
            "in it, "
            "hydro-log export run.lcmlog -o RUN.csv makes a table of it");
  EXPECT_THAT(InputErrorOf([&] { ParseToml("{\"a\": 1}", "a.json"); }),
              HasSubstr("a.json: found JSON, allowed a TOML file"));
  EXPECT_THAT(InputErrorOf([&] { ParseToml("t;u\n0;1\n", "a.csv"); }),
              HasSubstr("a.csv:1: syntax: found a table"));
}

// Tests that a whole number may have a point, as programs write it, and no fraction.
TEST(TomlDocumentTest, WholeNumbers) {
  const TomlNode root =
      ParseToml("a = 1.0\nb = -3\nc = 1.5\nd = 1e300\ne = inf\nf = \"1\"\ng = 2e3\n", "f.toml");
  EXPECT_EQ(WholeNumber(*root.Find("a")), 1);
  EXPECT_EQ(WholeNumber(*root.Find("b")), -3);
  EXPECT_EQ(WholeNumber(*root.Find("g")), 2000);
  for (const char* key : {"c", "d", "e", "f"}) EXPECT_EQ(WholeNumber(*root.Find(key)), std::nullopt) << key;
  SectionReader section(root, "");
  int64_t seed = 0;
  EXPECT_TRUE(section.Integer("a", &seed, 0, 10));
  EXPECT_EQ(seed, 1);
  EXPECT_THAT(InputErrorOf([&] { section.Integer("g", &seed, 0, 10); }),
              HasSubstr("found 2000, allowed a whole number of at least 0 and at most 10"));
}

std::string Repeated(const std::string& text, int times) {
  std::string repeated;
  for (int i = 0; i < times; ++i) repeated += text;
  return repeated;
}

// Tests that a key of very many parts is refused instead of exhausting the stack, wherever it stands, and
// that dots elsewhere are no keys.
TEST(TomlDocumentTest, RefusesVeryDeepKeys) {
  for (const int parts : {20'000, 100'000}) {
    const std::string deep = Repeated("\"a\" . b.", parts / 2) + "c";
    for (const std::string& text :
         {"x = 1\n" + deep + " = 1\n", "x = 1\n[" + deep + "]\n", "x = 1\n[[" + deep + "]]\n",
          "x = 1\ny = {" + deep + " = 1}\n", "x = 1\ny = [{a = {" + deep + " = 1}}]\n",
          // Quotes directly before the closing three belong to the string, and hide nothing behind it.
          "x = 1\ny = {s = \"\"\"z\"\"\"\", " + deep + " = 1}\n",
          "x = 1\ny = {s = '''z''''', " + deep + " = 1}\n"}) {
      EXPECT_EQ(InputErrorOf([&] { ParseToml(text, "f.toml"); }),
                "f.toml:2: syntax: found a key of more than 16 parts (a.b.c has three), allowed 16");
    }
  }
  const std::string dots(1000, '.');
  const TomlNode root = ParseToml("a = \"" + dots + "\\\"" + dots + "\" # " + dots + "\nb = \"\"\"\n\"" +
                                      dots + "\n\"\"\"\"\nc.d.e = [" + Repeated("1.5, ", 100) + "]\n",
                                  "f.toml");
  EXPECT_EQ(root.Find("b")->text, "\"" + dots + "\n\"");
  EXPECT_EQ(root.Find("c")->Find("d")->Find("e")->items.size(), 100u);
  EXPECT_EQ(ParseToml(Repeated("a.", 15) + "b = 1\n", "f.toml").members.size(), 1u);
  EXPECT_NE(InputErrorOf([&] { ParseToml(Repeated("a.", 16) + "b = 1\n", "f.toml"); }), "");
}

// Tests that very deep nesting is refused, closed or not, and that brackets side by side or in strings and
// comments are no nesting.
TEST(TomlDocumentTest, RefusesVeryDeepNesting) {
  const std::string keys = "{a.b.c.d.e.f.g.h.i.j.k.l.m.n.o = ";
  for (const std::string& text :
       {"x = 1\ny = " + std::string(100'000, '['),
        "x = 1\ny = " + std::string(100'000, '[') + std::string(100'000, ']') + "\n",
        "x = 1\ny = " + Repeated(keys, 250) + "1" + std::string(250, '}') + "\n"}) {
    EXPECT_EQ(InputErrorOf([&] { ParseToml(text, "f.toml"); }),
              "f.toml:2: syntax: found a value of more than 16 brackets in brackets, allowed 16");
  }
  const std::string brackets(1000, '[');
  const TomlNode root = ParseToml("a = \"" + brackets + "\" # " + brackets + "\nb = [" +
                                      Repeated("[1], ", 1000) + "]\n" + Repeated("[[c]]\n", 1000),
                                  "f.toml");
  EXPECT_EQ(root.Find("b")->items.size(), 1000u);
  EXPECT_EQ(root.Find("c")->items.size(), 1000u);
  EXPECT_EQ(ParseToml("a = " + std::string(16, '[') + std::string(16, ']'), "f.toml").members.size(), 1u);
}

// Tests that the deepest allowed document is read.
TEST(TomlDocumentTest, ReadsTheDeepestDocument) {
  const std::string key = Repeated("a.", 15) + "a";
  const TomlNode root = ParseToml(
      "[" + key + "]\n" + key + " = " + Repeated("{" + key + " = ", 16) + "1" + std::string(16, '}') + "\n",
      "f.toml");
  int depth = 0;
  for (const TomlNode* node = &root; node != nullptr; node = node->Find("a")) ++depth;
  EXPECT_EQ(depth, 1 + 16 + 16 + 16 * 16);
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
