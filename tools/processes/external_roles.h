// Roles of a run that are started elsewhere: the commands that start them, and the time limit for
// them.
#pragma once

#include <string>
#include <vector>

#include "services/runtime/coordination/run_coordinator.h"
#include "services/runtime/transport/traffic_options.h"

namespace fogline::processes {

class ExternalRoles {
 public:
  /// @param url network of the run
  /// @param limit time in which all these roles must be ready; 0: no limit
  ExternalRoles(std::string url, const runtime::TrafficOptions& traffic, Duration limit)
      : url_(std::move(url)), key_file_(traffic.key_file), limit_(limit), began_(Clock::now()) {}

  /// The time limit as text: "60 s", or "for ever".
  std::string Limit() const;
  /// The command that starts a role for this run, such as
  /// "fogline-driver --lcm-url 'udpm://239.255.76.67:7700?ttl=0'".
  std::string Command(Role role) const;
  /// A line for each role, without the last line feed. The line says that the run waits for the
  /// role, for how long, and which command starts the role.
  std::string Text(const std::vector<Role>& roles) const;

  /// Ends the run after the time limit, with the names of the missing roles.
  void Check(runtime::RunCoordinator& coordinator, TimePoint now) const;

 private:
  std::string url_;
  std::string key_file_;
  Duration limit_;
  TimePoint began_;
};

}  // namespace fogline::processes
