// Roles of a run that are started elsewhere: the commands that start them, and the time limit for
// them.
#pragma once

#include <set>
#include <string>
#include <string_view>
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
  std::string Command(Role role) const { return Command(NameOf(role)); }
  /// The text that says for which roles the run waits, for how long, and which command starts a
  /// role; "" without roles. Several roles share one command, in which ROLE stands for the name of
  /// the role.
  std::string Text(const std::vector<Role>& roles) const;
  /// A text that says which of these roles have come or gone since the last call, and which are
  /// missing; "" if nothing has changed, or the run has begun.
  std::string News(const std::vector<Role>& roles, const runtime::RunCoordinator& coordinator,
                   TimePoint now);

  /// If a role is still missing after the time limit, ends the run. The error names the missing
  /// roles.
  void Check(runtime::RunCoordinator& coordinator, TimePoint now) const;

 private:
  std::string Command(std::string_view role) const;

  std::string url_;
  std::string key_file_;
  Duration limit_;
  TimePoint began_;
  std::set<Role> come_;  // the roles whose arrival News() has reported
};

}  // namespace fogline::processes
