#include "tests/support/network.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

namespace fogline::test {
namespace {

[[noreturn]] void ThrowErrno(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

int Open(const char* path) {
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) ThrowErrno(path);
  return fd;
}

std::string PathOf(int fd) {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(fd);
}

/// The number of packets in a counter of nft, such as 12 in "packets 12 bytes 345"; -1 if there is
/// no such number.
std::int64_t Counted(const std::string& counter) {
  const std::size_t at = counter.find("packets ");
  return at == std::string::npos ? -1 : std::stoll(counter.substr(at + 8));
}

/// A shell command that makes a machine lose the UDP datagrams that match the nft expression
/// `match`; "" matches all datagrams.
std::string LossOf(const std::string& match) {
  return "nft 'table inet loss { counter lost {}; chain input { type filter hook input priority 0;"
         " meta l4proto udp " +
         match + " counter name lost drop; }; }'";
}

}  // namespace

std::string WhyNoMachines() {
  try {
    const Lab lab(1);
    lab[0].LoseUdp(0);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

Machine::Machine(const std::string& name) : name_(name) {
  // A thread may leave the namespaces of its process for new ones. The new namespaces exist as long
  // as one of their files is open. So a separate thread enters new namespaces, opens their files,
  // and ends.
  std::exception_ptr failed;
  std::thread([this, &failed] {
    try {
      if (unshare(CLONE_NEWNET | CLONE_NEWUTS) != 0) ThrowErrno("unshare");
      if (sethostname(name_.data(), name_.size()) != 0) ThrowErrno("sethostname");
      network_ = Open("/proc/thread-self/ns/net");
      host_name_ = Open("/proc/thread-self/ns/uts");
    } catch (...) {
      failed = std::current_exception();
    }
  }).join();
  if (failed) std::rethrow_exception(failed);
  Do("ip link set lo up");
}

Machine::~Machine() {
  if (network_ >= 0) {
    EndAll();
    close(network_);
  }
  if (host_name_ >= 0) close(host_name_);
}

Machine::Machine(Machine&& other) noexcept
    : name_(std::move(other.name_)),
      network_(std::exchange(other.network_, -1)),
      host_name_(std::exchange(other.host_name_, -1)) {}

std::string Machine::network() const { return PathOf(network_); }

std::vector<std::string> Machine::On(const std::vector<std::string>& command) const {
  std::vector<std::string> there{"nsenter", "--net=" + network(), "--uts=" + PathOf(host_name_),
                                 "--"};
  there.insert(there.end(), command.begin(), command.end());
  return there;
}

std::string Machine::Do(const std::string& script) const {
  const Outcome outcome = RunCommand(On({"sh", "-ec", script}));
  if (outcome.code != 0) throw std::runtime_error(script + ": " + outcome.err);
  return outcome.out;
}

void Machine::EndAll() const {
  struct stat mine {};
  if (fstat(network_, &mine) != 0) return;
  std::error_code gone;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", gone)) {
    const std::string id = entry.path().filename();
    if (!std::all_of(id.begin(), id.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
      continue;
    }
    struct stat its {};
    const bool there = stat((entry.path() / "ns/net").c_str(), &its) == 0 &&
                       its.st_dev == mine.st_dev && its.st_ino == mine.st_ino;
    if (there) kill(std::stoi(id), SIGKILL);
  }
}

void Machine::LoseUdp(int per_cent) const {
  // nft does not accept a comparison that is always true, so 100 % has no comparison.
  Do(LossOf(per_cent < 100 ? "numgen random mod 100 < " + std::to_string(per_cent) : ""));
}

void Machine::LoseChannel(const std::string& channel) const {
  // The channel's name follows the headers of UDP and LCM, 8 bytes each, so it begins at bit 128.
  std::ostringstream name;
  for (const char letter : channel + '\0') {
    name << std::hex << std::setw(2) << std::setfill('0') << static_cast<int>(letter);
  }
  Do(LossOf("@th,128," + std::to_string(8 * (channel.size() + 1)) + " 0x" + name.str()));
}

void Machine::Enter(const std::function<void()>& function) const {
  std::exception_ptr failed;
  std::thread([&] {
    try {
      if (setns(network_, CLONE_NEWNET) != 0) ThrowErrno("setns");
      function();
    } catch (...) {
      failed = std::current_exception();
    }
  }).join();
  if (failed) std::rethrow_exception(failed);
}

std::int64_t Machine::LostUdp() const { return Counted(Do("nft list counter inet loss lost")); }

Lab::Lab(int machines) : switch_("switch") {
  switch_.Do(
      "ip link add bridge type bridge forward_delay 0 mcast_snooping 0; ip link set bridge up");
  for (int i = 1; i <= machines; ++i) {
    const std::string number = std::to_string(i);
    const Machine& machine = machines_.emplace_back("lab" + number);
    switch_.Do("ip link add port" + number + " type veth peer name eth0 netns " +
               machine.network() + "; ip link set port" + number + " master bridge up");
    machine.Do("ip addr add 10.76.67." + number +
               "/24 dev eth0; ip link set eth0 up; ip route add 239.0.0.0/8 dev eth0");
  }
}

void Lab::RepeatUdp(int per_cent) const {
  std::string table = "nft 'table netdev repeat { counter repeated {};";
  for (std::size_t i = 1; i <= machines_.size(); ++i) {
    const std::string from = std::to_string(i);
    const std::string to = std::to_string(i % machines_.size() + 1);
    table += " chain port" + from + " { type filter hook ingress device port" + from +
             " priority 0; ip protocol udp numgen random mod 100 < " + std::to_string(per_cent) +
             " counter name repeated dup to port" + to + "; };";
  }
  switch_.Do(table + " }'");
}

std::int64_t Lab::RepeatedUdp() const {
  return Counted(switch_.Do("nft list counter netdev repeat repeated"));
}

}  // namespace fogline::test
