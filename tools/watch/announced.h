// Announced runs and waiting roles, as text for people and as JSON for programs.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "services/runtime/discovery/announcements.h"
#include "services/runtime/discovery/waiting_roles.h"
#include "tools/watch/traffic_text.h"

namespace fogline::watch {

/// One line for each of the first eight runs. If there are more runs, a last line says how many.
/// @param followed whether the view shows the first run of `runs`
std::vector<Line> AnnouncedLines(const std::vector<runtime::Announcement>& runs, bool followed);

/// The runs as a list of objects.
/// @param followed whether the view shows the first run of `runs`
nlohmann::ordered_json AnnouncedJson(const std::vector<runtime::Announcement>& runs, bool followed);

/// The roles that wait for a run as a list of objects.
nlohmann::ordered_json WaitingJson(const std::vector<runtime::WaitingRole>& roles);

}  // namespace fogline::watch
