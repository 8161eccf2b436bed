// The cost of LCM itself: processes that only receive and send, and a reader of logs, all with
// LCM's own library alone. They are the references for Fogline's lockstep and log reading.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fogline::benchmarks {

/// A process that publishes one message on each of its outputs as soon as the newest messages on
/// all its inputs belong to the same step.
struct BareRole {
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
};

/// The roles of a ring of `hops` processes, this process among them. A message goes round the ring.
std::vector<BareRole> BareRing(int hops);

/// The roles of Fogline's graph with the same channels, recorder included.
std::vector<BareRole> BareGraph();

/// Seconds per step of a network of bare processes over udpm. This process is the first role. It
/// begins a step when all its inputs of the step before have arrived.
double BareNetworkStepSeconds(const std::vector<BareRole>& roles, int steps);

/// Seconds for `hops` messages published and handled one after another over bare memq.
double BareMemqStepSeconds(int hops, int steps);

/// Seconds in which LCM's own reader reads all events of a log.
double BareLogReadSeconds(const std::filesystem::path& log);

}  // namespace fogline::benchmarks
