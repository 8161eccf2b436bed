// What LCM itself costs: processes and programs that use nothing but LCM's own library, and do
// nothing but receive and send. The references that Fogline's lockstep and log reading are compared
// with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fogline {

/// A process that publishes one message on each of its outputs as soon as the newest messages on
/// all its inputs are of the same step.
struct BareRole {
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
};

/// A message that goes round a ring of so many processes, this one among them.
std::vector<BareRole> BareRing(int hops);

/// The roles of Fogline's graph, wired as there, recorder included.
std::vector<BareRole> BareGraph();

/// Seconds per step of a network of bare processes over udpm. This process is the first role: it
/// begins a step when all its inputs of the step before are there.
double BareNetworkStepSeconds(const std::vector<BareRole>& roles, int steps);

/// Seconds for `hops` messages published and handled one after another over bare memq.
double BareMemqStepSeconds(int hops, int steps);

/// Seconds that LCM's own reader takes for all events of a log.
double BareLogReadSeconds(const std::filesystem::path& log);

}  // namespace fogline
