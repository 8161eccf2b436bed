// Compares the cost of the lockstep with the cost of LCM itself.
//
// Which bare LCM processes are a fair reference? A step of Fogline sends nine messages. Five of
// these messages must follow one another: TRUTH, RADAR (or LIDAR), TRACK, ACC_COMMAND,
// HOST_COMMAND. So a step takes at least as long as one message that goes round a ring of five
// processes. The comparison `udpm` uses the time of this ring as its reference. The ring is a
// strict reference, because it sends four messages fewer and wakes five processes instead of nine.
// On a machine with few cores, waking processes is most of the work. Bare LCM wakes every process
// for every message on the network, even if the process has not subscribed to the message's
// channel. Fogline's processes have a filter in the kernel that prevents this.
//
// Two more references show which work takes the time. The ring of nine hops sends as many messages
// as a step, but all one after another. The bare graph has the same roles and channels as Fogline,
// recorder included, but its processes only count steps. The difference between Fogline and this
// graph is the lockstep's own work (decoding, checking, storing, computing, logging).
//
// memq has one process and no parallel work. It handles all nine messages one after another. So the
// cost of LCM in a step is the cost of nine bare hops.
#include <filesystem>

#include <nlohmann/json.hpp>

#include "services/graph.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tools/benchmarks/bare_lcm.h"
#include "tools/benchmarks/comparisons.h"
#include "tools/benchmarks/program.h"

namespace fogline::benchmarks {
namespace {

constexpr int kPathHops = 5;

constexpr int StepMessages() {
  int count = 0;
  for (const ChannelInfo& channel : kChannels) count += channel.pace == Pace::kStep ? 1 : 0;
  return count;
}

/// Options of `fogline run` for a measurement.
using Options = std::vector<std::string>;

/// Wall-clock seconds that `fogline run` reports for a run of `steps` steps.
/// @param launcher the beginning of the command line; "fogline run" follows
double RunSeconds(const Options& options, int steps, const Options& launcher = {}) {
  Options command = launcher;
  command.insert(command.end(), {ProgramPath("fogline"), "run", "scenario/paper.json", "--quiet",
                                 "--json", "--force", "--log", ScratchFolder() / "run.lcm", "--set",
                                 "/steps=" + std::to_string(steps)});
  command.insert(command.end(), options.begin(), options.end());
  return nlohmann::json::parse(RunProgram(command).out)["wall_s"];
}

/// Microseconds per step: the additional time of a long run, compared with a short run, divided by
/// the number of additional steps. Both runs include the same cost of the start and the end of a
/// run, so the result does not contain this cost.
double LockstepStepMicros(const Options& options, int steps, const Options& launcher = {}) {
  constexpr int kShort = 500;
  const double more_s =
      RunSeconds(options, kShort + steps, launcher) - RunSeconds(options, kShort, launcher);
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

/// The lockstep with signed messages, compared with the lockstep without signatures.
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

/// Steps per second of a run whose driver is a separate program. @param driver the command of this
/// program, to which "--lcm-url URL" is added
double StepsPerSecondWith(const std::string& driver, int steps) {
  const std::string url = runtime::FreshMulticastUrl();
  const Options beside{"sh", "-c",
                       driver + " --lcm-url '" + url + "' >/dev/null 2>&1 & \"$0\" \"$@\"; " +
                           "code=$?; wait; exit $code"};
  const Options external{"--external", "driver", "--no-verify", "--lcm-url", url};
  return kMicrosPerSecond / LockstepStepMicros(external, steps, beside);
}

/// A driver in Python, compared with the same driver in C++.
Comparison DriverInPython(int steps) {
  const std::string programs = std::filesystem::path(ProgramPath("fogline")).parent_path();
  const std::string python =
      "PYTHONPATH='" + programs + "/../python' /usr/bin/python3 -B tools/python/examples/driver.py";
  return {.name = "python",
          .quantity = "steps per second",
          .unit = "1/s",
          .ours = "lockstep over udpm, driver in Python",
          .reference = "the same, driver in C++",
          .bound = Bound::kAtLeast,
          .goal = 0.8,
          .measure_ours = [python, steps] { return StepsPerSecondWith(python, steps); },
          .measure_reference =
              [steps] { return StepsPerSecondWith(ProgramPath("fogline-driver"), steps); }};
}

}  // namespace

std::vector<Comparison> LockstepComparisons(Effort effort) {
  const int steps = effort == Effort::kFull ? 10'000 : 3'000;
  constexpr int kMemqFactor = 5;  // memq is faster by this factor or more, so its runs are longer
  const int messages = StepMessages();
  return {
      OverUdpm(steps, "udpm", "ring of 5 bare LCM processes (longest path of a step)",
               BareRing(kPathHops)),
      OverUdpm(steps, "udpm-messages", "ring of 9 bare LCM processes (messages of a step)",
               BareRing(messages)),
      OverUdpm(steps, "udpm-graph", "9 bare LCM processes wired like the graph", BareGraph()),
      SignedOverUdpm(steps),
      DriverInPython(steps),
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

}  // namespace fogline::benchmarks
