// A relay for one run: fogline-relay on a free port of this machine, started again there when it is
// killed, gone with this object.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "services/runtime/conductor.h"
#include "services/runtime/restart_policy.h"

namespace fogline {

class RelayProcess {
 public:
  /// Starts it and waits until it listens.
  /// @param restarts how often, at most, it is started again @throws std::runtime_error
  explicit RelayProcess(int restarts);
  ~RelayProcess();
  RelayProcess(const RelayProcess&) = delete;
  RelayProcess& operator=(const RelayProcess&) = delete;

  const std::string& url() const { return url_; }

  /// Sees whether it has died, and starts it again when its time has come. Call it every few tens
  /// of milliseconds.
  /// @return what to tell a person, "" if there is nothing
  /// @throws std::runtime_error if it is not to be started again
  std::string Look(const Conductor& run, TimePoint now);

  /// How often it was started again, and how it had ended the last time.
  int restarts() const { return policy_.restarts(); }
  const std::string& death() const { return death_; }

 private:
  /// @return the line that it prints when it listens
  std::string Start(const std::string& place);
  void End();

  RestartPolicy policy_;
  pid_t pid_ = -1;
  pid_t dead_ = -1;  // the last one
  std::string url_;
  std::string death_{};
  std::optional<TimePoint> start_at_{};
};

}  // namespace fogline
