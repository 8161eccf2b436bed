// Which roles of a run are started on which other machines, as the command line and a laboratory's
// file say.
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
  std::string name;         // in messages for the user
  std::string destination;  // for ssh: [USER@]HOST, or a name of ssh's configuration
  std::string programs;     // folder of Fogline's programs there; "": the PATH there
  bool operator==(const HostPlan&) const = default;
};

struct RunPlan {
  std::vector<HostPlan> hosts;
  std::map<Role, std::size_t> places;  // index in `hosts` of each role on another machine
  std::string ssh;                     // command with its options, for a shell
  bool relay = false;                  // whether messages go through a relay on this machine
  std::string relay_at;                // ADDRESS[:PORT] of the relay; "": the address of this
                                       // machine at which the others see it
  std::string url;                     // network of the laboratory; "": the file names none
  std::string key_file;                // key of the laboratory; "": the file names none
  std::vector<std::string> words;      // the options that make this plan, for another command line

  bool empty() const { return places.empty(); }
};

/// The words of a command line that plan a run.
struct PlanWords {
  std::vector<std::string> on;  // ROLE=HOST or ROLE=HOST:FOLDER
  std::string lab;              // file of a laboratory
  std::string ssh;
  bool relay = false;
  std::string relay_at;
};

/// The role with this name.
std::optional<Role> RoleNamed(std::string_view name);

/// Why no role with this name can run on another machine; "" if one can.
std::string WhyNoRemoteRole(std::string_view name);

/// The machine of "HOST" or "HOST:FOLDER", where FOLDER begins with / or ~/.
/// @throws InputError if this is no machine
HostPlan ReadHost(std::string_view text, std::string_view where);

/// The destination, if ssh can take it. A destination that begins with - would be an option.
/// @return what is wrong with it; "" if it is good
std::string WhyNoDestination(std::string_view destination);

/// Makes the plan of a run. A role of --on goes to the laboratory's machine with this name if there
/// is one, and leaves its place in the laboratory's file.
/// @throws InputError
RunPlan MakePlan(const PlanWords& words);

}  // namespace fogline::hosts
