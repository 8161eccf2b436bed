#include "tools/benchmarks/bare_lcm.h"

#include <lcm/eventlog.h>
#include <lcm/lcm.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <fmt/core.h>

#include "services/graph.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tools/benchmarks/program.h"

namespace fogline::benchmarks {
namespace {

// Bytes of a typical per-step message (RADAR has 73, TRUTH 180). The first eight bytes are the
// step.
constexpr unsigned kPayloadBytes = 120;
using Payload = std::array<std::uint8_t, kPayloadBytes>;

// Number of steps before the measurement starts. Every process joins the network during these
// steps.
constexpr int kWarmUpSteps = 200;
// A bare network does not send lost messages again. So the first process repeats a step's messages
// if it has received no message for this time.
constexpr int kRepeatAfter_ms = 100;

/// One process of a bare network.
class BareProcess {
 public:
  BareProcess(const std::string& url, const BareRole& role)
      : lcm_(lcm_create(url.c_str())), outputs_(role.outputs) {
    if (lcm_ == nullptr) throw std::runtime_error("LCM cannot open " + url);
    for (const std::string& channel : role.inputs) {
      inputs_.push_back(std::make_unique<Input>(Input{this, -1}));
      lcm_subscribe(lcm_, channel.c_str(), &BareProcess::OnMessage, inputs_.back().get());
    }
  }
  ~BareProcess() { lcm_destroy(lcm_); }
  BareProcess(const BareProcess&) = delete;
  BareProcess& operator=(const BareProcess&) = delete;

  void Publish(std::int64_t step) {
    std::memcpy(payload_.data(), &step, sizeof(step));
    for (const std::string& channel : outputs_) {
      lcm_publish(lcm_, channel.c_str(), payload_.data(), kPayloadBytes);
    }
  }

  bool Has(std::int64_t step) const {
    return std::ranges::all_of(inputs_, [step](const auto& input) { return input->step == step; });
  }

  /// Begins a step, and waits until messages of this step have arrived on all inputs of this
  /// process.
  void Lead(std::int64_t step) {
    answers_ = false;
    Publish(step);
    while (!Has(step)) {
      if (lcm_handle_timeout(lcm_, kRepeatAfter_ms) == 0) Publish(step);
    }
  }

  /// Answers messages until the process is killed.
  [[noreturn]] void Follow() {
    while (lcm_handle(lcm_) == 0) {
    }
    _exit(1);
  }

 private:
  struct Input {
    BareProcess* self;
    std::int64_t step;
  };

  static void OnMessage(const lcm_recv_buf_t* message, const char* /*channel*/, void* user) {
    auto* input = static_cast<Input*>(user);
    std::memcpy(&input->step, message->data, sizeof(input->step));
    BareProcess& self = *input->self;
    if (self.answers_ && self.Has(input->step)) self.Publish(input->step);
  }

  lcm_t* lcm_;
  std::vector<std::string> outputs_;
  std::vector<std::unique_ptr<Input>> inputs_;
  Payload payload_{};
  bool answers_ = true;
};

/// Child processes; the destructor kills them.
class Children {
 public:
  Children() = default;
  ~Children() {
    for (const pid_t pid : pids_) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
  }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  void Start(const std::string& url, const BareRole& role) {
    const pid_t pid = fork();
    if (pid < 0) throw std::runtime_error("cannot start a process");
    if (pid == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      BareProcess(url, role).Follow();
    }
    pids_.push_back(pid);
  }

 private:
  std::vector<pid_t> pids_;
};

}  // namespace

std::vector<BareRole> BareRing(int hops) {
  std::vector<BareRole> roles;
  for (int hop = 0; hop < hops; ++hop) {
    roles.push_back({.inputs = {fmt::format("HOP{}", (hop + hops - 1) % hops)},
                     .outputs = {fmt::format("HOP{}", hop)}});
  }
  return roles;
}

std::vector<BareRole> BareGraph() {
  std::vector<BareRole> roles;
  for (const RoleInfo& info : kRoles) {
    BareRole& role = roles.emplace_back();
    for (const ChannelInfo& channel : kChannels) {
      if (channel.pace != Pace::kStep) continue;
      const bool recorded = info.role == Role::kRecorder;
      if (channel.to.Has(info.role) || recorded) role.inputs.emplace_back(channel.name);
      if (channel.from == info.role) role.outputs.emplace_back(channel.name);
    }
  }
  return roles;
}

double BareNetworkStepSeconds(const std::vector<BareRole>& roles, int steps) {
  // The URL has a private port, and a receive buffer that is large enough for bursts, as in a run
  // of Fogline.
  const std::string url = runtime::Bus(runtime::FreshMulticastUrl()).url();
  Children children;
  for (std::size_t i = 1; i < roles.size(); ++i) children.Start(url, roles[i]);
  BareProcess first(url, roles.front());
  std::int64_t step = 0;
  while (step < kWarmUpSteps) first.Lead(step++);
  const double wall_s = SecondsOf([&] {
    for (int i = 0; i < steps; ++i) first.Lead(step++);
  });
  return wall_s / steps;
}

double BareMemqStepSeconds(int hops, int steps) {
  lcm_t* lcm = lcm_create("memq://");
  int received = 0;
  lcm_subscribe(
      lcm, "HOP",
      [](const lcm_recv_buf_t*, const char*, void* user) { ++*static_cast<int*>(user); },
      &received);
  const Payload payload{};
  const double wall_s = SecondsOf([&] {
    for (int i = 0; i < steps * hops; ++i) {
      lcm_publish(lcm, "HOP", payload.data(), kPayloadBytes);
      lcm_handle(lcm);
    }
  });
  lcm_destroy(lcm);
  if (received != steps * hops) throw std::runtime_error("memq lost messages");
  return wall_s / steps;
}

double BareLogReadSeconds(const std::filesystem::path& log) {
  return SecondsOf([&log] {
    lcm_eventlog_t* reader = lcm_eventlog_create(log.c_str(), "r");
    if (reader == nullptr) throw std::runtime_error("LCM cannot read " + log.string());
    while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(reader)) {
      lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(reader);
  });
}

}  // namespace fogline::benchmarks
