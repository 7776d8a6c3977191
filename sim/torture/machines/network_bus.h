// The bus of one simulated process: encodes what it sends and decodes what arrives, as UdpmBus does.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "bus/bus.h"
#include "bus/seal/authenticator.h"
#include "sim/torture/machines/packet.h"

namespace hydro::torture {

// HandleUntil() throws this in a process that has been killed, which unwinds the process's fiber.
class ProcessKilled {};

// The network as a bus sees it.
class NetworkPort {
 public:
  virtual ~NetworkPort() = default;
  virtual int ChannelNumber(const std::string& name) = 0;
  virtual const std::string& ChannelName(int channel) const = 0;
  virtual PacketPtr NewPacket() = 0;
  virtual void Send(PacketPtr packet, int sender) = 0;
  // A packet is now passed to the handlers of process `receiver`.
  virtual void Handled(const Packet& packet, int receiver) = 0;
};

// How a bus lets other processes run.
class Waiter {
 public:
  virtual ~Waiter() = default;
  // Returns true when a packet has arrived, false at the deadline or at a signal. Throws ProcessKilled.
  virtual bool WaitUntil(bus::Bus::TimePoint deadline) = 0;
};

class NetworkBus : public bus::Bus {
 public:
  NetworkBus(int number, NetworkPort& port, Waiter& waiter, const bus::Clock& clock,
             const bus::HostedProcess& process)
      : number_(number), port_(port), waiter_(waiter), clock_(clock) {
    process_ = &process;
  }

  // From now on, seals what it sends and refuses what is not genuine. Call it before anything is sent.
  void UseKey(std::unique_ptr<bus::Authenticator> authenticator);

  void SubscribeAll(std::function<void(const bus::RawMessage&)> handler) override;
  void PublishRaw(const std::string& channel, const void* data, int size) override;
  int HandleUntil(TimePoint deadline) override;

  bool Hears(int channel) const {
    return !taps_.empty() || channel == introductions_ ||
           (static_cast<size_t>(channel) < typed_.size() && !typed_[static_cast<size_t>(channel)].empty());
  }
  // Puts an arrived packet into the receive buffer. A full buffer loses it, as the kernel's does.
  void Arrive(PacketPtr packet);
  bool has_waiting() const { return !inbox_.empty(); }
  // From now on, nothing that it publishes leaves the process.
  void Disconnect() { connected_ = false; }

 protected:
  void PublishTyped(const std::string& channel, const bus::MessageType& type, const void* message) override;
  void SubscribeTyped(const std::string& channel, const bus::MessageType& type,
                      std::function<void(const void*)> handler) override;
  std::shared_ptr<bus::Outlet> MakeOutlet(const std::string& channel, const bus::MessageType& type) override;

 private:
  class ChannelOutlet;
  struct Subscription {
    const bus::MessageType* type;
    std::shared_ptr<void> message;  // messages are decoded into this, which is reused
    std::function<void(const void*)> call;
  };

  int Number(const std::string& channel);
  void SendTyped(int channel, const bus::MessageType& type, const void* message);
  void Deliver(const Packet& packet);
  // How much of a packet handlers may see; none: it is refused, or not meant for them.
  std::optional<int> Authenticate(const Packet& packet);
  void Introduce(introduction_t introduction);

  const int number_;
  NetworkPort& port_;
  Waiter& waiter_;
  const bus::Clock& clock_;
  std::unique_ptr<bus::Authenticator> authenticator_;  // null: without a key
  int introductions_ = -1;                             // number of the introductions' channel
  bool introduced_ = false;
  bool connected_ = true;
  bool handling_ = false;
  std::unordered_map<std::string, int> numbers_;
  std::vector<std::deque<Subscription>>
      typed_;  // by channel; existing ones stay in place, because a handler may subscribe
  std::deque<std::function<void(const bus::RawMessage&)>> taps_;
  std::deque<PacketPtr> inbox_;
  size_t inbox_bytes_ = 0;
};

}  // namespace hydro::torture
