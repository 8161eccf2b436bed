// Announced runs for people and for programs.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "services/runtime/announcements.h"
#include "tools/watch/traffic_text.h"

namespace fogline {

/// One line for each run. @param followed whether the first one is what is being shown
std::vector<Line> AnnouncedLines(const std::vector<Announcement>& runs, bool followed);

/// A list of objects. @param followed whether the first one is what is being shown
nlohmann::ordered_json AnnouncedJson(const std::vector<Announcement>& runs, bool followed);

}  // namespace fogline
