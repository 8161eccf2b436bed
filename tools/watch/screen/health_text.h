// What a person should know about a role and a run, in words, from STATUS and HOST_COMMAND.
#pragma once

#include <string>
#include <vector>

#include "tools/watch/traffic_statistics.h"

namespace fogline::watch {

/// Remarks on a role, the most important one first; none if the role is well. Text from the network
/// is safe to print.
/// @param realtime whether the run is in real time: its roles do not wait for inputs
std::vector<std::string> RemarksOn(const RoleView& role, bool realtime);

/// Whether the role needs the attention of a person.
bool IsUnwell(const RoleView& role);

/// "the automation drives", "the human drives", "a minimal risk manoeuvre", ... according to the
/// newest HOST_COMMAND; "" if none has come.
std::string WhoDrives(const RunView& run);

}  // namespace fogline::watch
