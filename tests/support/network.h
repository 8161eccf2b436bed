// Several machines on this one: network namespaces with addresses and host names of their own,
// joined by veth pairs and a bridge. Their packets go through the kernel as those of real machines
// do, and the kernel can be told to lose some. Nothing outside of them is touched, and they have no
// name that could stay behind: the kernel takes them away when this process and its children have
// ended.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

/// Why machines cannot be made here, such as "unshare: Operation not permitted"; "" if they can.
std::string WhyNoMachines();

/// A machine of its own: a network namespace and a host name. It has a loopback device and no
/// route.
class Machine {
 public:
  /// @throws std::system_error where it is not permitted
  explicit Machine(const std::string& name);
  ~Machine();
  Machine(Machine&& other) noexcept;
  Machine(const Machine&) = delete;

  /// The command line that runs a command on this machine, for Background and RunCommand(). The
  /// process id is that of the command itself.
  std::vector<std::string> On(const std::vector<std::string>& command) const;
  /// Runs lines of sh there. @return what they print @throws std::runtime_error with what they say
  ///     if one of them fails
  std::string Do(const std::string& script) const;
  /// Path of the network namespace, as `ip link` takes it.
  std::string network() const;
  const std::string& name() const { return name_; }

  /// Multicast of this machine stays on it.
  void RouteMulticastToItself() const { Do("ip route add 239.0.0.0/8 dev lo"); }
  /// From now on the kernel loses so many of 100 UDP datagrams that arrive here, its own included.
  void LoseUdp(int per_cent) const;
  /// From now on it loses those of one LCM channel.
  void LoseChannel(const std::string& channel) const;
  /// How many it has lost.
  std::int64_t LostUdp() const;
  /// From now on it loses none.
  void LoseNothing() const { Do("nft delete table inet loss"); }
  /// Calls a function whose sockets are to be on this machine.
  void Enter(const std::function<void()>& function) const;

 private:
  std::string name_;
  int network_ = -1;
  int host_name_ = -1;
};

/// Machines lab1, lab2, ... on one switch, each with address 10.76.67.N and multicast routed there.
class Lab {
 public:
  explicit Lab(int machines);
  const Machine& operator[](std::size_t i) const { return machines_[i]; }
  const std::vector<Machine>& machines() const { return machines_; }

  /// Takes a machine's cable out of the switch, and puts it in again.
  void Unplug(std::size_t machine) const { SetPort(machine, "down"); }
  void Plug(std::size_t machine) const { SetPort(machine, "up"); }

  /// From now on the switch sends so many of 100 UDP datagrams of each machine to the next machine
  /// twice. @throws std::runtime_error where the kernel cannot
  void RepeatUdp(int per_cent) const;
  /// How many it has sent twice.
  std::int64_t RepeatedUdp() const;

 private:
  void SetPort(std::size_t machine, const std::string& state) const {
    switch_.Do("ip link set port" + std::to_string(machine + 1) + " " + state);
  }

  Machine switch_;
  std::vector<Machine> machines_;
};

}  // namespace fogline::test
