// Announced runs and waiting roles, as text for people and as JSON for programs.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "services/runtime/discovery/announcements.h"
#include "services/runtime/discovery/waiting_roles.h"
#include "tools/watch/traffic_text.h"

namespace fogline::watch {

/// One line for each run. @param followed whether the view shows the first run
std::vector<Line> AnnouncedLines(const std::vector<runtime::Announcement>& runs, bool followed);

/// The runs as a list of objects. @param followed whether the view shows the first run
nlohmann::ordered_json AnnouncedJson(const std::vector<runtime::Announcement>& runs, bool followed);

/// The roles that wait for a run as a list of objects.
nlohmann::ordered_json WaitingJson(const std::vector<runtime::WaitingRole>& roles);

}  // namespace fogline::watch
