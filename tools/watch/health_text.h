// Texts for people about the state of a role and of a run, from STATUS and HOST_COMMAND.
#pragma once

#include <string>
#include <vector>

#include "tools/watch/traffic_statistics.h"

namespace fogline::watch {

/// Remarks on a role, the most important one first; empty if the role has no problem. Text from the
/// network is made safe to print.
/// @param realtime whether the run is in real time; the roles of such a run do not wait for inputs
std::vector<std::string> RemarksOn(const RoleView& role, bool realtime);

/// RemarksOn(), joined by semicolons; "" if the role has no problem.
std::string RemarksText(const RoleView& role, bool realtime);

/// Whether the role needs the attention of a person.
bool IsUnwell(const RoleView& role);

/// How fast the run goes: "real time x2", "pace 4" or "full speed".
std::string SpeedText(const RunView& run);

/// The side that drives, according to the newest HOST_COMMAND: "the automation drives", "the human
/// drives", "a minimal risk manoeuvre", ...; "" if no HOST_COMMAND has come.
std::string WhoDrives(const RunView& run);

}  // namespace fogline::watch
