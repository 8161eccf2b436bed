#include "tools/hosts/remote_host.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/interrupt.h"
#include "common/text.h"
#include "services/runtime/process/version.h"
#include "tools/hosts/host_messages.h"

namespace fogline::hosts {
namespace {

constexpr Duration kSlice = milliseconds(20);
// A machine that can be reached starts a process and answers within this time. The runner waits for
// the answer, so the time is short.
constexpr Duration kStartLimit = milliseconds(5000);
// A machine that has not answered a sign of life for this time counts as out of sight.
constexpr Duration kOutOfSight = 3 * kAliveEvery;

/// A text in a message. Its control characters are escaped, so it is safe to print.
std::string TextIn(const nlohmann::json& message, const char* key) {
  return EscapeControls(message.at(key).get<std::string>());
}

Role RoleIn(const nlohmann::json& message, const char* key) {
  const auto role = RoleNamed(message.at(key).get<std::string>());
  if (!role) throw NotUnderstood("no role: " + message.dump());
  return *role;
}

}  // namespace

RemoteHost::RemoteHost(HostPlan plan, const std::string& ssh)
    : plan_(std::move(plan)), connection_(plan_, ssh) {}

void RemoteHost::Fail(const std::string& why) const {
  throw std::runtime_error(fmt::format("{}: {}", plan_.name, why));
}

template <class Condition>
void RemoteHost::Await(const Condition& done, TimePoint end, const char* what) {
  const TimePoint began = Clock::now();
  while (!done()) {
    if (WasInterrupted()) {
      throw Interrupted(fmt::format("interrupted while waiting for {}", plan_.name));
    }
    connection_.lines().Wait(std::min(kSlice, end - Clock::now()));
    Look();
    if (done()) return;
    if (!lost_.empty()) Fail(lost_);
    if (Clock::now() < end) continue;
    Fail(fmt::format("no {} within {:.0f} s", what, Seconds(end - began)));
  }
}

void RemoteHost::Greet(TimePoint end) {
  Await([this] { return !version_.empty(); }, end, "answer of fogline host");
  if (version_ == runtime::VersionText()) return;
  Fail(fmt::format("fogline there is {}, here {}: install the same version on both", version_,
                   runtime::VersionText()));
}

void RemoteHost::BeginCheck(const RunOnHost& run) {
  problems_.reset();
  connection_.lines().Send({{kCheck, run.url}, {kKey, run.key}, {kSilence, run.silence_s}});
}

void RemoteHost::EndCheck(TimePoint end) {
  Await([this] { return problems_.has_value(); }, end, "result of its check");
  if (!problems_->empty()) Fail(*problems_);
}

pid_t RemoteHost::StartRole(Role role, const std::vector<std::string>& arguments) {
  // A restart must not delay the runner while the machine is out of sight. The first start may
  // wait.
  const bool again = !ordered_.insert(role).second;
  starts_.erase(role);
  if (const std::string why = WhyOutOfSight(); again && !why.empty()) throw std::runtime_error(why);
  connection_.lines().Send({{kStart, NameOf(role)}, {kArguments, arguments}});
  Await([this, role] { return starts_.contains(role); }, Clock::now() + kStartLimit,
        "answer to the start of a role");
  const nlohmann::json answer = starts_[role];
  if (answer.contains(kWhy)) Fail(TextIn(answer, kWhy));
  return answer.at(kPid).get<pid_t>();
}

void RemoteHost::Look() {
  if (!lost_.empty()) return;
  const TimePoint now = Clock::now();
  if (now >= alive_at_ && !version_.empty()) {
    connection_.lines().Send({{kAlive, true}});
    alive_at_ = now + kAliveEvery;
    if (!asked_since_) asked_since_ = now;
  }
  connection_.Look();
  try {
    while (true) {
      if (version_.empty()) {  // the shell of the machine may first print lines
        const auto line = connection_.lines().TakeLine();
        if (!line) break;
        const auto message = nlohmann::json::parse(*line, nullptr, false);
        if (!message.is_object() || !message.contains(kHello)) {
          connection_.Keep(*line);
          continue;
        }
        Take(message);
      } else if (const auto message = connection_.lines().Take()) {
        Take(*message);
      } else {
        break;
      }
    }
  } catch (const nlohmann::json::exception& error) {
    return Lose(error.what());
  } catch (const NotUnderstood& error) {
    return Lose(error.what());
  }
  if (!connection_.open()) Lose();
}

void RemoteHost::Take(const nlohmann::json& message) {
  asked_since_.reset();
  if (message.contains(kHello)) {
    version_ = TextIn(message, kHello);
    host_ = TextIn(message, kHost);
    own_address_ = TextIn(message, kRunner);
  } else if (message.contains(kProblems)) {
    std::string text;
    for (const nlohmann::json& problem : message.at(kProblems)) {
      text +=
          fmt::format("{}{}", text.empty() ? "" : "; ", EscapeControls(problem.get<std::string>()));
    }
    problems_ = text;
  } else if (message.contains(kStarted)) {
    OnStarted(message);
  } else if (message.contains(kEnded)) {
    OnEnded(message);
  } else if (message.contains(kAlive)) {
    OnAlive(message);
  } else {
    throw NotUnderstood("unknown: " + QuoteShort(message.dump()));
  }
}

void RemoteHost::OnStarted(const nlohmann::json& message) {
  const Role role = RoleIn(message, kStarted);
  starts_[role] = message;
  if (message.contains(kPid)) processes_[message.at(kPid).get<pid_t>()] = {.role = role};
}

void RemoteHost::OnEnded(const nlohmann::json& message) {
  const auto pid = message.at(kPid).get<pid_t>();
  if (processes_.erase(pid) == 0) return;
  Exit exit{.role = RoleIn(message, kEnded),
            .pid = pid,
            .how = TextIn(message, kHow),
            .killed = message.at(kKilled).get<bool>(),
            .lines = {}};
  for (const nlohmann::json& line : message.at(kLines)) {
    exit.lines.push_back(EscapeControls(line.get<std::string>()));
  }
  exits_.push_back(std::move(exit));
}

void RemoteHost::OnAlive(const nlohmann::json& message) {
  for (const nlohmann::json& one : message.at(kAlive)) {
    const auto process = processes_.find(one.at(0).get<pid_t>());
    if (process != processes_.end()) process->second.activity = one.at(1).get<std::int64_t>();
  }
}

void RemoteHost::Lose(const std::string& nonsense) {
  std::vector<std::string> lines = connection_.TakeLines();
  std::string why;
  if (connection_.open()) {
    why = "what came is no message of fogline host: " + EscapeControls(nonsense);
    connection_.End(Duration::zero());
  } else {
    why = connection_.HowItEnded(lines);
  }
  lost_ = why;
  for (std::string& line : lines) {
    if (line.ends_with('\r')) line.pop_back();  // ssh ends its lines with CR and LF
    line = EscapeControls(line);
    lost_ += fmt::format("\n  {}: {}", plan_.name, line);
  }
  for (const auto& [pid, process] : std::exchange(processes_, {})) {
    exits_.push_back({.role = process.role,
                      .pid = pid,
                      .how = fmt::format("lost its connection ({})", why),
                      .killed = false,
                      .lines = lines});
  }
}

std::vector<processes::RolePlace::Exit> RemoteHost::Collect() {
  Look();
  return std::exchange(exits_, {});
}

std::string RemoteHost::Describe() const {
  std::string text;
  for (const auto& [pid, process] : processes_) {
    text += fmt::format("{}{} {} on {}", text.empty() ? "" : ", ", NameOf(process.role), pid,
                        plan_.name);
  }
  return text;
}

void RemoteHost::Kill(pid_t pid) {
  if (processes_.contains(pid)) connection_.lines().Send({{kKill, pid}});
}

std::optional<std::int64_t> RemoteHost::ActivityOf(pid_t pid) {
  const auto process = processes_.find(pid);
  return process == processes_.end() ? std::nullopt : process->second.activity;
}

std::string RemoteHost::WhyOutOfSight() const {
  if (!lost_.empty()) return fmt::format("the connection to {} has ended", plan_.name);
  const Duration silent = asked_since_ ? Clock::now() - *asked_since_ : Duration::zero();
  if (silent < kOutOfSight) return "";
  return fmt::format("{} has not answered for {:.1f} s", plan_.name, Seconds(silent));
}

}  // namespace fogline::hosts
