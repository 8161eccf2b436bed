// fogline spy: starts LCM's own lcm-spy with Fogline's message types. The class path of Debian's
// /usr/bin/lcm-spy lacks these types.
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/programs.h"
#include "common/text.h"
#include "services/runtime/discovery/beacon.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"
#include "tools/spy/java_program.h"
#include "tools/spy/spy_parts.h"
#include "tools/watch/traffic_statistics.h"

namespace fogline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSpyExplanation =
    R"(Opens a window with a table of every channel: type, rate, jitter, undecodable messages. A double
click shows a channel's fields. A click on a number's sparkline shows its chart. lcm-spy cannot
change its network. Without --lcm-url the verb waits until a run is announced, or until messages
come at the address where runs are announced. Then lcm-spy starts on the network of this run (of the
newest one if there are several) or of these messages. Uses JAVA_HOME if it is set.

Examples:
  fogline run scenario/paper.json --pace 1 & fogline spy
  fogline spy --lcm-url 'udpm://239.255.76.67:7700?ttl=0')";

struct SpyArguments {
  explicit SpyArguments(CLI::App& verb) : network(verb, "to look at") {
    verb.add_option("--wait", wait_s, "Longest wait for a run, in s (0: for ever)")
        ->check(cli::NumberIn(0, 1e6))
        ->capture_default_str();
    verb.add_option("--types", types, "Message types (default: those of this build)");
    verb.add_option("--jars", jars,
                    "Folder of lcm.jar and jchart2d.jar (default: /usr/share/java, or "
                    "/usr/local/share/java)");
    cli::ShowExitCodes(
        verb, {.done = "window closed", .check_failed = "lcm-spy failed", .interruptible = true});
    verb.footer(kSpyExplanation);
  }

  cli::NetworkArguments network;
  double wait_s = 60;
  fs::path types;
  fs::path jars;
};

/// The jar of the message types. @throws InputError; std::runtime_error that says how to build it
fs::path TypesOf(const SpyArguments& arguments) {
  if (!arguments.types.empty()) return spy::Named(arguments.types, "--types");
  const fs::path programs = OwnFolder();
  const fs::path types = spy::TypesJar(programs);
  if (!types.empty()) return types;
  throw std::runtime_error(fmt::format(
      "there are no message types beside {}: {}cmake -S . -B build -G Ninja && ninja -C build "
      "fogline_lcmtypes_java",
      PathText(programs),
      FindProgram("javac").empty() ? "apt-get install default-jdk, then " : ""));
}

/// The command line of lcm-spy without its network. @throws InputError, std::runtime_error if
/// lcm-spy cannot run
std::vector<std::string> SpyCommand(const SpyArguments& arguments) {
  const fs::path java = spy::RequireJava();
  const fs::path lcm = spy::FindJar(arguments.jars, "lcm.jar", "liblcm-java");
  const fs::path charts = spy::FindJar(arguments.jars, "jchart2d.jar", "libjchart2d-java");
  const fs::path types = TypesOf(arguments);
  spy::RequireScreen();
  return {java.string(), "-Djava.net.preferIPv4Stack=true", "-cp",
          fmt::format("{}:{}:{}", lcm.string(), charts.string(), types.string()), "lcm.spy.Spy"};
}

/// Waits for traffic that can be shown. @return the network of this traffic
/// @throws Interrupted; std::runtime_error if no traffic came
std::string FindNetwork(const SpyArguments& arguments) {
  // The time of two announcements. If no runner is held up, every run is known by then, and so is
  // the newest one. An announced run takes precedence over other traffic.
  constexpr Duration kDiscovery = 2 * runtime::kBeaconEvery;
  constexpr Duration kLookEvery = milliseconds(50);
  runtime::Bus bus(arguments.network.Url());
  bool traffic = false;
  bus.SubscribeAll([&traffic](std::string_view channel, runtime::Bytes) {
    traffic |= !watch::IsHousekeeping(channel);
  });
  runtime::BeaconListener beacons(bus.url());
  const TimePoint began = Clock::now();
  bool said = false;
  while (!WasInterrupted()) {
    bus.Wait(kLookEvery);
    bus.Drain();
    beacons.Look();
    const Duration waited = Clock::now() - began;
    if (waited < kDiscovery) continue;
    if (const auto runs = beacons.Runs(); !runs.empty()) {
      Notice(runs.front().Text());
      return runs.front().url;
    }
    if (traffic) return bus.url();
    if (!std::exchange(said, true)) {
      Notice(fmt::format("waiting for a run on {}; start one with: fogline run SCENARIO --pace 1",
                         bus.url()));
    }
    if (arguments.wait_s > 0 && waited > std::chrono::duration<double>(arguments.wait_s)) {
      throw std::runtime_error(
          fmt::format("waited {:g} s for a run on {} in vain; start one with: fogline run SCENARIO "
                      "--pace 1, or name its network with --lcm-url (--wait 0 waits for ever)",
                      arguments.wait_s, bus.url()));
    }
  }
  throw Interrupted("interrupted before a run came");
}

int Spy(const SpyArguments& arguments) {
  std::string url = arguments.network.Url();
  std::vector<std::string> command = SpyCommand(arguments);
  if (arguments.network.Follows()) {
    WatchInterrupts();
    url = FindNetwork(arguments);
  }
  command.push_back("--lcm-url=" + url);
  spy::BecomeJava(std::move(command));
}

}  // namespace

void AddSpy(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("spy", "Start LCM's lcm-spy with our message types");
  const auto arguments = std::make_shared<SpyArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return Spy(*arguments); }; });
}

}  // namespace fogline
