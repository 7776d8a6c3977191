#include "settings/joint_stacks.h"

#include <algorithm>

#include "settings/stack_document.h"

namespace hydro::settings {
namespace {

std::string ErrorOf(const JointDocument& document, const std::string& file, ModelFiles* models) {
  TomlNode root = document.root;
  try {
    StackOf(&root, file, models);
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

// The values of a joint that come from the sections for all joints.
TomlNode WithoutOwn(TomlNode document, const TomlNode& own) {
  for (const auto& [section, values] : own.members) {
    TomlNode* merged = document.Find(section);
    if (merged == nullptr || !merged->is(TomlNode::Kind::kTable)) continue;
    for (const TomlMember& value : values.members) merged->Erase(value.first);
  }
  return document;
}

bool NamesItsModel(const TomlNode& root) {
  const TomlNode* model = root.Find("model");
  return model != nullptr && model->Find("file") != nullptr;
}

}  // namespace

std::vector<std::string> ModelsOfJoints(const TomlNode& root) {
  const TomlNode* joints = root.Find("joint");
  std::vector<std::string> models;
  if (joints == nullptr) return models;
  for (const TomlNode& joint : joints->items)
    models.push_back(ModelNameIn(NamesItsModel(joint) ? joint : root));
  return models;
}

void CheckUnitsOfJoints(const std::vector<std::string>& written, const TomlNode& root,
                        const std::vector<JointDocument>& documents, const std::string& file,
                        ModelFiles* models) {
  const UnitSystem common = UnitsOfModelIn(NamesItsModel(root) ? root : documents.front().root, file, models);
  for (size_t i = 0; i < documents.size(); ++i) {
    const TomlNode& document = documents[i].root;
    try {
      if (i < written.size()) CheckUnitsOfOtherModel(written[i], document, file, models);
      if (root.Find("arm") != nullptr) continue;  // all joints of an arm have the same units
      CheckNumbersKeepTheirUnits(WithoutOwn(document, root.Find("joint")->items[i]), document, common,
                                 UnitsOfModelIn(document, file, models));
    } catch (const InputError& error) {
      const std::string message = error.what();
      const size_t place = message.find(": ");
      throw InputError(message.substr(0, place) + ": joint " + documents[i].name + message.substr(place));
    }
  }
}

StackConfig StackOfDocument(const TomlNode& root, const std::vector<JointDocument>& documents, size_t index,
                            const std::string& file, ModelFiles* models) {
  TomlNode own = documents[index].root;
  try {
    return StackOf(&own, file, models);
  } catch (const InputError& error) {
    const std::string message = error.what();
    std::string place = PlaceIn(root.Find("joint")->items[index], message);
    const auto says_the_same = [&](const JointDocument& other) {
      return ErrorOf(other, file, models) == message;
    };
    if (place.empty() && std::all_of(documents.begin(), documents.end(), says_the_same)) throw;
    if (place.empty()) place = message.substr(0, message.find(": "));
    throw InputError(place + ": joint " + documents[index].name + message.substr(place.size()));
  }
}

}  // namespace hydro::settings
