// A role's information about its run. It comes from the runner's RUN or from the option --run-id.
#pragma once

#include <cstdint>
#include <optional>

#include "services/runtime/wire/scenario_parts.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

struct RunNews {
  std::optional<std::int64_t> id;  // nullopt: no run is known yet
  // Id of a run on this network that has no place for this role; set while the role has no run.
  std::optional<std::int64_t> full;
  std::int64_t sequence = 0;     // sequence number of the newest RUN
  std::int64_t progress = -1;    // last step that is known to have begun; -1: none
  std::int8_t minimal_risk = 0;  // cars in a minimal risk manoeuvre, as in status_t
  ScenarioParts parts;
  // The next members are known when all parts of the scenario have come.
  std::int64_t steps = kMaxStep;
  bool realtime = false;
  double pace = 0;  // simulated seconds per second, 0 if there is no limit
};

}  // namespace fogline::runtime
