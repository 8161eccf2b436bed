#include "tools/hosts/host_agent.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/clock.h"
#include "common/interrupt.h"
#include "common/own_pauses.h"
#include "common/process/console.h"
#include "common/process/this_process.h"
#include "services/runtime/process/version.h"
#include "tools/hosts/host_messages.h"
#include "tools/hosts/json_lines.h"
#include "tools/hosts/run_plan.h"
#include "tools/processes/process_group.h"

namespace fogline::hosts {
namespace {

// Interval at which the agent looks for processes that have ended, while no order comes.
constexpr Duration kCollectEvery = milliseconds(20);

/// A file in memory that only this user can read. The destructor closes the file, which deletes it.
class SecretFile {
 public:
  /// @throws std::runtime_error
  explicit SecretFile(const std::string& text) : file_(memfd_create("key", MFD_CLOEXEC)) {
    const bool good = file_ >= 0 && fchmod(file_, S_IRUSR | S_IWUSR) == 0 &&
                      write(file_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    if (!good) throw std::runtime_error(fmt::format("no memory file: {}", std::strerror(errno)));
  }
  ~SecretFile() { close(file_); }
  SecretFile(const SecretFile&) = delete;
  SecretFile& operator=(const SecretFile&) = delete;
  /// The name by which a child opens the file.
  std::string path() const { return fmt::format("/proc/{}/fd/{}", getpid(), file_); }

 private:
  int file_;
};

/// The address from which ssh has connected: the first word of SSH_CONNECTION, see ssh(1).
std::string RunnerAddress() {
  const char* connection = std::getenv("SSH_CONNECTION");
  const std::string words = connection == nullptr ? "" : connection;
  return words.substr(0, words.find(' '));
}

class HostAgent {
 public:
  explicit HostAgent(const NetworkCheck& check)
      : check_(check), lines_(STDIN_FILENO, STDOUT_FILENO), pauses_(Clock::now()) {}

  void Serve() {
    lines_.Send(
        {{kHello, runtime::VersionText()}, {kHost, HostName()}, {kRunner, RunnerAddress()}});
    TimePoint heard = Clock::now();
    while (!WasInterrupted() && !lines_.ended()) {
      lines_.Wait(kCollectEvery);
      const TimePoint now = pauses_.Attend(Clock::now());
      while (const auto order = lines_.Take()) {
        heard = now;
        Obey(*order);
      }
      Report();
      if (pauses_.HeldAgainst(heard, now) <= silence_) continue;
      throw std::runtime_error(
          fmt::format("the runner has been silent for {:.0f} s", Seconds(silence_)));
    }
  }

 private:
  void Obey(const nlohmann::json& order) {
    try {
      if (order.contains(kAlive)) {
        SendActivity();
      } else if (order.contains(kCheck)) {
        Check(order);
      } else if (order.contains(kStart)) {
        Start(order);
      } else if (order.contains(kKill)) {
        roles_.Kill(order.at(kKill).get<pid_t>());
      } else {
        throw NotUnderstood("no order");
      }
    } catch (const nlohmann::json::exception& error) {
      throw NotUnderstood(error.what());
    }
  }

  void Check(const nlohmann::json& order) {
    silence_ = duration_cast<Duration>(std::chrono::duration<double>(order.at(kSilence)));
    const auto key = order.at(kKey).get<std::string>();
    key_ = key.empty() ? nullptr : std::make_unique<SecretFile>(key);
    lines_.Send({{kProblems, check_(order.at(kCheck).get<std::string>())}});
  }

  void Start(const nlohmann::json& order) {
    const auto name = order.at(kStart).get<std::string>();
    const auto role = RoleNamed(name);
    if (!role) throw NotUnderstood("no role: " + name);
    auto arguments = order.at(kArguments).get<std::vector<std::string>>();
    if (key_) arguments.insert(arguments.end(), {"--key", key_->path()});
    // If the answer to an earlier order has not reached the runner, the process of this earlier
    // order may still run. The agent kills this process.
    if (const auto before = pids_.find(*role); before != pids_.end()) roles_.Kill(before->second);
    try {
      pids_[*role] = roles_.StartRole(*role, arguments);
      lines_.Send({{kStarted, name}, {kPid, pids_[*role]}});
    } catch (const std::runtime_error& error) {
      lines_.Send({{kStarted, name}, {kWhy, error.what()}});
    }
  }

  /// Tells the runner which processes have ended.
  void Report() {
    for (const processes::RolePlace::Exit& exit : roles_.Collect()) {
      if (pids_[exit.role] == exit.pid) pids_.erase(exit.role);
      lines_.Send({{kEnded, NameOf(exit.role)},
                   {kPid, exit.pid},
                   {kHow, exit.how},
                   {kKilled, exit.killed},
                   {kLines, exit.lines}});
    }
  }

  void SendActivity() {
    nlohmann::json all = nlohmann::json::array();
    for (const auto& [role, pid] : pids_) {
      if (const auto activity = roles_.ActivityOf(pid)) {
        all.push_back(nlohmann::json::array({pid, *activity}));
      }
    }
    lines_.Send({{kAlive, std::move(all)}});
  }

  const NetworkCheck& check_;
  JsonLines lines_;
  OwnPauses pauses_;
  Duration silence_ = std::chrono::seconds(60);  // until the runner sends its limit
  std::unique_ptr<SecretFile> key_;
  std::map<Role, pid_t> pids_;
  processes::ProcessGroup roles_;
};

}  // namespace

void ServeRunner(const NetworkCheck& check) {
  WatchInterrupts();
  // If the runner has ended, SIGPIPE must not end this process before its roles. The handler does
  // nothing. SIG_IGN is not used, because the roles would inherit it.
  struct sigaction nothing {};
  nothing.sa_handler = [](int) {};
  sigaction(SIGPIPE, &nothing, nullptr);
  HostAgent(check).Serve();
}

}  // namespace fogline::hosts
