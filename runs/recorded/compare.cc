#include "runs/recorded/compare.h"

#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "base/number_text.h"
#include "bus/channels.h"
#include "runs/recorded/message_order.h"
#include "runs/recorded/run_config.h"

namespace hydro::runs {
namespace {

struct Difference {
  int64_t tick;
  std::string text;
};

std::string FieldText(double value) {
  if (!std::isnan(value)) return NumberText(value);
  return "nan (" + HexNumber(std::bit_cast<uint64_t>(value), 16) + ")";
}
std::string FieldText(int64_t value) { return std::to_string(value); }
std::string FieldText(int8_t value) { return std::to_string(value); }
std::string FieldText(const std::string& value) { return '"' + value + '"'; }

template <class Message>
std::string FieldDifference(const Message& a, const std::string& name_a, const Message& b,
                            const std::string& name_b) {
  std::string text;
  const auto compare = [&](const auto& field) {
    const auto& value_a = a.*field.member;
    const auto& value_b = b.*field.member;
    if (CompareField(value_a, value_b) == std::strong_ordering::equal) return true;
    text = std::string(".") + field.name + ": " + FieldText(value_a) + " (" + name_a + ") and " +
           FieldText(value_b) + " (" + name_b + ")";
    return false;
  };
  std::apply([&](const auto&... field) { (compare(field) && ...); }, FieldsOf(&a));
  return text;
}

// Replaces `first` by the first difference on this channel if that has a lower tick.
template <class Message>
void CompareChannel(const std::string& channel, const std::vector<Message>& all_a, const std::string& name_a,
                    const std::vector<Message>& all_b, const std::string& name_b,
                    std::optional<Difference>& first) {
  const std::vector<const Message*> a = InOrder(all_a);
  const std::vector<const Message*> b = InOrder(all_b);
  size_t k = 0;
  while (k < a.size() && k < b.size() && CompareMessages(*a[k], *b[k]) == std::strong_ordering::equal) ++k;
  if (k == a.size() && k == b.size()) return;

  Difference difference;
  if (k < a.size() && k < b.size() && a[k]->tick == b[k]->tick) {
    difference = {a[k]->tick, channel + FieldDifference(*a[k], name_a, *b[k], name_b)};
  } else {
    const bool only_in_a = k == b.size() || (k < a.size() && a[k]->tick < b[k]->tick);
    const Message& message = only_in_a ? *a[k] : *b[k];
    difference = {message.tick, channel + ": no such message in " + (only_in_a ? name_b : name_a) +
                                    ", sequence " + std::to_string(message.sequence) + " in " +
                                    (only_in_a ? name_a : name_b)};
  }
  if (!first.has_value() || difference.tick < first->tick) first = std::move(difference);
}

// The units of the run's model; nothing where it does not describe itself.
std::optional<UnitSystem> UnitsOf(const RunLog& log, const std::string& name) {
  const std::vector<run_description_t>& runs = log.messages.Of<run_description_t>();
  if (runs.empty() || runs.front().model_text.empty()) return std::nullopt;
  try {
    return ModelUnits(runs.front(), name);
  } catch (const InputError&) {  // a model of another version: its messages are compared as they are
    return std::nullopt;
  }
}

std::string Described(const UnitSystem& units) {
  return std::string(units.length) + ", " + std::string(units.force) + " and " + units.UnitFor("psi") +
         (units.linear_arm ? ", of an arm in " + units.UnitFor("rad", 1) : "");
}

// The numbers of two runs in other units differ from the first one on, which says nothing of the runs.
void RequireSameUnits(const RunLog& a, const std::string& name_a, const RunLog& b,
                      const std::string& name_b) {
  const std::optional<UnitSystem> of_a = UnitsOf(a, name_a), of_b = UnitsOf(b, name_b);
  if (!of_a || !of_b || *of_a == *of_b) return;
  throw InputError(name_b + ": found a run in " + Described(*of_b) + ", allowed one in the units of " +
                   name_a + ", " + Described(*of_a) +
                   ", because runs are compared bit by bit; hydro-log export --si writes tables of both in "
                   "the same units");
}

}  // namespace

std::optional<std::string> FirstDifference(const RunMessages& a, const std::string& name_a,
                                           const RunMessages& b, const std::string& name_b) {
  const bus::Channels channels;
  std::optional<Difference> first;
  bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>&) {
    if constexpr (ComparedMessage<Message>) {
      CompareChannel(channels.Of<Message>(), a.Of<Message>(), name_a, b.Of<Message>(), name_b, first);
    }
  });
  if (!first.has_value()) return std::nullopt;
  return "differ at tick " + std::to_string(first->tick) + ": " + first->text;
}

std::optional<std::string> FirstDifference(const LimbLog& a, const std::string& name_a, const LimbLog& b,
                                           const std::string& name_b) {
  if (a.whole() != b.whole()) {
    throw InputError((a.whole() ? name_a : name_b) + ": found the joints of a limb, and one stack in " +
                     (a.whole() ? name_b : name_a) + "; allowed are two of a kind, or --joint");
  }
  if (!a.whole()) {
    RequireSameUnits(a.limb, name_a, b.limb, name_b);
    return FirstDifference(a.limb.messages, name_a, b.limb.messages, name_b);
  }
  const auto lacks = [](const LimbLog& from, const LimbLog& to) -> const RunLog* {
    for (const RunLog& joint : from.joints) {
      if (std::ranges::find(to.joints, joint.suffix, &RunLog::suffix) == to.joints.end()) return &joint;
    }
    return nullptr;
  };
  if (const RunLog* joint = lacks(a, b))
    return "differ: the joint " + joint->joint + " is in " + name_a + " alone";
  if (const RunLog* joint = lacks(b, a))
    return "differ: the joint " + joint->joint + " is in " + name_b + " alone";
  for (const RunLog& joint : a.joints) {
    const RunLog& other = *std::ranges::find(b.joints, joint.suffix, &RunLog::suffix);
    RequireSameUnits(joint, name_a, other, name_b);
    const auto difference = FirstDifference(joint.messages, name_a, other.messages, name_b);
    if (difference) return "joint " + joint.joint + ": " + *difference;
  }
  return std::nullopt;
}

}  // namespace hydro::runs
