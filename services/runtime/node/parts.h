// The common parts of a node. The node's rule (FireRule), its work (Work) and its other members use
// these parts.
#pragma once

#include <memory>

#include "services/graph.h"
#include "services/runtime/node/inputs.h"
#include "services/runtime/node/own_status.h"
#include "services/runtime/node/requests.h"
#include "services/runtime/node/run_news.h"
#include "services/runtime/node/steps.h"
#include "services/runtime/node/work.h"
#include "services/runtime/transport/bus.h"

namespace fogline::runtime {

struct Parts {
  /// @param rule_of_role null until the role has joined
  Parts(Bus& bus_of_role, Role role, Work& work, const std::unique_ptr<FireRule>& rule_of_role)
      : bus(bus_of_role),
        own(bus, role, run, work, rule_of_role),
        requests(bus, run, own),
        steps(own, work),
        inputs(bus, role, run, own, rule_of_role) {}
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  Bus& bus;
  RunNews run;
  OwnStatus own;
  Requests requests;
  Steps steps;
  Inputs inputs;
};

}  // namespace fogline::runtime
