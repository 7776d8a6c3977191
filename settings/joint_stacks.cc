#include "settings/joint_stacks.h"

#include <algorithm>

#include "settings/stack_document.h"

namespace hydro::settings {
namespace {

std::string ErrorOf(const JointDocument& document, const std::string& file) {
  TomlNode root = document.root;
  try {
    StackOf(&root, file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// The place in `node`, or in a node inside it, with which the message begins; empty: the message begins with
// some other place.
std::string PlaceIn(const TomlNode& node, const std::string& message) {
  if (message.starts_with(node.place + ": ")) return node.place;
  for (const TomlMember& member : node.members) {
    if (std::string place = PlaceIn(member.second, message); !place.empty()) return place;
  }
  for (const TomlNode& item : node.items) {
    if (std::string place = PlaceIn(item, message); !place.empty()) return place;
  }
  return "";
}

}  // namespace

StackConfig StackOfDocument(const TomlNode& root, const std::vector<JointDocument>& documents, size_t index,
                            const std::string& file) {
  TomlNode own = documents[index].root;
  try {
    return StackOf(&own, file);
  } catch (const InputError& error) {
    const std::string message = error.what();
    std::string place = PlaceIn(root.Find("joint")->items[index], message);
    const auto says_the_same = [&](const JointDocument& other) { return ErrorOf(other, file) == message; };
    if (place.empty() && std::all_of(documents.begin(), documents.end(), says_the_same)) throw;
    if (place.empty()) place = message.substr(0, message.find(": "));
    throw InputError(place + ": joint " + documents[index].name + message.substr(place.size()));
  }
}

}  // namespace hydro::settings
