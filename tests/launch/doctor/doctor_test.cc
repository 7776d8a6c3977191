// How the doctor interprets the kernel's texts. tests/e2e/doctor_test.py tests the part that reads them.
#include "launch/doctor/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hydro::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr char kHeader[] =
    "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\t\tMTU\tWindow\tIRTT\n";
constexpr char kDefault[] = "eth0\t00000000\t010200C0\t0003\t0\t0\t0\t00000000\t0\t0\t0\n";
constexpr char kSubnet[] = "eth0\t000200C0\t00000000\t0001\t0\t0\t0\t00FFFFFF\t0\t0\t0\n";
constexpr char kAllToLo[] = "lo\t000000E0\t00000000\t0001\t0\t0\t0\t000000F0\t0\t0\t0\n";
constexpr char kAllToEth1[] = "eth1\t000000E0\t00000000\t0001\t0\t0\t5\t000000F0\t0\t0\t0\n";

std::string Table(const std::vector<std::string>& lines) {
  std::string text = kHeader;
  for (const std::string& line : lines) text += line;
  return text;
}

// A machine in good order for a stack like realtime.toml on two hosts.
class DoctorTest : public ::testing::Test {
 protected:
  DoctorTest() {
    task_.url.ttl = 1;
    task_.several_hosts = true;
    task_.priority = 80;
    task_.cpus = {1};
    task_.stale_input_s = 0.005;
    task_.config = "stack.toml";
    facts_.routes = Table({kDefault, kSubnet});
    facts_.interfaces = {{"lo", true, true, false, {}, {}}, {"eth0", true, false, true, {}, {}}};
    facts_.receive_buffer_asked = facts_.receive_buffer_bytes = 4 << 20;
    facts_.listened_s = 2;
    facts_.rtprio_limit = 80;
    facts_.memlock_limit = -1;
    facts_.process_status = "Name:\thydro-launch\nCapEff:\t0000000000000000\n";
    facts_.user = "rig";
    facts_.cpus = {0, 1};
    facts_.governors = {"performance", "performance"};
    facts_.swaps = "Filename\t\t\t\tType\t\tSize\t\tUsed\t\tPriority\n";
    facts_.realtime_kernel = true;
    facts_.clock = ClockState::kSynchronised;
    facts_.clock_error_us = 1500;
    task_.rate_hz = 1000;
    facts_.wake_ups = {.ticks = 1000, .skipped = 9, .latest_s = 0.003};
  }

  Finding Of(const std::string& check) const {
    for (const Finding& finding : Diagnose(task_, facts_)) {
      if (finding.check == check) return finding;
    }
    ADD_FAILURE() << "no finding " << check;
    return {};
  }

  // The only problem, which must come from `check`.
  Finding OnlyProblem(const std::string& check) const {
    for (const Finding& finding : Diagnose(task_, facts_)) {
      EXPECT_EQ(finding.ok, finding.check != check) << finding.check << ": " << finding.found;
      EXPECT_EQ(finding.cure.empty(), finding.ok) << finding.check;
    }
    return Of(check);
  }

  DoctorTask task_;
  MachineFacts facts_;
};

// Tests the most specific route, metrics, routes that refuse, and texts that are no table.
TEST(MulticastRouteTest, FindsTheRoute) {
  const std::string group = "239.255.76.67";
  EXPECT_EQ(FindMulticastRoute(Table({kDefault, kSubnet}), group)->interface, "eth0");
  EXPECT_EQ(FindMulticastRoute(Table({kDefault, kSubnet}), group)->destination, "default");
  EXPECT_EQ(FindMulticastRoute(Table({kDefault, kAllToLo}), group)->destination, "224.0.0.0/4");
  EXPECT_EQ(FindMulticastRoute(Table({kAllToLo, kDefault}), group)->interface, "lo");
  EXPECT_EQ(FindMulticastRoute(Table({kAllToEth1, kAllToLo}), group)->interface, "lo");
  EXPECT_FALSE(FindMulticastRoute(Table({kSubnet}), group));
  EXPECT_FALSE(FindMulticastRoute(
      Table({"*\t000000E0\t00000000\t0201\t0\t0\t0\t000000F0\t0\t0\t0\n", kDefault}), group));
  EXPECT_FALSE(FindMulticastRoute("", group));
  EXPECT_FALSE(FindMulticastRoute("nonsense\neth0\t12", group));
}

// Tests that a good machine has no problem, and that the text says so.
TEST_F(DoctorTest, AllIsWell) {
  const std::vector<Finding> findings = Diagnose(task_, facts_);
  EXPECT_EQ(Problems(findings), 0) << FindingsText(findings);
  EXPECT_THAT(FindingsText(findings), HasSubstr("ok       multicast route"));
  EXPECT_THAT(FindingsText(findings), HasSubstr("all is well\n"));
}

// Tests that a problem is counted and printed with its remedy.
TEST_F(DoctorTest, ProblemsAreCounted) {
  facts_.swaps += "/swapfile file 1048572 0 -2\n";
  const std::vector<Finding> findings = Diagnose(task_, facts_);
  EXPECT_EQ(Problems(findings), 1);
  EXPECT_THAT(FindingsText(findings), HasSubstr("problem  swap"));
  EXPECT_THAT(FindingsText(findings), HasSubstr("fix: swapoff -a\n"));
  EXPECT_THAT(FindingsText(findings), HasSubstr("1 problem;"));
}

TEST_F(DoctorTest, NoRoute) {
  facts_.routes = Table({kSubnet});
  facts_.self_test_error =
      "multicast does not work for udpm://x: no route to the group: unreachable; a cure; see";
  facts_.listened_s = 0;
  EXPECT_EQ(Of("multicast route").cure, "ip route replace 224.0.0.0/4 dev eth0");
  EXPECT_EQ(Of("loopback delivery").cure, "ip route replace 224.0.0.0/4 dev eth0");
  EXPECT_EQ(Of("loopback delivery").found,
            "multicast does not work for udpm://x: no route to the group: unreachable");
  task_.url.ttl = 0;
  EXPECT_EQ(Of("multicast route").cure, "ip route replace 224.0.0.0/4 dev lo");
  facts_.interfaces[0].up = false;
  EXPECT_EQ(Of("multicast route").cure, "ip link set lo up && ip route replace 224.0.0.0/4 dev lo");
  task_.url.ttl = 1;
  facts_.interfaces[1].up = false;
  EXPECT_EQ(Of("multicast route").cure, "ip link set eth0 up && ip route replace 224.0.0.0/4 dev eth0");
}

TEST_F(DoctorTest, RouteToTheLoopback) {
  facts_.routes = Table({kDefault, kAllToLo});
  EXPECT_EQ(OnlyProblem("multicast route").cure, "ip route replace 224.0.0.0/4 dev eth0");
  task_.url.ttl = 0;
  task_.several_hosts = false;
  EXPECT_TRUE(Of("multicast route").ok);
}

TEST_F(DoctorTest, InterfaceIsDownOrCarriesNoMulticast) {
  facts_.interfaces[1].multicast = false;
  EXPECT_EQ(OnlyProblem("multicast route").cure, "ip link set eth0 multicast on");
  facts_.interfaces[1].up = false;
  EXPECT_EQ(OnlyProblem("multicast route").cure, "ip link set eth0 up");
}

TEST_F(DoctorTest, Firewall) {
  facts_.self_test_error =
      "multicast does not work for udpm://x: a packet sent to the group did not come back within 2000 ms; a "
      "cure";
  EXPECT_THAT(OnlyProblem("loopback delivery").cure,
              StartsWith("iptables -I INPUT -p udp -d 239.255.76.67 --dport 7667 -j ACCEPT"));
  facts_.firewall = "ufw";
  EXPECT_EQ(Of("loopback delivery").cure, "ufw allow proto udp to 239.255.76.67 port 7667");
  facts_.firewall = "firewall-cmd";
  EXPECT_EQ(Of("loopback delivery").cure, "firewall-cmd --add-port=7667/udp");
  facts_.firewall = "nft";
  EXPECT_THAT(Of("loopback delivery").cure, StartsWith("nft insert rule inet filter input "));
}

TEST_F(DoctorTest, PortIsTaken) {
  facts_.self_test_error = "multicast does not work for udpm://x: cannot listen on the port: in use; a cure";
  EXPECT_THAT(OnlyProblem("loopback delivery").cure, StartsWith("ss -ulpn 'sport = :7667'"));
}

TEST_F(DoctorTest, SmallBuffers) {
  facts_.receive_buffer_bytes = 425984;
  EXPECT_THAT(OnlyProblem("kernel buffers").cure, StartsWith("sysctl -w net.core.rmem_max=4194304 "));
}

// Tests that a stack with the same channels is a problem and one with others is not, and that both are named.
TEST_F(DoctorTest, OtherStacks) {
  facts_.stacks = {{"_2", {"plant on rig", "logger on desk"}}};
  facts_.other_messages = 20;
  EXPECT_TRUE(Of("other stacks").ok);
  EXPECT_THAT(Of("other stacks").found, HasSubstr("plant on rig, logger on desk (suffix _2)"));
  EXPECT_THAT(Of("other stacks").found, HasSubstr("10 messages a second"));
  task_.channel_suffix = "_2";
  EXPECT_THAT(OnlyProblem("other stacks").cure, StartsWith("hydro-launch stack.toml --stop"));
  EXPECT_THAT(Of("other stacks").found, HasSubstr("plant on rig"));
}

TEST_F(DoctorTest, BridgeWithoutQuerier) {
  facts_.interfaces[1].snooping = true;
  facts_.interfaces[1].querier = false;
  EXPECT_EQ(OnlyProblem("IGMP snooping").cure, "ip link set eth0 type bridge mcast_querier 1");
  facts_.interfaces[1].querier = true;
  EXPECT_TRUE(Of("IGMP snooping").ok);
  facts_.interfaces[1].snooping = facts_.interfaces[1].querier = false;
  EXPECT_TRUE(Of("IGMP snooping").ok);
}

TEST_F(DoctorTest, HostsBeyondTtl) {
  task_.url.ttl = 0;
  EXPECT_THAT(OnlyProblem("ttl and hosts").cure, HasSubstr("udpm://239.255.76.67:7667?ttl=1"));
}

TEST_F(DoctorTest, OpenNetwork) {
  task_.open_network = true;
  EXPECT_THAT(OnlyProblem("ttl and hosts").cure, HasSubstr("--make-key"));
}

// Tests that limits are problems only for processes that want priorities, and that capabilities can replace
// them.
TEST_F(DoctorTest, RealTimeLimits) {
  facts_.rtprio_limit = 79;
  EXPECT_EQ(OnlyProblem("real-time priority").cure,
            "echo 'rig - rtprio 80' >> /etc/security/limits.d/hydro.conf  # then log in again");
  facts_.process_status = "CapEff:\t0000000000800000\n";
  EXPECT_TRUE(Of("real-time priority").ok);
  facts_.memlock_limit = 8 << 20;
  EXPECT_EQ(OnlyProblem("locked memory").cure,
            "echo 'rig - memlock unlimited' >> /etc/security/limits.d/hydro.conf  # then log in again");
  facts_.process_status = "CapEff:\t0000000000804000\n";
  EXPECT_TRUE(Of("locked memory").ok);
  facts_.process_status = "";
  facts_.rtprio_limit = 0;
  task_.priority = 0;
  EXPECT_TRUE(Of("locked memory").ok);
  EXPECT_TRUE(Of("real-time priority").ok);
}

TEST_F(DoctorTest, ProcessorThatIsNotThere) {
  task_.cpus = {0, 3};
  EXPECT_THAT(OnlyProblem("processors").found, HasSubstr("cpu 3, allowed here are 0, 1"));
}

TEST_F(DoctorTest, GeneralKernel) {
  facts_.realtime_kernel = false;
  EXPECT_THAT(OnlyProblem("kernel").cure, StartsWith("apt-get install -y linux-image-rt-amd64"));
  task_.stale_input_s = 0.1;
  EXPECT_TRUE(Of("kernel").ok);
}

TEST_F(DoctorTest, Governor) {
  facts_.governors = {"performance", "powersave"};
  EXPECT_THAT(OnlyProblem("CPU governor").cure, StartsWith("echo performance | tee "));
  EXPECT_THAT(Of("CPU governor").found, HasSubstr("powersave"));
  task_.priority = 0;
  EXPECT_TRUE(Of("CPU governor").ok);
}

// Tests that clocks matter only where there are several.
TEST_F(DoctorTest, Clock) {
  EXPECT_THAT(Of("clock").found, HasSubstr("within 1.5 ms"));
  facts_.clock = ClockState::kUnsynchronised;
  EXPECT_EQ(OnlyProblem("clock").cure, "apt-get install -y chrony");
  facts_.timesyncd = true;
  EXPECT_EQ(Of("clock").cure, "timedatectl set-ntp true");
  task_.several_hosts = false;
  task_.url.ttl = 0;
  EXPECT_TRUE(Of("clock").ok);
}

// Tests that ticks that this machine skips now are a problem where a run that skips as many is one, with what
// was counted; and that few, and a stack without a loop here, are none.
TEST_F(DoctorTest, WakeUps) {
  EXPECT_EQ(Of("wake-ups").found, "9 of 1000 ticks skipped at 1000 Hz, the latest 3.0 ms late, now");
  facts_.wake_ups = {.ticks = 1000, .skipped = 10, .latest_s = 0.0301};
  Finding found = OnlyProblem("wake-ups");
  EXPECT_THAT(
      found.found,
      StartsWith("10 of 1000 ticks skipped at 1000 Hz, the latest 30.1 ms late; allowed are less than 1 %"));
  EXPECT_THAT(found.cure, HasSubstr("or priority = 80"));
  task_.plant_priority = 80;
  EXPECT_THAT(Of("wake-ups").cure, HasSubstr("or a lower plant.rate_hz"));
  facts_.wake_ups = {};
  EXPECT_TRUE(Of("wake-ups").ok);
}

// Tests the count: a wake-up that is late by less than a period skips nothing, one that is late by whole
// periods skips as many ticks, and those beyond the end are not counted.
TEST(WakeUpsTest, CountsAsALoopDoes) {
  const auto count = [](double late_s, double at_s) {
    return CountWakeUps(100, 1,
                        [=](double due) { return due + (due >= at_s && due < at_s + 0.01 ? late_s : 1e-5); });
  };
  EXPECT_EQ(count(0, 0.5).ticks, 100);
  EXPECT_EQ(count(0, 0.5).skipped, 0);
  EXPECT_EQ(count(0.0099, 0.495).skipped, 0);
  EXPECT_EQ(count(0.0101, 0.495).skipped, 1);
  EXPECT_EQ(count(0.0351, 0.495).skipped, 3);
  EXPECT_DOUBLE_EQ(count(0.0351, 0.495).latest_s, 0.0351);
  EXPECT_EQ(count(0.0351, 0.495).ticks, 100);
  EXPECT_EQ(count(5, 0.495).ticks, 100);
  EXPECT_EQ(count(5, 0.495).skipped, 50);
}

// Tests the measurement itself on this machine, whatever it finds.
TEST(WakeUpsTest, Measures) {
  const WakeUps found = MeasureWakeUps(500, 0.1, 0, -1);
  EXPECT_EQ(found.ticks, 50);
  EXPECT_LT(found.skipped, 50);
  EXPECT_GT(found.latest_s, 0);
}

}  // namespace
}  // namespace hydro::launch
