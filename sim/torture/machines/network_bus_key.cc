// How a NetworkBus handles authenticated messages: as UdpmBus does (bus/udpm/udpm_authentication.cc), except
// for what only a recorder needs.
#include <utility>

#include "bus/clock.h"
#include "sim/torture/machines/network_bus.h"

namespace hydro::torture {

void NetworkBus::UseKey(std::unique_ptr<bus::Authenticator> authenticator) {
  authenticator_ = std::move(authenticator);
  refused_ = &authenticator_->refused();
  introductions_ = Number(authenticator_->introduction_channel());
}

void NetworkBus::Introduce(introduction_t introduction) {
  introduction.utime = clock_.Utime();
  SendTyped(introductions_, bus::TypeOf<introduction_t>(), &introduction);
}

std::optional<int> NetworkBus::Authenticate(const Packet& packet) {
  using Verdict = bus::Authenticator::Verdict;
  const auto now = clock_.Now();
  const int size = static_cast<int>(packet.bytes.size());
  const bus::Authenticator::Opened opened =
      authenticator_->Open(port_.ChannelName(packet.channel), packet.bytes.data(), size, now);
  if (opened.verdict == Verdict::kPlain) return opened.size;
  if (opened.verdict != Verdict::kRefused && packet.channel == introductions_) {
    introduction_t introduction;
    if (introduction.decode(packet.bytes.data(), 0, opened.size) != opened.size) return std::nullopt;
    bool admitted = false;
    if (const auto answer = authenticator_->Hear(introduction, opened, &admitted)) Introduce(*answer);
    return std::nullopt;
  }
  if (opened.verdict == Verdict::kAccepted) return opened.size;
  if (opened.session != 0) {
    if (const auto question = authenticator_->Ask(opened.session, now)) Introduce(*question);
  }
  return std::nullopt;
}

}  // namespace hydro::torture
