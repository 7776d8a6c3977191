#include "tests/bus/messages_page.h"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>

#include "base/input_error.h"
#include "base/text_file.h"
#include "bus/messages.h"

namespace hydro::bus {
namespace {

constexpr const char* kTitle = R"(# Messages

Written from the table of messages ([bus/messages.h](../bus/messages.h)) and the comments in [lcmtypes/](../lcmtypes) by
`build/tests/messages_page --write docs/messages.md lcmtypes`; a test fails when it is not current. A new message
is one `.lcm` file and one row of the table.

Every message travels on a channel of its own, whose name ends in the stack's `bus.channel_suffix`, of a limb's joint
in `_` and its name behind that ([limbs.md](limbs.md)). Units are those of the model
file; the paper's are in, lbf, s, psi, rad and V. `utime` and `session` differ from run to run and are not compared between runs.
*Sealed* messages carry a proof of their sender where the stack has a key ([security.md](security.md)). *Numbered* messages are
counted by their receivers: a gap in `sequence` is a lost message.

)";

std::string Trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

void AppendWords(const std::string& words, std::string* text) {
  if (words.empty()) return;
  if (!text->empty()) *text += ' ';
  *text += words;
}

// Reads one struct, line by line.
class Parser {
 public:
  explicit Parser(const std::string& file) : file_(file) {}

  void Line(const std::string& line) {
    ++number_;
    const size_t slashes = line.find("//");
    const std::string comment = slashes == line.npos ? "" : Trimmed(line.substr(slashes + 2));
    const std::string code = Trimmed(line.substr(0, slashes));
    if (code.empty()) {
      if (!comment.empty())
        AppendWords(comment, result_.fields.empty() ? &result_.comment : &result_.fields.back().meaning);
      return;
    }
    if (code == "{" || code == "}" || code.starts_with("package ")) return;
    std::smatch match;
    if (std::regex_match(code, match, std::regex(R"(struct (\w+))"))) {
      result_.name = match[1];
    } else if (std::regex_match(code, match, std::regex(R"(const (\w+) (\w+ = -?\w+);)"))) {
      Add({"const " + match[1].str(), match[2], "", comment, true});
    } else if (std::regex_match(code, match, std::regex(R"((\w+)\s+(\w+)(\[\w+\])?;)"))) {
      Add({match[1].str() + match[3].str(), match[2], "", comment, false});
    } else {
      Refuse("found " + code + ", allowed is a field or a constant");
    }
  }

  LcmStruct Finish() {
    if (result_.name.empty() || result_.comment.empty())
      Refuse("a struct with a comment before it is needed");
    for (LcmField& field : result_.fields) {
      std::smatch match;
      const std::string meaning = field.meaning;
      if (std::regex_match(meaning, match, std::regex(R"(\[([^\]]+)\] (.*))"))) {
        field.unit = match[1];
        field.meaning = match[2];
      }
      if (field.meaning.empty()) Refuse(field.name + " has no comment");
      if (field.type.starts_with("double") && field.unit.empty()) {
        Refuse(field.name +
               " has no unit; write it in brackets before the comment, as [rad/s], and [1] for none");
      }
    }
    return result_;
  }

 private:
  void Add(LcmField field) { result_.fields.push_back(std::move(field)); }
  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(file_ + ":" + std::to_string(number_) + ": " + what);
  }

  std::string file_;
  int number_ = 0;
  LcmStruct result_;
};

// A cell of a table.
std::string Cell(const std::string& text) { return std::regex_replace(text, std::regex(R"(\|)"), "\\|"); }

std::string Often(Rate rate) {
  switch (rate) {
    case Rate::kTick:
      return "each plant tick";
    case Rate::kPressureInterval:
      return "each tick on which the pressure loop runs";
    case Rate::kPositionInterval:
      return "each tick on which the position loop runs";
    case Rate::kPeriodic:
      return "every second or two";
    case Rate::kEvent:
      return "at events, see below";
  }
  return "";
}

std::string Overview(const std::vector<LcmStruct>& structs) {
  std::string text = "| channel | type | sender | rate | sealed | numbered |\n|---|---|---|---|---|---|\n";
  ForEachMessage([&, i = 0u]<class Message>(const MessageRow<Message>& row) mutable {
    const std::string& type = structs[i++].name;
    text += "| [`" + std::string(row.channel) + "`](#" + type + ") | `" + type + "` | " +
            std::string(row.sender) + " | " + Often(row.rate) + " | " + (row.sealed ? "yes" : "no") + " | " +
            (PlacesOf<Message>().sequence >= 0 ? "yes" : "no") + " |\n";
  });
  return text;
}

std::string Section(const LcmStruct& message) {
  std::string text = "\n## " + message.name + "\n\n" + message.comment +
                     "\n\n| field | type | unit | meaning |\n|---|---|---|---|\n";
  for (const LcmField& field : message.fields) {
    text += "| `" + field.name + "` | `" + field.type + "` | " + Cell(field.unit) + " | " +
            Cell(field.meaning) + " |\n";
  }
  return text;
}

}  // namespace

LcmStruct ParseLcm(const std::string& text, const std::string& file) {
  Parser parser(file);
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) parser.Line(line);
  return parser.Finish();
}

std::string MessagesPage(const std::string& folder) {
  std::vector<LcmStruct> structs;
  ForEachMessage([&]<class Message>(const MessageRow<Message>&) {
    const std::string file = folder + "/hydro_" + Message::getTypeName() + ".lcm";
    structs.push_back(ParseLcm(ReadTextFile(file), file));
  });
  size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files += entry.path().extension() == ".lcm";
  if (files != structs.size()) {
    throw InputError(folder + ": found " + std::to_string(files) + " .lcm files for " +
                     std::to_string(structs.size()) +
                     " rows of the table; a message needs both, bus/messages.h has the table");
  }
  std::string page = kTitle + Overview(structs);
  for (const LcmStruct& message : structs) page += Section(message);
  return page;
}

}  // namespace hydro::bus
