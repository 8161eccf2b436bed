// Measures the cost of LCM itself: the cost of processes that only receive and send, and of a
// reader of logs. These processes and this reader use only LCM's own library. The benchmarks
// compare Fogline's lockstep and log reading with this cost.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fogline::benchmarks {

/// A process that publishes one message on each output as soon as the newest messages on all inputs
/// belong to the same step.
struct BareRole {
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
};

/// The roles of a ring of `hops` processes, including this process. A message goes round the ring.
std::vector<BareRole> BareRing(int hops);

/// One bare role for each role of Fogline's graph, recorder included, with the channels of the
/// graph.
std::vector<BareRole> BareGraph();

/// Seconds per step of a network of bare processes over udpm. This process takes the first role. It
/// begins a step when all its inputs of the previous step have arrived.
double BareNetworkStepSeconds(const std::vector<BareRole>& roles, int steps);

/// Seconds per step over bare memq. A step publishes and handles `hops` messages one after another.
double BareMemqStepSeconds(int hops, int steps);

/// Seconds that LCM's own reader needs to read all events of a log.
double BareLogReadSeconds(const std::filesystem::path& log);

}  // namespace fogline::benchmarks
