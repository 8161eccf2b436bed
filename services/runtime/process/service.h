// The main program of a service: one role as a separate process.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "services/runtime/process/program_options.h"
#include "services/runtime/process/step_node.h"

namespace fogline::runtime {

/// Makes the work of a process, with its node. Called after the command line has been read.
using WorkFactory =
    std::function<std::unique_ptr<Work>(Bus& bus, std::optional<std::int64_t> run_id)>;

/// Reads the command line, takes part in one run, and returns the exit code: 0 stopped by the
/// runner, 2 bad usage, 3 failed, 130 ended by SIGINT, SIGTERM or SIGHUP (interrupt.h).
/// @param extend adds options of this service, before the command line is read
int RunProcess(int argc, char** argv, Role role, const WorkFactory& make,
               const std::function<void(ProgramOptions&)>& extend = {});

/// RunProcess() for an algorithm. Failsafe replaces the algorithm in real time (step_node.h).
template <class Algorithm, class Failsafe = void>
int RunService(int argc, char** argv) {
  return RunProcess(argc, argv, AlgorithmTraits<Algorithm>::kRole,
                    [](Bus& bus, std::optional<std::int64_t> run_id) {
                      return std::make_unique<StepNode<Algorithm, Failsafe>>(bus, run_id);
                    });
}

}  // namespace fogline::runtime
