// The order in which the messages of one channel are compared and tabulated.
#pragma once

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "runs/message_fields.h"

namespace hydro::runs {

// Compares integers and strings by value, and doubles by bits: a total order in which only identical bits are
// equal.
inline std::strong_ordering CompareField(double a, double b) {
  return std::bit_cast<uint64_t>(a) <=> std::bit_cast<uint64_t>(b);
}
template <class Value>
std::strong_ordering CompareField(const Value& a, const Value& b) {
  return a <=> b;
}

// Compares field by field in the order of FieldsOf(), so by tick first.
template <class Message>
std::strong_ordering CompareMessages(const Message& a, const Message& b) {
  return std::apply(
      [&](const auto&... field) {
        std::strong_ordering order = std::strong_ordering::equal;
        static_cast<void>(
            ((order = CompareField(a.*field.member, b.*field.member), order == std::strong_ordering::equal) &&
             ...));
        return order;
      },
      FieldsOf(static_cast<const Message*>(nullptr)));
}

// The messages in order; those that agree in every field of FieldsOf() appear once. The result points into
// `messages`.
template <class Message>
std::vector<const Message*> InOrder(const std::vector<Message>& messages) {
  std::vector<const Message*> ordered;
  ordered.reserve(messages.size());
  for (const Message& message : messages) ordered.push_back(&message);
  const auto before = [](const Message* a, const Message* b) { return CompareMessages(*a, *b) < 0; };
  if (!std::is_sorted(ordered.begin(), ordered.end(), before)) {
    std::stable_sort(ordered.begin(), ordered.end(), before);
  }
  const auto same = [](const Message* a, const Message* b) { return CompareMessages(*a, *b) == 0; };
  ordered.erase(std::unique(ordered.begin(), ordered.end(), same), ordered.end());
  return ordered;
}

}  // namespace hydro::runs
