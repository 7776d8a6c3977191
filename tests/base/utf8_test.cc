#include "base/utf8.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "base/json_text.h"
#include "base/text_file.h"

namespace hydro {
namespace {

// The UTF-8 of a number by the definition, whether or not it is a character: 1 to 4 bytes, more than needed
// if asked for.
std::string Encoded(uint32_t point, size_t bytes) {
  if (bytes == 1) return {static_cast<char>(point)};
  std::string text;
  for (size_t i = 0; i + 1 < bytes; ++i, point >>= 6)
    text.insert(text.begin(), static_cast<char>(0x80 | (point & 0x3f)));
  const uint32_t mark = bytes == 2 ? 0xc0 : bytes == 3 ? 0xe0 : 0xf0;
  text.insert(text.begin(), static_cast<char>(mark | point));
  return text;
}

// Tests each number up to beyond the last, in each length that can hold it: a character is one that is no
// surrogate, in the shortest form, up to U+10FFFF.
TEST(Utf8Test, ExactlyTheCharactersAreTaken) {
  for (uint32_t point = 0; point < 0x140000; ++point) {
    const size_t shortest = point < 0x80 ? 1 : point < 0x800 ? 2 : point < 0x10000 ? 3 : 4;
    const bool character = point <= 0x10ffff && (point < 0xd800 || point > 0xdfff);
    for (size_t bytes = shortest; bytes <= 4; ++bytes) {
      if (bytes == 2 && point > 0x7ff) continue;
      const std::string text = Encoded(point, bytes);
      ASSERT_EQ(CharacterLength(text), character && bytes == shortest ? bytes : 0) << point << ", " << bytes;
    }
  }
}

// Tests that characters that are cut, lone bytes and an empty text are none.
TEST(Utf8Test, WhatIsCutIsNoCharacter) {
  EXPECT_EQ(CharacterLength(""), 0u);
  for (const char* text :
       {"\xc3", "\xe2\x82", "\xf0\x9f\x98", "\x80", "\xbf", "\xfe", "\xff", "\xc3(", "\xe2(\xa1"}) {
    EXPECT_EQ(CharacterLength(text), 0u) << text;
    EXPECT_FALSE(IsUtf8(text));
  }
  EXPECT_TRUE(IsUtf8(""));
  EXPECT_TRUE(IsUtf8("\xc3\xa4\n\xe2\x82\xac"));
}

// Tests that UTF-8 stays as it is, and every other byte is shown.
TEST(Utf8Test, AsUtf8) {
  for (const char* text : {"", "a\n\x1b", "\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80"})
    EXPECT_EQ(AsUtf8(text), text);
  EXPECT_EQ(AsUtf8("\xed\xa0\x80 \xc0\xaf \xe0\x80\xaf \xf4\x90\x80\x80 \xe4"),
            "\\xed\\xa0\\x80 \\xc0\\xaf \\xe0\\x80\\xaf \\xf4\\x90\\x80\\x80 \\xe4");
}

// Tests that a text is cut between characters only; bytes that are no characters may be cut anywhere.
TEST(Utf8Test, FirstBytes) {
  const std::string text = "a\xc3\xa4\xf0\x9f\x98\x80";
  const size_t expected[] = {0, 1, 1, 3, 3, 3, 3, 7, 7};
  for (size_t most = 0; most < std::size(expected); ++most) {
    EXPECT_EQ(FirstBytes(text, most), text.substr(0, expected[most])) << most;
  }
  const std::string rubbish(100, '\x80');
  for (size_t most = 0; most <= 100; ++most) EXPECT_EQ(FirstBytes(rubbish, most).size(), most);
}

// Tests that random bytes become UTF-8 at every door, that JSON never throws, and that it reads back.
TEST(Utf8Test, AnyBytesBecomeUtf8) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 24, ' ');
    // Mostly bytes with which characters of several bytes begin and go on.
    for (char& byte : bytes) byte = static_cast<char>(random() % 4 == 0 ? random() : 0x80 | random() % 128);
    EXPECT_TRUE(IsUtf8(AsUtf8(bytes)));
    EXPECT_TRUE(IsUtf8(Printable(bytes)));
    EXPECT_TRUE(IsUtf8(PrintableLines(bytes)));
    EXPECT_EQ(IsUtf8(bytes), AsUtf8(bytes) == bytes);
    const std::string text = JsonText(nlohmann::ordered_json{{"text", bytes}, {bytes, 1}});
    EXPECT_TRUE(IsUtf8(text));
    EXPECT_TRUE(nlohmann::json::accept(text));
    if (IsUtf8(bytes)) {
      EXPECT_EQ(nlohmann::json::parse(text)["text"], bytes);
    }
  }
}

}  // namespace
}  // namespace hydro
