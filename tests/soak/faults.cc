#include "tests/soak/faults.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fogline::test {
namespace {

using Random = std::mt19937_64;

double Uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}
/// A random value between two positive bounds; every decade is equally likely.
double LogUniform(Random& random, double low, double high) {
  return std::exp(Uniform(random, std::log(low), std::log(high)));
}
/// Waits for the duration of a fault.
void Last(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

const Machine& AMachine(const SoakedRun& run, Random& random) {
  const auto machines = run.machines();
  return *machines[std::uniform_int_distribution<std::size_t>(0, machines.size() - 1)(random)];
}

std::vector<std::string> None(Random&) { return {}; }

std::vector<std::string> BadNetwork(Random& random) {
  return {"--faults", fmt::format("loss={:.2f},duplicate={:.2f},reorder={:.2f},delay_ms={:.1f}",
                                  Uniform(random, 0, 0.3), Uniform(random, 0, 0.2),
                                  Uniform(random, 0, 0.2), Uniform(random, 0, 5))};
}

bool LoseInput(SoakedRun& run, Random& random, const Limits&) {
  const int per_cent = static_cast<int>(Uniform(random, 5, 40));
  for (const Machine* machine : run.machines()) machine->LoseUdp(per_cent);
  return true;
}

/// Whether a process is stopped by a signal.
bool IsStopped(pid_t process) {
  std::string state;
  std::ifstream status(fmt::format("/proc/{}/status", process));
  for (std::string word; status >> word;) {
    if (word == "State:") status >> state;
  }
  return state == "T";
}

/// Stops the processes of a run. The destructor lets them continue. Processes that were already
/// stopped stay stopped.
class Held {
 public:
  explicit Held(const SoakedRun& run) {
    Hold(run.Processes());
    Hold(run.Processes());  // the runner may have started a role before it was stopped
  }
  ~Held() {
    for (const pid_t process : processes_) kill(process, SIGCONT);
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  const std::vector<pid_t>& processes() const { return processes_; }

 private:
  void Hold(const std::vector<pid_t>& processes) {
    for (const pid_t process : processes) {
      if (IsStopped(process)) continue;
      if (std::ranges::find(processes_, process) != processes_.end()) continue;
      kill(process, SIGSTOP);
      processes_.push_back(process);
    }
  }

  std::vector<pid_t> processes_;
};

/// Executes the shell command `begin` on a machine, waits for `seconds`, and executes the shell
/// command `end`. The run stands still during `begin`, because on a busy machine this command may
/// take longer than the rest of the run. `felt` is a shell command that succeeds if a message was
/// lost. If it does not succeed after `seconds`, Lack() waits up to 5 s longer before `end`,
/// because a busy machine may send messages late.
/// @return whether a message was lost
bool Lack(const SoakedRun& run, const Machine& machine, const std::string& begin,
          const std::string& end, double seconds, const std::string& felt) {
  constexpr int kTenths = 50;  // longest further wait; a role sends STATUS five times a second
  const Held held(run);
  return machine.Do(fmt::format("{}; kill -CONT {} || true; sleep {:.3f}; hit=no;"
                                "for i in $(seq {}); do if {}; then hit=yes; break; fi; sleep 0.1;"
                                "done; {}; echo $hit",
                                begin, fmt::join(held.processes(), " "), seconds, kTenths, felt,
                                end)) == "yes\n";
}

/// For some time the kernel refuses to send a share of the datagrams: sendto() fails with EPERM.
bool RefuseToSend(const SoakedRun& run, const Machine& machine, double share, double seconds) {
  const int of_1000 = std::max(1, static_cast<int>(1000 * share));
  const std::string which = share < 1 ? fmt::format("numgen random mod 1000 < {}", of_1000) : "";
  return Lack(run, machine,
              fmt::format("nft 'table inet refuse {{ counter refused {{}}; chain output {{"
                          " type filter hook output priority 0;"
                          " meta l4proto udp {} counter name refused drop; }}; }}'",
                          which),
              "nft delete table inet refuse", seconds,
              "! nft list counter inet refuse refused | grep -q 'packets 0 '");
}

bool FailSends(SoakedRun& run, Random& random, const Limits&) {
  return RefuseToSend(run, AMachine(run, random), LogUniform(random, 0.01, 0.1),
                      Uniform(random, 0.2, 2));
}

bool ReloadFirewall(SoakedRun& run, Random& random, const Limits&) {
  return RefuseToSend(run, AMachine(run, random), 1, Uniform(random, 0.1, 1.5));
}

/// Removes an interface, address or route, so that a machine has no route for multicast. The kernel
/// counts the datagrams for which it finds no route (OutNoRoutes).
bool TakeTheWay(const SoakedRun& run, const Machine& machine, const std::string& begin,
                const std::string& end, double seconds) {
  const std::string unrouted = "$(awk '/^Ip: [0-9]/ { print $13 }' /proc/net/snmp)";
  return Lack(run, machine,
              "routes=$(ip route show | grep -v 'proto kernel'); before=" + unrouted + "; " + begin,
              end + "; echo \"$routes\" | while read route; do ip route replace $route; done",
              seconds, "[ " + unrouted + " -gt $before ]");
}

bool TakeInterface(SoakedRun& run, Random& random, const Limits&) {
  return TakeTheWay(run, AMachine(run, random), "ip link set eth0 down", "ip link set eth0 up",
                    Uniform(random, 0.1, 1.5));
}

bool TakeAddress(SoakedRun& run, Random& random, const Limits&) {
  return TakeTheWay(run, AMachine(run, random),
                    "address=$(ip -o -4 addr show dev eth0 | sed 's/.*inet \\([^ ]*\\).*/\\1/');"
                    "ip addr del $address dev eth0",
                    "ip addr add $address dev eth0", Uniform(random, 0.1, 1.5));
}

bool TakeRoute(SoakedRun& run, Random& random, const Limits&) {
  return TakeTheWay(run, AMachine(run, random), "ip route del $(echo \"$routes\" | head -1)",
                    "true", Uniform(random, 0.1, 1.5));
}

bool Partition(SoakedRun& run, Random& random, const Limits& limits) {
  const auto machine = std::uniform_int_distribution<std::size_t>(0, 2)(random);
  run.lab().Unplug(machine);
  Last(LogUniform(random, 0.1, limits.partition_s));
  run.lab().Plug(machine);
  return true;
}

bool Kill(SoakedRun& run, Random& random, const Limits&) { return run.KillARole(random); }
bool Stop(SoakedRun& run, Random& random, const Limits&) { return run.StopARole(random); }
bool Resume(SoakedRun& run, Random&, const Limits&) { return run.KillTheRunnerAndResume(); }

/// All processes stop, one after another, as they do after Ctrl-Z, in a frozen container, or on a
/// sleeping machine.
bool Freeze(SoakedRun& run, Random& random, const Limits& limits) {
  std::vector<pid_t> processes = run.Processes();
  std::ranges::shuffle(processes, random);
  for (const pid_t process : processes) kill(process, SIGSTOP);
  Last(LogUniform(random, std::min(0.5, limits.freeze_s), limits.freeze_s));
  std::ranges::shuffle(processes, random);
  for (const pid_t process : processes) kill(process, SIGCONT);
  return true;
}

bool Anything(SoakedRun& run, Random& random, const Limits& limits) {
  using Strike = bool (*)(SoakedRun&, Random&, const Limits&);
  static constexpr Strike kAny[] = {Kill,          Stop,        FailSends, ReloadFirewall,
                                    TakeInterface, TakeAddress, TakeRoute};
  return kAny[std::uniform_int_distribution<std::size_t>(0, std::size(kAny) - 1)(random)](
      run, random, limits);
}

}  // namespace

std::span<const FaultKind> FaultKinds() {
  constexpr auto kLoopback = SoakedRun::Place::kLoopback;
  constexpr auto kInterface = SoakedRun::Place::kInterface;
  static const FaultKind kKinds[] = {
      {"none", "nothing happens", true, kLoopback, None, nullptr, 0},
      {"loss", "the kernel loses 5 to 40 % of the datagrams", true, kLoopback, None, LoseInput, 1},
      {"network", "messages are lost, doubled, overtaken, delayed", false, kLoopback, BadNetwork,
       nullptr, 0},
      {"kill", "a role is killed", true, kLoopback, None, Kill, 6},
      {"stop", "a role is stopped and does not go on", false, kLoopback, None, Stop, 2},
      {"freeze", "all processes stand still", true, kLoopback, None, Freeze, 1},
      {"send", "1 to 10 % of the sends fail", true, kLoopback, None, FailSends, 4},
      {"firewall", "every send of a machine fails", true, kLoopback, None, ReloadFirewall, 3},
      {"interface", "an interface is down", true, kInterface, None, TakeInterface, 3},
      {"address", "an interface has no address", true, kInterface, None, TakeAddress, 3},
      {"route", "the route to elsewhere is away", true, kInterface, None, TakeRoute, 3},
      {"partition", "a machine's cable is unplugged", true, std::nullopt, None, Partition, 2},
      {"resume", "the runner is killed, another one resumes its log", false, kLoopback, None,
       Resume, 2},
      {"mix", "many of these in one run on a bad network", false, kInterface, BadNetwork, Anything,
       5},
  };
  return kKinds;
}

}  // namespace fogline::test
