#include "tests/settings/configuration_facts.h"

#include <algorithm>
#include <regex>

#include "base/input_error.h"
#include "settings/limb_config.h"
#include "settings/stack_sections.h"

namespace hydro::settings {
namespace {

const std::string kSensor = "driver.SENSOR";  // all sensors, whose sections have the same keys

constexpr const char* kWiring = R"(
[driver.voltage]
subdevice = 1
channel = 0
scale = 1
[driver.watchdog]
subdevice = 2
channel = 0
[driver.p1]
source = "analog"
subdevice = 0
channel = 0
scale = 1
[driver.p2]
source = "analog"
subdevice = 0
channel = 1
scale = 1
[driver.motor_speed]
source = "derivative"
[driver.arm_speed]
source = "derivative"
)";

constexpr const char* kFrontEnd = R"(
[driver]
kind = "front_end"
url = "unix:/front_end"
[driver.voltage]
scale = 1
[driver.p1]
source = "analog"
channel = 0
scale = 1
[driver.p2]
source = "analog"
channel = 1
scale = 1
[driver.motor_angle]
source = "counter"
channel = 0
scale = 1
[driver.motor_speed]
source = "derivative"
)";

// A document in which the readers ask for some of the keys; `section` has its `kind` or `source`.
struct Probe {
  std::string section;
  std::string kind;
  std::string text;
};

std::vector<Probe> Probes() {
  std::vector<Probe> probes = {{"", "", ""},
                               {"", "", "[[process]]\nprogram = \"hydro-limb\"\n"},
                               {"", "", "[[process]]\nprogram = \"hydro-plant\"\n"},
                               {"", "", "[[process]]\ncommand = [\"./pid.py\"]\nrole = \"position_ctrl\"\n"}};
  for (const char* kind : {"steps", "sine", "square", "chirp", "csv", "planner"}) {
    const std::string points = std::string(kind) == "csv" ? "points = [[0, 0]]\n" : "";
    probes.push_back({"reference", kind, "[reference]\nkind = \"" + std::string(kind) + "\"\n" + points});
  }
  for (const char* source : {"analog", "counter"}) {
    std::string text = kWiring;
    for (const char* angle : {"motor_angle", "arm_angle"}) {
      text += "[driver." + std::string(angle) + "]\nsource = \"" + source +
              "\"\nsubdevice = 0\nchannel = 2\nscale = 1\n";
    }
    probes.push_back({"driver.arm_angle", source, text});
    probes.push_back({"driver.motor_angle", source, text});
    if (std::string(source) == "analog") {
      probes.push_back({"driver.p1", source, text});
      probes.push_back({"driver.p2", source, text});
    } else {
      probes.push_back({"driver.motor_speed", "derivative", text});
      probes.push_back({"driver.arm_speed", "derivative", text});
    }
  }
  std::string speeds =
      kWiring +
      std::string("[driver.arm_angle]\nsource = \"counter\"\nsubdevice = 3\nchannel = 0\nscale = 1\n");
  speeds = std::regex_replace(speeds, std::regex("\"derivative\""),
                              "\"analog\"\nsubdevice = 0\nchannel = 3\nscale = 1");
  probes.push_back({"", "", kFrontEnd});
  probes.push_back({"driver.motor_speed", "analog", speeds});
  probes.push_back({"driver.arm_speed", "analog", speeds});
  return probes;
}

TomlNode& Inner(TomlNode& root, const std::string& section) {
  TomlNode* node = &root;
  for (size_t begin = 0; begin < section.size();) {
    const size_t end = std::min(section.find('.', begin), section.size());
    const std::string name = section.substr(begin, end - begin);
    if (node->Find(name) == nullptr) node->members.push_back({name, TomlNode{}});
    node = node->Find(name);
    if (node->is(TomlNode::Kind::kArray)) node = &node->items.front();
    begin = end + 1;
  }
  return *node;
}

// All sections, those of a limb too.
void ReadAll(const TomlNode& root, std::vector<AskedKey>* asked) {
  StackConfig config;
  TomlNode stack = root;
  stack.Erase("limb");
  ReadSections(stack, "", &config, asked);
  ReadLimbSection(root, config.plant.rate_hz, asked);
}

// What the reader says is allowed when the key holds a date.
std::string AllowedOf(const Probe& probe, const AskedKey& asked) {
  TomlNode root = ParseToml(probe.text, "probe");
  TomlNode& section = Inner(root, asked.section);
  section.Erase(asked.key);
  section.members.push_back({asked.key, *ParseToml("date = 2000-01-01\n", "probe").Find("date")});
  const std::string dotted = asked.section.empty() ? asked.key : asked.section + "." + asked.key;
  std::string said = "nothing";
  try {
    ReadAll(root, nullptr);
  } catch (const InputError& error) {
    said = error.what();
    const std::string found = ": " + dotted + ": found a date or time, allowed ";
    const size_t at = said.find(found);
    if (at != said.npos) return said.substr(at + found.size());
  }
  throw InputError(dotted + ": the reader of a date says: " + said +
                   "; it should say what it found and what is allowed");
}

bool IsQuotedList(const std::string& text) { return text.starts_with("`\"") && text.ends_with("\"`"); }

KeyFacts* Find(std::vector<KeyFacts>& all, const std::string& section, const std::string& key) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const KeyFacts& each) {
    return each.section == section && each.key == key;
  });
  return found == all.end() ? nullptr : &*found;
}

// Of two lists of choices, all of them.
std::string United(const std::string& first, const std::string& second) {
  std::string all = first;
  const std::regex choice("`\"[^\"]*\"`");
  for (std::sregex_iterator i(second.begin(), second.end(), choice), end; i != end; ++i) {
    if (all.find(i->str()) == all.npos) all += ", " + i->str();
  }
  return all;
}

void Add(const KeyFacts& facts, std::vector<KeyFacts>* all) {
  KeyFacts* same = Find(*all, facts.section, facts.key);
  if (same == nullptr) {
    all->push_back(facts);
    return;
  }
  if (same->standard != facts.standard) {
    throw InputError(facts.section + "." + facts.key + ": the defaults differ: " + same->standard + ", " +
                     facts.standard + "; if this depends on another key, it stands by hand");
  }
  if (same->allowed != facts.allowed) {
    if (!IsQuotedList(same->allowed) || !IsQuotedList(facts.allowed)) {
      throw InputError(facts.section + "." + facts.key +
                       ": found two texts of what is allowed: " + same->allowed + "; " + facts.allowed);
    }
    same->allowed = United(same->allowed, facts.allowed);
  }
  for (const std::string& kind : facts.kinds) {
    if (std::find(same->kinds.begin(), same->kinds.end(), kind) == same->kinds.end())
      same->kinds.push_back(kind);
  }
}

bool IsSensor(const std::string& section) {
  return section.starts_with("driver.") && section != "driver.voltage" && section != "driver.watchdog";
}

// The sections of the sensors as one, and in their place in [driver] the sources that they may have.
std::vector<KeyFacts> WithOneSensor(const std::vector<KeyFacts>& all) {
  std::vector<KeyFacts> result;
  for (KeyFacts facts : all) {
    for (const KeyFacts& other : all) {
      if (other.section == facts.section + "." + facts.key && other.key == "source")
        facts.allowed = "section with `source` " + other.allowed;
    }
    if (IsSensor(facts.section)) facts.section = kSensor;
    Add(facts, &result);
  }
  return result;
}

std::string StandardOf(const AskedKey& asked) {
  const std::string dotted = (IsSensor(asked.section) ? kSensor : asked.section) + "." + asked.key;
  for (const HandWritten& each : HandWrittenDefaults()) {
    if (each.key == dotted) return "";
  }
  if (asked.required) return "required";
  if (asked.standard.empty())
    throw InputError(dotted + ": its reader takes the node itself, so the default stands by hand");
  const bool word = asked.standard.starts_with('"') || asked.standard == "inf" || asked.standard == "true" ||
                    asked.standard == "false";
  return word ? "`" + asked.standard + "`" : asked.standard;
}

}  // namespace

const std::vector<HandWritten>& HandWrittenDefaults() {
  static const std::vector<HandWritten> keys = {
      {"model.file", "required, but not of a configuration that a log holds with its model"},
      {"model.initial_pressure", "the model's p_3"},
      {"model.motion", "a section that may be missing"},
      {"pressure.rate_hz", "a word or a number"},
      {"pressure.reference_feedforward", "a truth value or a number"},
      {"reference.steps", "a list"},
      {"reference.points", "a list; with it the file and column are not required"},
      {"reference.file", "required unless there are points"},
      {"reference.column", "required unless there are points"},
      {"limits.arm_angle", "from the model's V_ms and c"},
      {"limits.rearm", "with a [driver] another"},
      {"driver.watchdog", "a section that may be missing"},
      {"driver.watchdog_s", "limits.stale_input_s"},
      {"driver.simulated_device", "a list"},
      {"driver.motor_angle", "a section that may be missing"},
      {"driver.arm_angle", "a section that may be missing"},
      {"driver.arm_speed", "a section that may be missing"},
      {"driver.SENSOR.minimum_V", "the board knows it"},
      {"driver.SENSOR.maximum_V", "the board knows it"},
      {"scope.hosts", "a list"},
      {"scope.origins", "a list"},
      {"limb.telemetry_hz", "a word or a number, and at most the plant's rate"},
      {"process.joints", "a list"},
      {"process.program", "required unless there is a command"},
      {"process.command", "a list"},
      {"process.role", "required only with a command"},
      {"process.lock_memory", "depends on the priority"},
  };
  return keys;
}

std::string ShortAllowed(std::string text) {
  text = text.substr(0, text.find(", e.g."));
  static const std::string number = "(-?[0-9.e+-]*[0-9])";
  static const std::pair<std::regex, std::string> rules[] = {
      {std::regex("a finite number of at least " + number + " and at most " + number), "$1 to $2"},
      {std::regex("a whole number of at least " + number + " and at most " + number), "whole, $1 to $2"},
      {std::regex("a whole number of at least " + number), "whole, at least $1"},
      {std::regex("a finite number (of at least|above) " + number + " and (at most|below) " + number),
       "$1 $2, $3 $4"},
      {std::regex("a finite number above " + number), "above $1"},
      {std::regex("a finite number of at least " + number), "at least $1"},
      {std::regex("^a finite number$"), "a number"},
      {std::regex(", or inf$"), " or `inf`"},
      {std::regex("^true or false$"), "`true`, `false`"},
      {std::regex("^true, false or a finite number"), "`true`, `false`, a number"},
      {std::regex("^a string$"), "text"},
      {std::regex("^whole, 0 to 1$"), "0 or 1"},
      {std::regex("^whole, 1 to 2$"), "1 or 2"},
      {std::regex("^a section .*$"), "a section"},
      {std::regex(" or (\"[^\"]*\")$"), ", $1"},
      {std::regex("(\"[^\"]*\")"), "`$1`"},
      {std::regex("(\\[time_s, value\\])"), "`$1`"},
  };
  for (const auto& [from, to] : rules) text = std::regex_replace(text, from, to);
  return text;
}

std::vector<KeyFacts> ConfigurationFacts() {
  std::vector<KeyFacts> all;
  for (const Probe& probe : Probes()) {
    std::vector<AskedKey> keys;
    ReadAll(ParseToml(probe.text, "probe"), &keys);
    for (const AskedKey& asked : keys) {
      if (asked.section.empty()) continue;  // the sections themselves: each has keys
      // What is allowed may differ with the section's kind; elsewhere one probe tells it.
      if (asked.section != probe.section && Find(all, asked.section, asked.key) != nullptr) continue;
      KeyFacts facts{asked.section, asked.key, StandardOf(asked), ShortAllowed(AllowedOf(probe, asked)), {}};
      if (asked.section == probe.section) facts.kinds.push_back(probe.kind);
      Add(facts, &all);
    }
  }
  return WithOneSensor(all);
}

}  // namespace hydro::settings
