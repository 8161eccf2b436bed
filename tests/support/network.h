// Several simulated machines on this machine. They are network namespaces with their own addresses
// and host names, joined by veth pairs and a bridge. The kernel handles their packets like those of
// real machines, and can lose some packets on request. Nothing outside of the namespaces changes.
// The namespaces have no names, so the kernel removes them when this process and its children have
// ended. The destructor of a machine ends all processes that still run on the machine.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/command.h"

namespace fogline::test {

/// The LCM URL of a run on simulated machines. With ttl=1, messages go over the interface to which
/// the route leads. With the default ttl=0, messages go over loopback. All tests use one group and
/// port, because each test has networks of its own.
inline constexpr const char* kUrl = "udpm://239.255.76.67:7700?ttl=1";

/// The reason why this process cannot make machines, such as "unshare: Operation not permitted"; ""
/// if it can make them.
std::string WhyNoMachines();

/// A machine: a network namespace and a host name of its own. It has a loopback device and no
/// route.
class Machine {
 public:
  /// @throws std::system_error if this process may not make a machine
  explicit Machine(const std::string& name);
  ~Machine();
  Machine(Machine&& other) noexcept;
  Machine(const Machine&) = delete;

  /// The command line that runs a command on this machine, for Background and RunCommand(). The
  /// command line replaces itself by the command (nsenter executes it), so a signal to the started
  /// process reaches the command.
  std::vector<std::string> On(const std::vector<std::string>& command) const;
  /// Runs lines of sh on this machine. @return their output
  /// @throws std::runtime_error if a line fails; the text of the exception has the error output
  std::string Do(const std::string& script) const;
  /// The path of the network namespace, as `ip link` expects it.
  std::string network() const;
  const std::string& name() const { return name_; }

  /// Routes the multicast of this machine to its own loopback device.
  void RouteMulticastToItself() const { Do("ip route add 239.0.0.0/8 dev lo"); }
  /// From now on the kernel loses `per_cent` % of the UDP datagrams that arrive at this machine.
  /// This includes the datagrams that this machine sends to itself.
  void LoseUdp(int per_cent) const;
  /// From now on the kernel loses the datagrams of one LCM channel.
  void LoseChannel(const std::string& channel) const;
  /// The number of lost datagrams.
  std::int64_t LostUdp() const;
  /// From now on the kernel loses no datagrams.
  void LoseNothing() const { Do("nft delete table inet loss"); }
  /// Calls `function`. The sockets that `function` makes belong to this machine.
  void Enter(const std::function<void()>& function) const;

 private:
  /// Ends the processes that still run on this machine. sshd leaves such processes when a
  /// connection is cut.
  void EndAll() const;

  std::string name_;
  int network_ = -1;
  int host_name_ = -1;
};

/// Machines lab1, lab2, ... on one switch. Each has the address 10.76.67.N and a multicast route to
/// the switch.
class Lab {
 public:
  explicit Lab(int machines);
  const Machine& operator[](std::size_t i) const { return machines_[i]; }
  const std::vector<Machine>& machines() const { return machines_; }

  /// Unplugs the network cable of a machine from the switch, and plugs it in again.
  void Unplug(std::size_t machine) const { SetPort(machine, "down"); }
  void Plug(std::size_t machine) const { SetPort(machine, "up"); }

  /// From now on the switch copies `per_cent` % of the UDP datagrams of each machine. It sends the
  /// copies to the next machine (after the last machine comes the first). So the next machine gets
  /// a copied multicast datagram twice.
  /// @throws std::runtime_error if the kernel cannot do this
  void RepeatUdp(int per_cent) const;
  /// The number of datagrams that the switch has copied.
  std::int64_t RepeatedUdp() const;

 private:
  void SetPort(std::size_t machine, const std::string& state) const {
    switch_.Do("ip link set port" + std::to_string(machine + 1) + " " + state);
  }

  Machine switch_;
  std::vector<Machine> machines_;
};

}  // namespace fogline::test
