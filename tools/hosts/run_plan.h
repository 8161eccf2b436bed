// The plan of a run: the roles that are started on other machines, from the command line and from a
// laboratory's file.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sections/plans/lab.h"
#include "services/graph.h"

namespace fogline::hosts {

/// Another machine.
struct HostPlan {
  std::string name;         // for messages to the user
  std::string destination;  // for ssh: [USER@]HOST, or a name of ssh's configuration
  std::string programs;     // folder of Fogline's programs on the machine; "": the machine's PATH
  bool operator==(const HostPlan&) const = default;
};

struct RunPlan {
  std::vector<HostPlan> hosts;
  std::map<Role, std::size_t> places;  // index in `hosts` of each role on another machine
  std::string ssh;                     // command with its options, for a shell
  bool relay = false;                  // whether messages go through a relay on this machine
  std::string relay_at;                // ADDRESS[:PORT] of the relay; "": this machine's address,
                                       // as the others see it
  std::string url;                     // network of the laboratory; "": the file names none
  std::string key_file;                // key of the laboratory; "": the file names none
  std::vector<std::string> words;      // options for this plan in the command that resumes the run

  bool empty() const { return places.empty(); }
};

/// The options of a command line from which MakePlan() makes a RunPlan.
struct PlanWords {
  std::vector<std::string> on;  // ROLE=HOST or ROLE=HOST:FOLDER
  std::string lab;              // file of a laboratory
  std::string ssh;
  bool relay = false;
  std::string relay_at;
};

/// The role with this name; nullopt if there is none.
std::optional<Role> RoleNamed(std::string_view name);

/// The reason why a role with this name cannot run on another machine; "" if it can.
std::string WhyNoRemoteRole(std::string_view name);

/// The machine of "HOST" or "HOST:FOLDER", where FOLDER begins with / or ~/.
/// @throws InputError if the text names no machine
HostPlan ReadHost(std::string_view text, std::string_view where);

/// Checks a destination for ssh. ssh would read a destination that begins with - as an option.
/// @return the fault of the destination; "" if it has none
std::string WhyNoDestination(std::string_view destination);

/// Makes the plan of a run. --on takes precedence over the role's place in the laboratory's file.
/// HOST in --on may be the name of a machine in this file.
/// @throws InputError
RunPlan MakePlan(const PlanWords& words);

}  // namespace fogline::hosts
