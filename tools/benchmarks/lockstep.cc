// How much the lockstep costs over what LCM itself costs.
//
// What is a fair bare chain? A step of Fogline sends nine messages, and five of them must follow
// one another: TRUTH, RADAR (or LIDAR), TRACK, ACC_COMMAND, HOST_COMMAND. So the least that a step
// can take is a message that goes round a ring of five processes. That ring is the reference that
// the goal is for. It is a hard one, because it sends four messages less, wakes five processes
// instead of nine, and on a machine with few cores that is most of the work: LCM's multicast wakes
// every process for every message on the network, whether it has subscribed or not.
//
// Two references more say where the time goes. The ring of nine hops sends as many messages as a
// step, but all one after another. The bare graph has Fogline's own wiring, recorder included, with
// processes that count steps and do nothing else: what remains is the lockstep's own work
// (decoding, checking, remembering, computing, logging).
//
// memq has no processes and nothing in parallel: all nine messages are handled one after another,
// so nine bare hops are what a step costs LCM.
#include <filesystem>

#include <nlohmann/json.hpp>

#include "services/graph.h"
#include "tools/benchmarks/bare_lcm.h"
#include "tools/benchmarks/comparisons.h"
#include "tools/benchmarks/program.h"

namespace fogline {
namespace {

constexpr int kPathHops = 5;
constexpr double kMicrosPerSecond = 1e6;

constexpr int StepMessages() {
  int count = 0;
  for (const ChannelInfo& channel : kChannels) count += channel.pace == Pace::kStep ? 1 : 0;
  return count;
}

/// How a run is to be made: options of `fogline run`.
using Options = std::vector<std::string>;

/// Wall-clock seconds that `fogline run` reports for so many steps.
double RunSeconds(const Options& options, int steps) {
  Options command{ProgramPath("fogline"),
                  "run",
                  "scenario/paper.json",
                  "--quiet",
                  "--json",
                  "--force",
                  "--log",
                  ScratchFolder() / "run.lcm",
                  "--set",
                  "/steps=" + std::to_string(steps)};
  command.insert(command.end(), options.begin(), options.end());
  return nlohmann::json::parse(RunProgram(command).out)["wall_s"];
}

/// A run of so many steps beside one of so many more: what starting and ending costs cancels out.
double LockstepStepMicros(const Options& options, int steps) {
  constexpr int kShort = 500;
  const double more_s = RunSeconds(options, kShort + steps) - RunSeconds(options, kShort);
  return kMicrosPerSecond * more_s / steps;
}

Comparison OverUdpm(int steps) {
  return {.quantity = "time per step",
          .unit = "us",
          .ours = "lockstep over udpm, nine processes",
          .goal = 1.3,
          .bar = 2.0,
          .measure_ours = [steps] { return LockstepStepMicros({}, steps); }};
}

Comparison OverUdpm(int steps, const std::string& name, const std::string& reference,
                    const std::vector<BareRole>& roles) {
  Comparison comparison = OverUdpm(steps);
  comparison.name = name;
  comparison.reference = reference;
  comparison.measure_reference = [roles, steps] {
    return kMicrosPerSecond * BareNetworkStepSeconds(roles, steps);
  };
  return comparison;
}

/// Every message signed by its sender and verified by each of its readers.
Comparison SignedOverUdpm(int steps) {
  Comparison comparison = OverUdpm(steps);
  comparison.name = "key";
  comparison.ours = "lockstep over udpm, signed (`--key`)";
  comparison.reference = "the same, not signed";
  comparison.bar.reset();
  comparison.measure_reference = comparison.measure_ours;
  comparison.measure_ours = [steps] {
    const std::string key = ScratchFolder() / "key";
    if (!std::filesystem::exists(key)) RunProgram({ProgramPath("fogline"), "keygen", key});
    return LockstepStepMicros({"--key", key}, steps);
  };
  return comparison;
}

}  // namespace

std::vector<Comparison> LockstepComparisons(Effort effort) {
  const int steps = effort == Effort::kFull ? 10'000 : 3'000;
  constexpr int kMemqFactor = 5;  // as much faster as memq is, at least
  const int messages = StepMessages();
  return {
      OverUdpm(steps, "udpm", "ring of 5 bare LCM processes (longest path of a step)",
               BareRing(kPathHops)),
      OverUdpm(steps, "udpm-messages", "ring of 9 bare LCM processes (messages of a step)",
               BareRing(messages)),
      OverUdpm(steps, "udpm-graph", "9 bare LCM processes wired like the graph", BareGraph()),
      SignedOverUdpm(steps),
      {.name = "memq",
       .quantity = "time per step",
       .unit = "us",
       .ours = "lockstep over memq",
       .reference = "9 bare memq hops",
       .goal = 1.5,
       .measure_ours =
           [steps] {
             return LockstepStepMicros({"--transport", "memq"}, kMemqFactor * steps);
           },
       .measure_reference =
           [steps, messages] {
             return kMicrosPerSecond * BareMemqStepSeconds(messages, kMemqFactor * steps);
           }},
  };
}

}  // namespace fogline
