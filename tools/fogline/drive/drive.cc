// fogline drive: a run in real time in which a person drives.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "services/log/log_guard.h"
#include "services/runtime/transport/tcpq_url.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/new_log.h"
#include "tools/cli/run_outcome.h"
#include "tools/cli/transport_arguments.h"
#include "tools/drive/evdev_device.h"
#include "tools/drive/seat.h"
#include "tools/drive/terminal_keys.h"
#include "tools/fogline/verbs.h"
#include "tools/processes/page_seat.h"

namespace fogline {
namespace {

constexpr const char* kDriveExamples =
    R"(The run is in real time, with /person/drives=true. What you do is logged (channel
DRIVER_INPUT), and fogline replay LOG --role driver computes the same commands again.

Without --keys and --evdev you drive at a page in the browser, with its keys, a gamepad or
a wheel. The program prints the addresses of this page and of the view of the run, and
waits until you press "Begin". Only this machine can open them, unless --listen names an
address for others. Each of the printed addresses then has a token of its own.

--keys reads the terminal: arrow up throttle, arrow down brake, space or t take over,
g give back. A pedal moves while its key is down (/person/key_press_ps) and back when
it is up (/person/key_release_ps). A terminal does not report that a key goes up: a tap
moves the pedal a little and lets it rest for 0.7 s; a key that stays down moves it on.
A pedal goes back 0.12 s after the last repetition. With --evdev a keyboard reports
both, so its pedals follow at once.

--evdev reads a device of the kernel, such as /dev/input/event5: a gamepad (right
trigger throttle, left trigger brake, A take over, B give back), a wheel with pedals, or
a keyboard. The program needs the right to read the device. There is no force feedback.
A pedal counts as released until it has moved once.

The seat counts as empty if the device is unplugged, or its messages stop for
/person/deadman_s. The pedals then count as released, and the fallbacks of real time
apply (docs/real-time.md).

Examples:
  fogline drive scenario/drive.json
  fogline drive scenario/drive.json --listen 192.168.1.5
  fogline drive scenario/drive.json --keys
  fogline drive scenario/drive.json --evdev /dev/input/event5
  fogline drive scenario/drive.json --evdev /dev/input/event5 --throttle=-ABS_Y --brake=-ABS_Z
  fogline drive scenario/drive.json --keys --set /person/take_over_by=button --seed 7)";

struct DriveArguments {
  explicit DriveArguments(CLI::App& verb) : scenario(verb), transport(verb, "udpm") {
    CLI::Option* by_keys = verb.add_flag("--keys", keys, "Drive with the keys of this terminal");
    CLI::Option* by_device =
        verb.add_option("--evdev", device, "Drive with this input device")->excludes(by_keys);
    const auto name = [&](const char* option, std::string& value, const char* what) {
      verb.add_option(option, value, what)->needs(by_device);
    };
    name("--throttle", names.throttle,
         "Axis of the throttle, such as ABS_RZ; -ABS_RZ if the axis has its greatest value when "
         "the pedal is released");
    name("--brake", names.brake, "Axis of the brake");
    name("--take-over", names.take_over, "Button to take over, such as BTN_SOUTH");
    name("--give-back", names.give_back, "Button to give control back to the automation");
    for (CLI::Option* of_page :
         {verb.add_option("--listen", listen, "ADDRESS[:PORT] at which others may open the page"),
          verb.add_flag("--no-browser", no_browser, "Only print the addresses of the page")}) {
      of_page->excludes(by_keys)->excludes(by_device);
    }
    verb.add_option("--log", options.log, "Event log to write");
    verb.add_flag("--force", force, "Replace the log if it exists");
    verb.add_flag("--json", json, "Print the result as JSON");
    verb.add_flag("--quiet", quiet, "Print only errors on stderr");
    cli::ShowExitCodes(verb, {.interruptible = true});
    verb.footer(kDriveExamples);
  }

  cli::ScenarioArguments scenario;
  cli::TransportArguments transport;
  runner::RunOptions options;
  drive::DeviceNames names;
  std::string device;
  std::string listen;
  bool no_browser = false;
  bool keys = false;
  bool force = false;
  bool json = false;
  bool quiet = false;
};

/// Whether the person drives in the browser, at the page of fogline-web.
bool AtPage(const DriveArguments& arguments) { return !arguments.keys && arguments.device.empty(); }

/// @return the device of the person; nullptr if the person drives at the page of fogline-web
/// @throws InputError if the device cannot be used
std::unique_ptr<drive::PedalSource> MakeSource(const DriveArguments& arguments,
                                               const PersonSection& person) {
  if (arguments.keys) return std::make_unique<drive::TerminalKeys>(person);
  if (AtPage(arguments)) return nullptr;
  return std::make_unique<drive::EvdevDevice>(arguments.device, arguments.names, person);
}

/// Starts the page of a run, and waits until the person presses "Begin" on the page.
/// @throws std::runtime_error if the page cannot be shown; Interrupted
std::unique_ptr<processes::PageSeat> OpenPage(const DriveArguments& arguments, std::int64_t run_id,
                                              const std::string& url) {
  std::vector<std::string> more;
  if (!arguments.listen.empty()) more = {"--listen", arguments.listen};
  if (arguments.no_browser) more.emplace_back("--no-browser");
  auto page = std::make_unique<processes::PageSeat>(run_id, url, arguments.options.traffic, more);
  Notice("drive: " + page->drive_address());
  Notice("view: " + page->view_address());
  if (!page->WaitForPerson()) throw Interrupted("interrupted before the drive began");
  return page;
}

/// Loads the scenario, in which a person drives. @throws InputError
Scenario LoadDriven(const cli::ScenarioArguments& arguments) {
  if (arguments.HasOverride("/person/drives=false")) {
    throw InputError("error: --set /person/drives=false: in this verb a person drives");
  }
  return arguments.Load({"/person/drives=true"});
}

int Drive(DriveArguments& arguments) {
  if (!arguments.listen.empty()) {
    const auto place = runtime::tcpq::ResolveOwn(arguments.listen, "--listen");
    // Without a port in --listen, fogline-web takes a free port.
    if (runtime::tcpq::HasPort(arguments.listen)) {
      runtime::tcpq::RequireFree(place, "--listen");
    }
  }
  runner::RunOptions& options = arguments.options;
  arguments.transport.Apply(options);
  cli::RunInRealtime(options, 1);
  options.announce = !arguments.quiet;
  const Scenario scenario = LoadDriven(arguments.scenario);
  cli::CheckPeriod(scenario, 1);
  WatchInterrupts();
  auto source = MakeSource(arguments, scenario.person);
  runner::CheckNetwork(options);
  log::LogGuard log = options.log.empty() ? cli::FreshLog(arguments.scenario.file())
                                          : cli::PrepareLog(options.log, arguments.force);
  options.log = log.path();
  options.on_logged_step = [&log] { log.RemoveOlder(); };
  std::optional<drive::Seat> seat;
  std::unique_ptr<processes::PageSeat> page;
  options.on_network = [&](std::int64_t run_id, const std::string& url) {
    if (AtPage(arguments)) page = OpenPage(arguments, run_id, url);
  };
  options.on_run = [&](std::int64_t run_id, const std::string& url) {
    if (source) seat.emplace(url, run_id, options.traffic, std::move(source));
  };
  cli::RunOutcome outcome{.file = arguments.scenario.file(),
                          .steps = scenario.steps,
                          .result = runner::RunScenario(scenario, options),
                          .resumed = std::nullopt};
  seat.reset();            // restores the terminal
  if (page) page->Runs();  // prints a message if fogline-web has failed
  return cli::PrintOutcome(outcome, arguments.json, "drive");
}

}  // namespace

void AddDrive(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("drive", "Drive the host yourself, in real time");
  const auto arguments = std::make_shared<DriveArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return Drive(*arguments); }; });
}

}  // namespace fogline
