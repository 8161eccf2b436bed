// Starts and watches roles on another machine of a run, through `fogline host`. The destructor ends
// the roles.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/clock.h"
#include "tools/hosts/ssh_connection.h"
#include "tools/processes/role_place.h"

namespace fogline::hosts {

/// The data of a run that a machine needs before it starts roles.
struct RunOnHost {
  std::string url;
  std::string key;  // text of the key's file; "": messages are not signed
  double silence_s =
      60;  // the machine ends its roles if it hears nothing of the runner for this time
};

class RemoteHost : public processes::RolePlace {
 public:
  /// Begins to connect. Does not wait. @throws std::runtime_error
  RemoteHost(HostPlan plan, const std::string& ssh);

  /// Waits until the machine answers, and compares versions.
  /// @throws std::runtime_error with the name of the machine if it does not answer until `end`, or
  ///     has another version; Interrupted
  void Greet(TimePoint end);
  /// Asks the machine to check whether it reaches the network of the run. Does not wait.
  void BeginCheck(const RunOnHost& run);
  /// Waits for the result of the check. @throws std::runtime_error with the problems of that
  /// machine; Interrupted
  void EndCheck(TimePoint end);
  /// Sends a sign of life if it is due, and handles the messages that have come.
  void Look();
  /// The address of the runner's machine, as the other machine sees it; "" if unknown.
  const std::string& own_address() const { return own_address_; }

  const std::string& host() const override { return host_; }
  const std::string& name() const override { return plan_.name; }
  pid_t StartRole(Role role, const std::vector<std::string>& arguments) override;
  std::vector<Exit> Collect() override;
  bool empty() const override { return processes_.empty(); }
  std::string Describe() const override;
  void Kill(pid_t pid) override;
  std::optional<std::int64_t> ActivityOf(pid_t pid) override;
  std::string WhyOutOfSight() const override;

 private:
  struct Process {
    Role role;
    std::optional<std::int64_t> activity{};
  };
  /// Handles one message.
  /// @throws NotUnderstood, nlohmann::json::exception if the message is not one of host_messages.h
  void Take(const nlohmann::json& message);
  void OnStarted(const nlohmann::json& message);
  void OnEnded(const nlohmann::json& message);
  void OnAlive(const nlohmann::json& message);
  /// Waits until `done` holds. @throws like Greet()
  template <class Condition>
  void Await(const Condition& done, TimePoint end, const char* what);
  /// Counts all processes of the machine as ended, because the connection has ended or a message is
  /// invalid.
  void Lose(const std::string& nonsense = "");
  [[noreturn]] void Fail(const std::string& why) const;

  HostPlan plan_;
  SshConnection connection_;
  std::string version_;  // "" until the machine has answered
  std::string host_;
  std::string own_address_;
  std::optional<std::string> problems_;  // result of the check; "": no problem
  std::map<pid_t, Process> processes_;
  std::set<Role> ordered_;                 // roles whose start was ordered before
  std::map<Role, nlohmann::json> starts_;  // for each role, the answer to its last start order
  std::vector<Exit> exits_;
  std::string lost_;                      // why the connection has ended; "" while it is open
  std::optional<TimePoint> asked_since_;  // time of the oldest unanswered sign of life
  TimePoint alive_at_{};
};

}  // namespace fogline::hosts
