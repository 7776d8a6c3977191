#include <net/if.h>
#include <pwd.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/timex.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <hydro/loop_statistics_t.hpp>
#include <iterator>
#include <map>
#include <set>
#include <thread>

#include "bus/channels.h"
#include "bus/udpm/open_udpm_bus.h"
#include "launch/doctor/doctor.h"

namespace hydro::launch {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto kListenTime = 2s;  // every process of a stack reports once a second
constexpr double kWakeUpTime_s = 1;

// Returns an empty text when the file cannot be read.
std::string TextOf(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string WordOf(const fs::path& path) {
  std::string word;
  std::ifstream(path) >> word;
  return word;
}

std::optional<bool> SwitchOf(const fs::path& path) {
  const std::string word = WordOf(path);
  if (word.empty()) return std::nullopt;
  return word != "0";
}

// Asks a socket, because files under /sys may belong to another network namespace.
unsigned FlagsOf(const std::string& interface) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return 0;
  ifreq request{};
  interface.copy(request.ifr_name, sizeof request.ifr_name - 1);
  const bool known = ioctl(fd, SIOCGIFFLAGS, &request) == 0;
  close(fd);
  return known ? static_cast<unsigned short>(request.ifr_flags) : 0;
}

std::vector<NetworkInterface> Interfaces() {
  std::vector<NetworkInterface> interfaces;
  if (struct if_nameindex* const names = if_nameindex(); names != nullptr) {
    for (const struct if_nameindex* name = names; name->if_name != nullptr; ++name) {
      NetworkInterface interface;
      interface.name = name->if_name;
      const unsigned flags = FlagsOf(interface.name);
      interface.up = (flags & IFF_UP) != 0 && (flags & IFF_RUNNING) != 0;
      interface.loopback = (flags & IFF_LOOPBACK) != 0;
      interface.multicast = (flags & IFF_MULTICAST) != 0;
      const fs::path folder = fs::path("/sys/class/net") / interface.name;
      interface.snooping = SwitchOf(folder / "bridge/multicast_snooping");
      interface.querier = SwitchOf(folder / "bridge/multicast_querier");
      interfaces.push_back(interface);
    }
    if_freenameindex(names);
  }
  return interfaces;
}

bool IsInstalled(const std::string& program) {
  for (const char* folder : {"/usr/sbin/", "/usr/bin/", "/sbin/"}) {
    if (access((folder + program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

std::string Firewall() {
  for (const char* program : {"ufw", "firewall-cmd", "nft", "iptables"}) {
    if (IsInstalled(program)) return program;
  }
  return "";
}

int ReceiveBuffer(int asked) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return 0;
  int given = 0;
  socklen_t length = sizeof given;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &asked, sizeof asked);
  getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &given, &length);
  close(fd);
  return given;
}

int64_t LimitOf(__rlimit_resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return 0;
  return limit.rlim_cur == RLIM_INFINITY ? -1 : static_cast<int64_t>(limit.rlim_cur);
}

std::string UserName() {
  const passwd* const entry = getpwuid(getuid());
  return entry != nullptr ? entry->pw_name : std::to_string(getuid());
}

std::vector<int> AllowedCpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cpus;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<size_t>(cpu), &set)) cpus.push_back(cpu);
  }
  return cpus;
}

void ReadClock(MachineFacts* facts) {
  timex state{};
  const int result = adjtimex(&state);
  if (result < 0) return;
  const bool free_running = result == TIME_ERROR || (state.status & STA_UNSYNC) != 0;
  facts->clock = free_running ? ClockState::kUnsynchronised : ClockState::kSynchronised;
  facts->clock_error_us = state.maxerror;
}

// Listens for the names of the processes that report on their loops. Their messages may end with a seal (a
// stack with a key).
void Listen(const DoctorTask& task, MachineFacts* facts) {
  const std::string statistics = bus::Channels().Of<loop_statistics_t>();
  std::map<std::string, std::set<std::string>> stacks;
  const auto bus = bus::OpenUdpmBus(task.url.ToString());
  bus->SubscribeAll([&](const bus::RawMessage& message) {
    const bool of_a_stack =
        bus::AnyMessage([&](const auto& row) { return message.channel.starts_with(row.channel); });
    if (!of_a_stack) ++facts->other_messages;
    loop_statistics_t report;
    if (!message.channel.starts_with(statistics) || report.decode(message.data, 0, message.size) < 0) return;
    stacks[std::string(message.channel.substr(statistics.size()))].insert(report.role + " on " + report.host);
  });
  const auto until = std::chrono::steady_clock::now() + kListenTime;
  while (std::chrono::steady_clock::now() < until) bus->HandleUntil(until);
  facts->listened_s = std::chrono::duration<double>(kListenTime).count();
  for (const auto& [suffix, processes] : stacks) {
    facts->stacks.push_back({suffix, {processes.begin(), processes.end()}});
  }
}

}  // namespace

MachineFacts GatherFacts(const DoctorTask& task) {
  MachineFacts facts;
  facts.routes = TextOf("/proc/net/route");
  facts.interfaces = Interfaces();
  facts.firewall = Firewall();
  facts.receive_buffer_asked = task.url.recv_buf_size > 0 ? task.url.recv_buf_size : bus::kReceiveBufferBytes;
  facts.receive_buffer_bytes = ReceiveBuffer(facts.receive_buffer_asked);
  // While the others are asked, as a stack's loops wake beside other work.
  std::thread sleeper([&] {
    if (task.rate_hz > 0)
      facts.wake_ups = MeasureWakeUps(task.rate_hz, kWakeUpTime_s, task.plant_priority, task.plant_cpu);
  });
  try {
    bus::TestMulticast(task.url);
    Listen(task, &facts);
  } catch (const bus::BusError& error) {
    facts.self_test_error = error.what();
  }
  sleeper.join();
  facts.rtprio_limit = LimitOf(RLIMIT_RTPRIO);
  facts.memlock_limit = LimitOf(RLIMIT_MEMLOCK);
  facts.process_status = TextOf("/proc/self/status");
  facts.user = UserName();
  facts.cpus = AllowedCpus();
  for (int cpu = 0; cpu < static_cast<int>(sysconf(_SC_NPROCESSORS_CONF)); ++cpu) {
    const std::string governor =
        WordOf("/sys/devices/system/cpu/cpu" + std::to_string(cpu) + "/cpufreq/scaling_governor");
    if (!governor.empty()) facts.governors.push_back(governor);
  }
  facts.swaps = TextOf("/proc/swaps");
  facts.realtime_kernel = WordOf("/sys/kernel/realtime") == "1";
  ReadClock(&facts);
  facts.timesyncd = IsInstalled("timedatectl") && fs::exists("/usr/lib/systemd/systemd-timesyncd");
  return facts;
}

}  // namespace hydro::launch
