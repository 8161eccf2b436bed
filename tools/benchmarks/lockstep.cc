// How much the lockstep costs over what LCM itself costs, side by side in one run.
//
//   udpm: time per step of `fogline run` beside a message that goes round a ring of bare LCM
//   processes,
//         which do nothing but publish what they receive. Once with as many hops as the longest
//         path of a step (world, radar, fusion, acc, arbitrator: 5), once with as many hops as a
//         step has messages (9).
//   memq: time per step beside as many bare publish-and-handle pairs as a step has messages (9).
//
// Rounds of both alternate, so that a busy machine hits both; medians are compared.
#include <lcm/lcm.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "services/graph.h"
#include "services/runtime/bus.h"

namespace fogline {
namespace {

using SteadyClock = std::chrono::steady_clock;

// A run of so many steps beside one of so many more: what starting and ending costs cancels out.
constexpr int kShort = 500;
constexpr int kLong = 10'500;
constexpr int kRounds = 7;
// Bytes of a typical per-step message (RADAR has 73, TRUTH 180).
constexpr std::size_t kPayload = 120;
constexpr int kPathHops = 5;

constexpr int StepMessages() {
  int count = 0;
  for (const ChannelInfo& channel : kChannels) count += channel.pace == Pace::kStep ? 1 : 0;
  return count;
}

double Seconds(SteadyClock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Wall-clock seconds that `fogline run` reports for so many steps.
double RunSeconds(const std::string& transport, int steps) {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::filesystem::path log =
      std::filesystem::temp_directory_path() / fmt::format("fogline-bench-{}.lcm", getpid());
  const std::string command = fmt::format(
      "'{}' run scenario/paper.json --quiet --json --force --transport {} --log '{}' "
      "--set /steps={}",
      (self / "fogline").string(), transport, log.string(), steps);
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start fogline");
  std::string out;
  std::array<char, 4096> buffer{};
  while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    out.append(buffer.data(), size);
  }
  const int status = pclose(pipe);
  std::filesystem::remove(log);
  if (status != 0) throw std::runtime_error("fogline run failed");
  return nlohmann::json::parse(out)["wall_s"];
}

double LockstepStepSeconds(const std::string& transport) {
  return (RunSeconds(transport, kLong) - RunSeconds(transport, kShort)) / (kLong - kShort);
}

/// One bare process of the ring: publishes on the next channel what it receives on its own.
[[noreturn]] void BareHop(const std::string& url, int hop) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  struct Next {
    lcm_t* lcm;
    std::string channel;
  } next{lcm_create(url.c_str()), fmt::format("HOP{}", hop + 1)};
  lcm_subscribe(
      next.lcm, fmt::format("HOP{}", hop).c_str(),
      [](const lcm_recv_buf_t* message, const char*, void* user) {
        const auto* to = static_cast<Next*>(user);
        lcm_publish(to->lcm, to->channel.c_str(), message->data, message->data_size);
      },
      &next);
  while (lcm_handle(next.lcm) == 0) {
  }
  _exit(1);
}

/// Seconds that a message takes once round a ring of `hops` bare LCM processes, this one among
/// them.
double BareRingSeconds(int hops, int rounds) {
  const std::string url = Bus(FreshMulticastUrl()).url();
  std::vector<pid_t> children;
  for (int hop = 0; hop < hops - 1; ++hop) {
    const pid_t pid = fork();
    if (pid == 0) BareHop(url, hop);
    children.push_back(pid);
  }
  lcm_t* lcm = lcm_create(url.c_str());
  int received = 0;
  lcm_subscribe(
      lcm, fmt::format("HOP{}", hops - 1).c_str(),
      [](const lcm_recv_buf_t*, const char*, void* user) { ++*static_cast<int*>(user); },
      &received);
  const std::vector<std::uint8_t> payload(kPayload);
  const auto round = [&] {
    const int before = received;
    lcm_publish(lcm, "HOP0", payload.data(), static_cast<unsigned>(payload.size()));
    while (received == before) {
      // The ring may not be complete yet, and a bare chain repairs nothing.
      if (lcm_handle_timeout(lcm, 100) == 0) {
        lcm_publish(lcm, "HOP0", payload.data(), static_cast<unsigned>(payload.size()));
      }
    }
  };
  constexpr int kWarmUp = 200;
  for (int i = 0; i < kWarmUp; ++i) round();
  const auto began = SteadyClock::now();
  for (int i = 0; i < rounds; ++i) round();
  const double seconds = Seconds(SteadyClock::now() - began) / rounds;
  for (const pid_t pid : children) {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
  lcm_destroy(lcm);
  return seconds;
}

/// Seconds for `hops` messages published and handled one after another over bare memq.
double BareMemqSeconds(int hops, int rounds) {
  lcm_t* lcm = lcm_create("memq://");
  int received = 0;
  lcm_subscribe(
      lcm, "HOP",
      [](const lcm_recv_buf_t*, const char*, void* user) { ++*static_cast<int*>(user); },
      &received);
  const std::vector<std::uint8_t> payload(kPayload);
  const auto began = SteadyClock::now();
  for (int i = 0; i < rounds * hops; ++i) {
    lcm_publish(lcm, "HOP", payload.data(), static_cast<unsigned>(payload.size()));
    lcm_handle(lcm);
  }
  const double seconds = Seconds(SteadyClock::now() - began) / rounds;
  lcm_destroy(lcm);
  return received == rounds * hops ? seconds : throw std::runtime_error("memq lost messages");
}

struct Series {
  std::vector<double> seconds;

  double Median() const {
    std::vector<double> sorted = seconds;
    std::ranges::sort(sorted);
    return sorted[sorted.size() / 2];
  }
  double Quantile(double share) const {
    std::vector<double> sorted = seconds;
    std::ranges::sort(sorted);
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
};

void Print(const std::string& what, const Series& series) {
  fmt::print("  {:<44}{:>10.1f} us   [{:.1f}, {:.1f}]\n", what, 1e6 * series.Median(),
             1e6 * series.Quantile(0.25), 1e6 * series.Quantile(0.75));
}

void PrintRatio(const std::string& what, const Series& ours, const Series& reference, double goal) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ours.seconds.size(); ++i) {
    ratios.push_back(ours.seconds[i] / reference.seconds[i]);
  }
  const Series series{ratios};
  fmt::print("  {:<44}{:>10.2f}      [{:.2f}, {:.2f}]   goal {:.1f}\n", what, series.Median(),
             series.Quantile(0.25), series.Quantile(0.75), goal);
}

int Main() {
  const int messages = StepMessages();
  Series udpm, path, ring, memq, bare_memq;
  for (int round = 0; round < kRounds; ++round) {
    fmt::print(stderr, "\rround {} of {}", round + 1, kRounds);
    udpm.seconds.push_back(LockstepStepSeconds("udpm"));
    path.seconds.push_back(BareRingSeconds(kPathHops, kLong));
    ring.seconds.push_back(BareRingSeconds(messages, kLong));
    memq.seconds.push_back(LockstepStepSeconds("memq"));
    bare_memq.seconds.push_back(BareMemqSeconds(messages, kLong));
  }
  fmt::print(stderr, "\r\033[K");
  fmt::print("time per step: median of {} rounds [quartiles]\n", kRounds);
  Print("lockstep over udpm, nine processes", udpm);
  Print(fmt::format("bare LCM ring, {} hops (longest path)", kPathHops), path);
  Print(fmt::format("bare LCM ring, {} hops (messages per step)", messages), ring);
  Print("lockstep over memq", memq);
  Print(fmt::format("bare memq, {} hops", messages), bare_memq);
  fmt::print("ratios, round by round\n");
  PrintRatio("udpm / bare ring of the longest path", udpm, path, 2.0);
  PrintRatio("udpm / bare ring of all messages", udpm, ring, 2.0);
  PrintRatio("memq / bare memq", memq, bare_memq, 1.5);
  return 0;
}

}  // namespace
}  // namespace fogline

int main() {
  try {
    return fogline::Main();
  } catch (const std::exception& error) {
    fmt::print(stderr, "\nfogline-bench: error: {}\n", error.what());
    return 3;
  }
}
