// Where a run goes and who takes part: arguments of the verbs that make runs.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/fogline/experiment.h"

namespace fogline {

/// --transport, --lcm-url, --external, --key and --faults.
class TransportArguments {
 public:
  /// @param transport where runs go unless something else is said
  TransportArguments(CLI::App& verb, std::string transport);

  /// Sets the transport, what is asked of its traffic, and the roles that are started elsewhere.
  /// @throws InputError if these cannot go together
  void Apply(ExperimentOptions& options) const;

 private:
  std::string transport_;
  std::string url_;
  std::vector<std::string> external_;
  TrafficOptions traffic_;
};

}  // namespace fogline
