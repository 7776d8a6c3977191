#include "settings/process_sections.h"

#include <algorithm>

#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

constexpr char kPlant[] = "plant", kDriver[] = "driver", kLogger[] = "logger";
constexpr char kPressure[] = "pressure_ctrl", kPosition[] = "position_ctrl", kLimb[] = "limb";

// The name of our program for a role.
struct OurProgram {
  const char* role;
  const char* program;
};
constexpr OurProgram kOurs[] = {{kPlant, "hydro-plant"},
                                {kDriver, "hydro-driver"},
                                {kPressure, "hydro-pressure-ctrl"},
                                {kPosition, "hydro-position-ctrl"},
                                {kLimb, "hydro-limb"},
                                {kLogger, "hydro-logger"}};
constexpr char kExample[] = "the program and its arguments as a list of texts, e.g. [\"./pid.py\"]";

std::string OurProgramFor(const std::string& role) {
  for (const OurProgram& ours : kOurs) {
    if (role == ours.role) return ours.program;
  }
  return "";
}

// The log is the evidence of what happened, and the plant is part of this project, so the user cannot replace
// either of them.
void ReadRole(SectionReader& section, std::string* role) {
  section.Text("role", role);
  const std::vector<std::string> replaceable = {kPosition, kPressure, kDriver};
  std::string allowed = QuotedList(replaceable);
  section.Require("role", allowed + ", whose place the command takes");
  if (role->empty() || std::ranges::find(replaceable, *role) != replaceable.end()) return;
  if (const std::string ours = OurProgramFor(*role); !ours.empty()) {
    allowed += "; the " + *role + " is always " + ours;
    if (*role == kPlant) allowed += "; a machine of your own is a driver";
  }
  throw section.Error("role", Quoted(*role), allowed);
}

void ReadProgram(SectionReader& section, ProcessSection* process) {
  std::vector<std::pair<std::string, const OurProgram*>> programs;
  programs.reserve(std::size(kOurs));
  for (const OurProgram& ours : kOurs) programs.emplace_back(ours.program, &ours);
  const OurProgram* chosen = nullptr;
  if (section.Choice("program", programs, &chosen)) {
    process->program = chosen->program;
    process->role = chosen->role;
  }
  section.Require("program",
                  "the program's name, e.g. \"hydro-plant\", or a command of your own with its role");
}

void ReadJoints(SectionReader& section, ProcessSection* process) {
  section.Text("joint", &process->joint);
  const TomlNode* joints = section.Take("joints");
  if (joints == nullptr) return;
  constexpr char kNames[] = "a list of joints' names";
  if (process->role != kLimb) throw section.Error("joints", joints->Shown(), "it for hydro-limb only");
  if (!joints->is(TomlNode::Kind::kArray) || joints->items.empty()) {
    throw section.Error("joints", joints->Shown(), kNames);
  }
  for (const TomlNode& name : joints->items) {
    if (!name.is(TomlNode::Kind::kString)) throw section.Error("joints", name.Shown() + " in it", kNames);
    process->joints.push_back(name.text);
  }
}

ProcessSection ReadProcess(SectionReader section) {
  ProcessSection process;
  process.place = section.place();
  if (section.Has("command")) {
    if (section.Has("program")) {
      throw section.Error("command", "it beside program", "one of the two: a program of ours or your own");
    }
    process.command = ReadCommand(section, "command", kExample);
    if (process.command.empty()) throw section.Error("command", "no program", kExample);
    ReadRole(section, &process.role);
  } else {
    ReadProgram(section, &process);
    if (section.Has("role")) {
      throw section.Error("role", "it without command", "it with command: a program of ours has its role");
    }
  }
  ReadJoints(section, &process);
  section.Text("host", &process.host);
  section.Integer("cpu", &process.cpu, -1, 1023);
  section.Integer("priority", &process.priority, 0, 99);
  if (process.command.empty()) {
    process.lock_memory = process.priority > 0;
    section.Boolean("lock_memory", &process.lock_memory);
  } else if (section.Has("lock_memory")) {
    throw section.Error("lock_memory", "it beside command",
                        "it for our programs; one of your own calls mlockall itself");
  }
  section.Finish();
  return process;
}

void CheckBeside(const ProcessSection& process, const std::vector<ProcessSection>& others) {
  const std::string key = process.command.empty() ? "process.program" : "process.command";
  const std::string twin = process.role == kDriver ? kPlant : process.role == kPlant ? kDriver : "";
  for (const ProcessSection& other : others) {
    if (other.joint != process.joint) continue;  // each joint has its own stack
    if (other.role == twin) {
      throw KeyError(process.place, key, NameOf(process) + " beside " + NameOf(other),
                     "one of the two: both send states");
    }
    // Several loggers do no harm; two of any other role would contradict each other on the bus.
    if (other.role != process.role || process.role == kLogger || process.role == kLimb) continue;
    if (other.program == process.program && process.command.empty()) {
      throw KeyError(process.place, key, "a second " + process.program, "one of it in a stack");
    }
    throw KeyError(process.place, key, NameOf(process) + " beside " + NameOf(other),
                   "one program for the role " + process.role);
  }
}

}  // namespace

std::vector<std::string> ReadCommand(SectionReader& section, const std::string& key,
                                     const std::string& example) {
  const TomlNode* node = section.Take(key);
  if (node == nullptr) return {};
  if (!node->is(TomlNode::Kind::kArray)) throw section.Error(key, node->Shown(), example);
  std::vector<std::string> command;
  for (const TomlNode& word : node->items) {
    if (!word.is(TomlNode::Kind::kString)) throw section.Error(key, word.Shown() + " in it", example);
    if (word.text.find('\0') != std::string::npos) throw section.Error(key, "a zero byte in it", example);
    command.push_back(word.text);
  }
  if (!command.empty() && command.front().empty()) throw section.Error(key, "no program", example);
  return command;
}

void ReadProcesses(SectionReader& document, std::vector<ProcessSection>* processes) {
  const TomlNode* node = document.Take("process");
  if (node == nullptr) {
    for (const char* role : {kPlant, kPressure, kPosition}) {
      ProcessSection& process = processes->emplace_back();
      process.program = OurProgramFor(role);
      process.role = role;
    }
    return;
  }
  if (node->is(TomlNode::Kind::kTable)) throw NotAList(node->place, "process");
  if (!node->is(TomlNode::Kind::kArray)) {
    throw document.Error("process", node->Shown(), "sections [[process]]");
  }
  for (const TomlNode& item : node->items) {
    if (!item.is(TomlNode::Kind::kTable)) {
      throw KeyError(item.place, "process", item.Shown(), "sections [[process]]");
    }
    ProcessSection process = ReadProcess(document.Item(item, "process"));
    CheckBeside(process, *processes);
    processes->push_back(std::move(process));
  }
}

const ProcessSection* OwnProgramFor(const StackConfig& config, const std::string& role) {
  const auto found =
      std::find_if(config.processes.begin(), config.processes.end(),
                   [&](const ProcessSection& p) { return !p.command.empty() && p.role == role; });
  return found == config.processes.end() ? nullptr : &*found;
}

std::string NameOf(const ProcessSection& process) {
  if (process.command.empty()) return process.program;
  std::string name;
  for (const std::string& word : process.command) name += word + " ";
  return name + "(" + process.role + ")";
}

StackConfig WithoutOwnPrograms(const StackConfig& config) {
  std::string list;
  bool any = false;
  TomlNode root = ParseToml(config.text, config.file);
  TomlNode* sections = root.Find("process");
  for (size_t i = 0; i < config.processes.size(); ++i) {
    const ProcessSection& process = config.processes[i];
    if (process.command.empty()) continue;
    any = true;
    TomlNode& section = sections->items.at(i);
    section.Erase("command");
    section.Erase("role");
    section.members.push_back({"program", StringNode(OurProgramFor(process.role))});
  }
  if (!any) return config;
  return ParseStackConfig(FormatToml(root), config.file, config.model.text, config.model.resolved_file);
}

}  // namespace hydro::settings
