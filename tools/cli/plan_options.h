// The options of a command line that start roles on other machines.
#pragma once

#include "tools/hosts/run_plan.h"

namespace CLI {
class App;
}

namespace fogline::cli {

/// Adds --on, --lab, --ssh, --relay and --relay-at to a command line.
void AddPlanOptions(CLI::App& app, hosts::PlanWords& words);

}  // namespace fogline::cli
