#include "tests/soak/faults.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include <fmt/format.h>

namespace fogline::test {
namespace {

using Random = std::mt19937_64;

double Uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}
/// A positive value between two others; every decade is equally likely.
double LogUniform(Random& random, double low, double high) {
  return std::exp(Uniform(random, std::log(low), std::log(high)));
}
/// Waits: the fault lasts so long.
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

void LoseInput(SoakedRun& run, Random& random, const Limits&) {
  const int per_cent = static_cast<int>(Uniform(random, 5, 40));
  for (const Machine* machine : run.machines()) machine->LoseUdp(per_cent);
}

/// For some time the kernel refuses to send a share of the datagrams: sendto() fails with EPERM.
void RefuseToSend(const Machine& machine, double share, double seconds) {
  const int of_1000 = std::max(1, static_cast<int>(1000 * share));
  const std::string which = share < 1 ? fmt::format("numgen random mod 1000 < {}", of_1000) : "";
  machine.Do(
      fmt::format("nft 'table inet refuse {{ chain output {{ type filter hook output priority 0;"
                  " meta l4proto udp {} drop; }}; }}'; sleep {:.3f}; nft delete table inet refuse",
                  which, seconds));
}

void FailSends(SoakedRun& run, Random& random, const Limits&) {
  RefuseToSend(AMachine(run, random), LogUniform(random, 0.001, 0.1), Uniform(random, 0.2, 2));
}

void ReloadFirewall(SoakedRun& run, Random& random, const Limits&) {
  RefuseToSend(AMachine(run, random), 1, Uniform(random, 0.1, 1.5));
}

void TakeInterface(SoakedRun& run, Random& random, const Limits&) {
  AMachine(run, random)
      .Do(fmt::format("routes=$(ip route show | grep -v 'proto kernel');"
                      "ip link set eth0 down; sleep {:.3f}; ip link set eth0 up;"
                      "echo \"$routes\" | while read route; do ip route replace $route; done",
                      Uniform(random, 0.1, 1.5)));
}

void TakeAddress(SoakedRun& run, Random& random, const Limits&) {
  AMachine(run, random)
      .Do(fmt::format("routes=$(ip route show | grep -v 'proto kernel');"
                      "address=$(ip -o -4 addr show dev eth0 | sed 's/.*inet \\([^ ]*\\).*/\\1/');"
                      "ip addr del $address dev eth0; sleep {:.3f}; ip addr add $address dev eth0;"
                      "echo \"$routes\" | while read route; do ip route replace $route; done",
                      Uniform(random, 0.1, 1.5)));
}

void TakeRoute(SoakedRun& run, Random& random, const Limits&) {
  AMachine(run, random)
      .Do(fmt::format("route=$(ip route show | grep -v 'proto kernel' | head -1);"
                      "ip route del $route; sleep {:.3f}; ip route add $route",
                      Uniform(random, 0.1, 1.5)));
}

void Partition(SoakedRun& run, Random& random, const Limits& limits) {
  const auto machine = std::uniform_int_distribution<std::size_t>(0, 2)(random);
  run.lab().Unplug(machine);
  Last(LogUniform(random, 0.1, limits.partition_s));
  run.lab().Plug(machine);
}

void Kill(SoakedRun& run, Random& random, const Limits&) { run.KillARole(random); }
void Stop(SoakedRun& run, Random& random, const Limits&) { run.StopARole(random); }
void Resume(SoakedRun& run, Random&, const Limits&) { run.KillTheRunnerAndResume(); }

/// All processes stop, one after another, as by Ctrl-Z, in a frozen container or on a sleeping
/// machine.
void Freeze(SoakedRun& run, Random& random, const Limits& limits) {
  std::vector<pid_t> processes = run.Processes();
  std::ranges::shuffle(processes, random);
  for (const pid_t process : processes) kill(process, SIGSTOP);
  Last(LogUniform(random, std::min(0.5, limits.freeze_s), limits.freeze_s));
  std::ranges::shuffle(processes, random);
  for (const pid_t process : processes) kill(process, SIGCONT);
}

void Anything(SoakedRun& run, Random& random, const Limits& limits) {
  using Strike = void (*)(SoakedRun&, Random&, const Limits&);
  static constexpr Strike kAny[] = {Kill,          Stop,        FailSends, ReloadFirewall,
                                    TakeInterface, TakeAddress, TakeRoute};
  kAny[std::uniform_int_distribution<std::size_t>(0, std::size(kAny) - 1)(random)](run, random,
                                                                                   limits);
}

}  // namespace

std::span<const FaultKind> FaultKinds() {
  static const FaultKind kKinds[] = {
      {"none", "nothing happens", true, true, None, nullptr, 0},
      {"loss", "the kernel loses 5 to 40 % of the datagrams", true, true, None, LoseInput, 1},
      {"network", "messages are lost, doubled, overtaken, delayed", false, true, BadNetwork,
       nullptr, 0},
      {"kill", "a role is killed", true, true, None, Kill, 6},
      {"stop", "a role is stopped and does not go on", false, true, None, Stop, 2},
      {"freeze", "all processes stand still", true, true, None, Freeze, 1},
      {"send", "0.1 to 10 % of the sends fail", true, true, None, FailSends, 4},
      {"firewall", "every send of a machine fails", true, true, None, ReloadFirewall, 3},
      {"interface", "an interface is down", true, true, None, TakeInterface, 3},
      {"address", "an interface has no address", true, true, None, TakeAddress, 3},
      {"route", "the route to elsewhere is away", true, true, None, TakeRoute, 3},
      {"partition", "a machine's cable is unplugged", true, false, None, Partition, 2},
      {"resume", "the runner is killed, another one resumes its log", false, true, None, Resume, 2},
      {"mix", "many of these in one run on a bad network", false, true, BadNetwork, Anything, 5},
  };
  return kKinds;
}

}  // namespace fogline::test
