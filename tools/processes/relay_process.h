// A relay for one run: fogline-relay on this machine. If the relay ends, a new one is started at
// the same address. The destructor ends the relay.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "services/runtime/coordination/restart_policy.h"
#include "services/runtime/coordination/run_coordinator.h"

namespace fogline::processes {

class RelayProcess {
 public:
  /// Starts the relay and waits until it listens.
  /// @param restarts maximum number of restarts
  /// @param place ADDRESS:PORT at which it listens; port 0: any free port
  /// @throws std::runtime_error
  explicit RelayProcess(int restarts, const std::string& place = "127.0.0.1:0");
  ~RelayProcess();
  RelayProcess(const RelayProcess&) = delete;
  RelayProcess& operator=(const RelayProcess&) = delete;

  const std::string& url() const { return url_; }

  /// Checks whether the relay has ended, and restarts it after a delay. Call it every few tens of
  /// milliseconds.
  /// @return a message for the user; "" if there is none
  /// @throws std::runtime_error if no restart is left
  std::string Look(const runtime::RunCoordinator& run, TimePoint now);

  /// Number of restarts, and how the last relay ended.
  int restarts() const { return policy_.restarts(); }
  const std::string& death() const { return death_; }

 private:
  /// @return the line that the relay prints when it listens
  std::string Start(const std::string& place);
  void End();

  runtime::RestartPolicy policy_;
  pid_t pid_ = -1;
  pid_t dead_ = -1;  // process id of the last relay that ended
  std::string url_;
  std::string death_{};
  std::optional<TimePoint> start_at_{};
};

}  // namespace fogline::processes
