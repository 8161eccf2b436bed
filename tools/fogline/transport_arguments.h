// Where a run goes and who takes part: arguments of the verbs that make runs.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/fogline/experiment.h"

namespace fogline {

/// --transport, --lcm-url, --external, --wait, --same-build, --verify, --key and --faults.
class TransportArguments {
 public:
  /// @param transport where runs go unless something else is said. A run whose roles are
  ///     processes goes to $LCM_DEFAULT_URL then, if that is set.
  TransportArguments(CLI::App& verb, std::string transport);

  /// Sets the transport, what is asked of its traffic, and the roles that are started elsewhere.
  /// @throws InputError if these cannot go together
  void Apply(ExperimentOptions& options) const;

 private:
  /// The transport of a run that was told neither --transport nor --lcm-url.
  std::string Unsaid() const;

  std::string transport_;
  CLI::Option* said_;  // --transport
  std::string url_;
  std::vector<std::string> external_;
  double wait_s_ = 60;
  bool same_build_ = false;
  bool verify_ = false;
  bool no_verify_ = false;
  TrafficOptions traffic_;
};

}  // namespace fogline
