#include "services/runtime/service.h"

#include <csignal>
#include <cstdio>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "scenario/loader.h"
#include "services/runtime/this_process.h"
#include "services/runtime/traffic_options.h"
#include "services/runtime/version.h"

namespace fogline {
namespace {

enum ExitCode : int { kStopped = 0, kBadUsage = 2, kFailed = 3, kInterrupted = 130 };

volatile std::sig_atomic_t interrupted = 0;

void WatchSignals() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
}

// In real time the clock of the run comes first, then everybody else, then the rest of the machine.
constexpr int kWorldPriority = 2;
constexpr int kPriority = 1;

int TakePart(Bus& bus, Node& node) {
  std::string trouble;
  bool preferred = false;
  while (!node.left()) {
    if (trouble.empty() && node.Waits()) {
      trouble = SignatureTrouble(bus.unverified());
      if (!trouble.empty()) fmt::print(stderr, "fogline-{}: {}\n", NameOf(node.role()), trouble);
    }
    if (interrupted != 0) {
      node.Leave();
      return kInterrupted;
    }
    if (node.realtime() && !preferred) {
      preferred = true;  // or not: then it keeps time as well as the machine lets it
      RunBeforeOthers(node.role() == Role::kWorld ? kWorldPriority : kPriority);
    }
    const TimePoint now = Clock::now();
    bus.Wait(node.Poll(now) - now);
  }
  if (node.error().empty()) return kStopped;
  fmt::print(stderr, "fogline-{}: error: {}\n", NameOf(node.role()), node.error());
  return kFailed;
}

}  // namespace

int RunProcess(int argc, char** argv, Role role, const NodeFactory& make,
               const std::function<void(CLI::App&)>& extend) {
  const std::string name = fmt::format("fogline-{}", NameOf(role));
  std::string_view purpose;
  for (const RoleInfo& info : kRoles) {
    if (info.role == role) purpose = info.purpose;
  }
  CLI::App app{
      fmt::format("Fogline's {}: {}.\n"
                  "Joins the next run that is announced on the LCM network, takes part in it,\n"
                  "and leaves when the runner says so.",
                  NameOf(role), purpose),
      name};
  app.set_version_flag("--version", VersionText());
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  app.add_option("--lcm-url", url, "LCM network to join")
      ->envname("LCM_DEFAULT_URL")
      ->capture_default_str();
  std::optional<std::int64_t> run_id;
  app.add_option("--run-id", run_id, "Join only the run with this id");
  TrafficOptions traffic;
  AddTrafficOptions(app, traffic);
  app.footer(
      fmt::format("Exit codes: 0 stopped by the runner, 2 bad usage, 3 failed, 130 interrupted."
                  "\n\nExample: two shells of one machine\n"
                  "  {0} --lcm-url 'udpm://239.255.76.67:7700?ttl=0'\n"
                  "  fogline run scenario/paper.json --external {1} \\\n"
                  "    --lcm-url 'udpm://239.255.76.67:7700?ttl=0'",
                  name, NameOf(role)));
  if (extend) extend(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "{0}: error: {1} (see {0} --help)\n", name, error.what());
    return kBadUsage;
  }
  WatchSignals();
  try {
    Bus bus(url);
    Apply(traffic, role, bus);
    const std::unique_ptr<Node> node = make(bus, run_id);
    return TakePart(bus, *node);
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return kBadUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: error: {}\n", name, error.what());
    return kFailed;
  }
}

}  // namespace fogline
