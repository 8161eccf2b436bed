// The other machines of a run. The destructor ends the roles on these machines.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/runtime/transport/traffic_options.h"
#include "tools/hosts/remote_host.h"
#include "tools/hosts/run_plan.h"

namespace fogline::hosts {

class HostGroup {
 public:
  /// Connects to all machines at the same time, and compares versions.
  /// @throws std::runtime_error with the name of a machine that cannot take part; Interrupted
  explicit HostGroup(const RunPlan& plan);

  /// ADDRESS:PORT at which the relay of the run must listen; port 0: any free port.
  /// @throws std::runtime_error if the other machines see this machine at different addresses, or
  ///     at one of IPv6
  std::string RelayPlace() const;
  /// Gives the key of the run to every machine. Each machine then checks whether it reaches the
  /// network of the run.
  /// @param silence a machine ends its roles if no message of the runner comes for this time
  /// @throws std::runtime_error with the name of a machine and its problem; InputError if the key
  ///     cannot be read; Interrupted
  void Check(const std::string& url, const runtime::TrafficOptions& traffic, Duration silence);

  /// Sends signs of life to the machines, and handles their messages. Call KeepAlive() repeatedly
  /// while the runner waits, otherwise the machines end their roles.
  void KeepAlive() const;

  /// The machine of a role; nullptr: this machine.
  processes::RolePlace* PlaceOf(Role role) const;
  /// All machines.
  std::vector<processes::RolePlace*> places() const;

 private:
  RunPlan plan_;
  std::vector<std::unique_ptr<RemoteHost>> hosts_;
};

/// Connects to the other machines of a run; nullptr if the run has none. @throws like HostGroup()
std::unique_ptr<HostGroup> Connect(const RunPlan& plan);

}  // namespace fogline::hosts
