// fogline run: makes one run of a scenario.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/clock.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "services/log/event_log.h"
#include "services/runtime/process/program_options.h"
#include "services/runtime/wire/build_id.h"
#include "services/runtime/wire/message_signer.h"
#include "services/runtime/wire/other_build.h"
#include "services/runtime/wire/scenario_parts.h"
#include "services/runtime/wire/step_ring.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/new_log.h"
#include "tools/cli/run_outcome.h"
#include "tools/cli/transport_arguments.h"
#include "tools/fogline/verbs.h"
#include "tools/processes/run_viewer.h"
#include "tools/replay/role_check.h"
#include "tools/runner/log_sealer.h"
#include "tools/runner/resumed_log.h"
#include "tools/runner/scenario_run.h"
#include "tools/runner/unfinished_log_text.h"

namespace fogline {
namespace {

constexpr const char* kExamples =
    R"(Every run writes an LCM event log, logs/SCENARIO-N.lcm unless --log names
another file. With --transport direct a run writes a log only if --log is given.
Ctrl-C ends a run cleanly, keeps its log, and gives exit code 130. A process that
is killed or hangs is started again. In lockstep it catches up, and the result
is the same. A process hangs if it is silent for 2 s (1 s with --realtime), or
for half of --stall-timeout if that is less.

--resume LOG goes on with a run that has ended early, for whatever reason. The
result is the same. Scenario and seed are those of the log. Give transport, pace,
key and the external roles again. A log whose seal is signed needs the same key;
a log without a seal does not show whether its run had a key. The roles go on from
the log, so its steps are computed again and compared, unless --no-verify is given.
A complete log without a whole seal is compared in the same way, and then gets a
seal; with --no-verify it gets none. A complete log with a seal is compared only with --verify.

--view opens the run in a browser (fogline view --help), and its log when it is over.
Then Ctrl-C ends the program. If the page cannot be shown, the run goes on without it.

A run has a port of its own unless LCM_DEFAULT_URL names another; fogline top,
spy, doctor and roles without --lcm-url find it on this machine.

Examples:
  fogline run scenario/paper.json
  fogline run scenario/paper.json --set /arbitrator/threshold=0.8 --seed 7
  fogline run scenario/paper.json --pace 1       at real speed, for fogline top or spy
  fogline run scenario/paper.json --pace 1 --view
  fogline run scenario/paper.json --transport memq --json
  fogline run --resume logs/paper-1.lcm          goes on with a run that has ended early
  fogline run scenario/paper.json --faults loss=0.3,duplicate=0.1,reorder=0.1,delay_ms=5
  fogline-driver & fogline run scenario/paper.json --external driver
  fogline run scenario/paper.json --external driver --lcm-url 'udpm://239.255.76.67:7700?ttl=0'
  fogline run scenario/paper.json --on fusion=lab2 --on acc=user@lab3       by ssh
  fogline run scenario/paper.json --lab lab.json --relay)";

struct RunArguments {
  explicit RunArguments(CLI::App& verb) : scenario(verb), transport(verb, "udpm") {
    verb.get_option("SCENARIO")->required(false);  // --resume takes the scenario from the log
    verb.add_option("--resume", resume, "Go on with the run in this log; the log has the scenario");
    verb.add_option("--log", options.log, "Event log to write");
    verb.add_flag("--force", force, "Replace the log if it exists");
    verb.add_option("--pace", options.pace,
                    "Limit of the lockstep's speed, in simulated seconds per second (0: no limit)")
        ->check(cli::NumberIn(0, runtime::kMaxSpeed))
        ->capture_default_str();
    runtime::AddRunIdOption(verb, "--run-id", options.run_id,
                            "Id of the run (default: a random number). Roles that are started with "
                            "this --run-id take part in no other run");
    CLI::Option* realtime =
        verb.add_flag("--realtime", options.realtime,
                      "Run on the wall clock; no role waits for late inputs. If inputs fail, the "
                      "other side (automation or human) drives, or the car stops");
    verb.add_option("--speed", speed, "With --realtime: simulated seconds per second")
        ->check(cli::NumberIn(runtime::kMinSpeed, runtime::kMaxSpeed))
        ->needs(realtime)
        ->capture_default_str();
    verb.add_option("--stall-timeout", stall_s,
                    "End the run when no step completes for this time, in s")
        ->check(cli::NumberIn(1, 1e6))
        ->capture_default_str();
    restarts =
        verb.add_option(
                "--restarts", options.restarts,
                "How often each role may be started again after it was killed or hung (0: its "
                "death ends the run)")
            ->check(CLI::Range(0, 1'000'000))
            ->capture_default_str();
    verb.add_flag(
        "--wall-clock", options.wall_clock,
        "In lockstep: write the wall clock of each step into the log; the digest does not "
        "contain it (in real time it is always there)");
    verb.add_flag("--view", view, "Show the run, and then its log, in a browser");
    verb.add_flag("--json", json, "Print the result as JSON");
    verb.add_flag("--quiet", quiet, "Print only errors on stderr");
    cli::ShowExitCodes(verb, {.check_failed = "--verify failed", .interruptible = true});
    verb.footer(kExamples);
  }

  cli::ScenarioArguments scenario;
  cli::TransportArguments transport;
  runner::RunOptions options;
  std::filesystem::path resume;
  CLI::Option* restarts = nullptr;
  double speed = 1.0;
  double stall_s = 4.0;
  bool force = false;
  bool view = false;
  bool json = false;
  bool quiet = false;
};

/// Applies the options that a new run and a resumed run share. @throws InputError
void ApplyOptions(RunArguments& arguments) {
  runner::RunOptions& options = arguments.options;
  arguments.transport.Apply(options);
  const bool direct = options.transport == "direct";
  if (arguments.view && cli::IsOneProcess(options.transport)) {
    throw InputError(
        fmt::format("error: --view: no other process can see a run with --transport {}; "
                    "fogline view LOG shows its log",
                    options.transport));
  }
  if (!(options.pace == 0 || runtime::IsSpeed(options.pace))) {
    throw InputError(fmt::format("error: --pace {}: neither 0 nor from {} to {}", options.pace,
                                 runtime::kMinSpeed, runtime::kMaxSpeed));
  }
  if (direct && options.pace != 0) {
    throw InputError("error: --pace: a run with --transport direct has no pace");
  }
  if (direct && options.wall_clock) {
    throw InputError("error: --wall-clock: a run with --transport direct has no recorder");
  }
  if (direct && arguments.restarts->count() > 0) {
    throw InputError("error: --restarts: a run with --transport direct has no processes");
  }
  if (options.realtime) cli::RunInRealtime(options, arguments.speed);
  options.stall_limit = duration_cast<Duration>(std::chrono::duration<double>(arguments.stall_s));
  options.announce = !arguments.quiet;
}

int Print(const RunArguments& arguments, const cli::RunOutcome& outcome) {
  return cli::PrintOutcome(outcome, arguments.json, "run");
}

int RunNew(RunArguments& arguments) {
  runner::RunOptions& options = arguments.options;
  const Scenario scenario = arguments.scenario.Load();
  if (scenario.person.drives && !options.realtime) {
    throw InputError(
        fmt::format("{}: error: {}", PathText(arguments.scenario.file()), kPersonNeedsRealtime));
  }
  if (options.realtime) cli::CheckPeriod(scenario, arguments.speed);
  const bool direct = options.transport == "direct";
  // A network that cannot be opened is refused before the log is made. A direct run has no network,
  // and has a log only with --log.
  if (!direct) runner::CheckNetwork(options);
  const bool has_log = !options.log.empty() || !direct;
  log::LogGuard log = !has_log              ? log::LogGuard()
                      : options.log.empty() ? cli::FreshLog(arguments.scenario.file())
                                            : cli::PrepareLog(options.log, arguments.force);
  options.log = log.path();
  options.on_logged_step = [&log] { log.RemoveOlder(); };
  options.command_to_go_on = runner::CommandToGoOn(options);
  WatchInterrupts();
  return Print(arguments, {.file = arguments.scenario.file(),
                           .steps = scenario.steps,
                           .result = runner::RunScenario(scenario, options),
                           .resumed = std::nullopt});
}

/// The builds of the roles that a verification has computed again. This process has computed these
/// roles with equal results, so the build of this process counts as theirs. The builds of the other
/// roles are unknown.
runtime::RoleBuilds BuildsOf(const replay::Verification& verification) {
  runtime::RoleBuilds builds{};
  for (const Role role : verification.roles) {
    builds[static_cast<std::size_t>(role)] = runtime::OwnBuildId();
  }
  return builds;
}

/// The roles that are not computed again: roles of another build and, if no seal names the builds,
/// the roles that were started elsewhere (--external).
std::vector<runtime::OtherBuild> OthersIn(const runner::LoggedRun& run,
                                          const std::vector<Role>& external) {
  std::vector<runtime::OtherBuild> others = replay::OtherBuildsIn(run);
  if (run.seal) return others;
  for (const Role role : external) {
    others.push_back(
        {.role = role, .pid = 0, .host = "", .build = runtime::kUnknownBuild, .ours = {}});
  }
  return others;
}

/// Whether the log has all steps, and an incomplete event behind them. A computer that crashes
/// while the seal is written leaves such a log.
bool HasTornSeal(const runner::LoggedRun& run, const runner::ResumedLog& log,
                 const std::filesystem::path& file) {
  const std::int64_t end = log.resumption().remains.head.bytes;
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  return !unknown && run.ends_torn && run.events.bytes == end &&
         std::cmp_less_equal(size, end + log::kTailBytes);
}

/// Measures a log that has the whole run, and verifies it if it has no seal. Seals the log if the
/// verification succeeds, and removes a torn seal first. --no-verify omits verification and seal.
runner::RunResult ResultOfWhole(const runner::ResumedLog& log, const runner::RunOptions& options,
                                const runtime::SigningKey* key) {
  const runner::LogSealer sealer(options.log);
  runner::LoggedRun run = runner::MeasureLoggedRun(options.log, log.scenario());
  if (!run.complete && !HasTornSeal(run, log, options.log)) {
    throw InputError(fmt::format("{}: error: --resume: {}", PathText(options.log), run.note));
  }
  if (options.announce) Notice(PathText(options.log) + ": the run is complete");
  // If the log has all steps but no seal, an earlier runner ended before it sealed the log.
  const bool to_seal = !run.seal;
  auto& verification = run.result.verification;
  if (options.verify.value_or(to_seal)) {
    verification = replay::VerifyRun(options.log, run, OthersIn(run, options.external));
  }
  if (to_seal && verification && !verification->roles.empty() && verification->Holds()) {
    if (!run.complete) {
      log::EventLogWriter(options.log, run.events);
      run.ended = true;  // the seal says so
    }
    sealer.Seal(run, {}, {.builds = BuildsOf(*verification)}, key);
  }
  return std::move(run.result);
}

/// Continues the run of a log to its end. If the log already has the whole run, no step is added.
int Resume(RunArguments& arguments) {
  runner::RunOptions& options = arguments.options;
  const auto key = runtime::KeyOf(options.traffic);
  const runner::ResumedLog log(arguments.resume, key ? &*key : nullptr);
  options.log = arguments.resume;
  options.resume = log.resumption();
  options.command_to_go_on = runner::CommandToGoOn(options);
  WatchInterrupts();
  cli::RunOutcome outcome{.file = arguments.resume,
                          .steps = log.scenario().steps,
                          .result = {},
                          .resumed = log.resumption().remains.steps,
                          .computed = !log.complete()};
  outcome.result = outcome.computed ? runner::RunScenario(log.scenario(), options)
                                    : ResultOfWhole(log, options, key ? &*key : nullptr);
  return Print(arguments, outcome);
}

/// Makes a new run or continues one. If the run fails while a browser shows it, the error is
/// printed immediately. So the user can read the error while the browser shows the log.
/// @return the exit code
int RunShown(RunArguments& arguments, processes::RunViewer& viewer) {
  try {
    return arguments.resume.empty() ? RunNew(arguments) : Resume(arguments);
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    if (!viewer.Runs() || std::ferror(stdout) != 0) throw;
    Complain(fmt::format("fogline run: error: {}", error.what()));
    return kRunFailed;
  }
}

/// Makes the run, and shows it in a browser. After the run, the browser shows the log until Ctrl-C.
int RunAndView(RunArguments& arguments) {
  runner::RunOptions& options = arguments.options;
  processes::RunViewer viewer(runtime::ToArguments({.key_file = options.traffic.key_file}));
  bool has_network = false;
  options.on_network = [&](std::int64_t, const std::string& url) {
    has_network = true;
    viewer.ShowNetwork(url);
  };
  const int code = RunShown(arguments, viewer);
  std::fflush(stdout);
  std::error_code missing;  // a run that failed before its first step has no log
  if (!std::filesystem::exists(options.log, missing)) return code;
  if (viewer.Runs()) {
    viewer.ShowLog(options.log);
  } else if (!has_network && options.announce) {  // --resume of a complete log makes no run
    Notice(fmt::format("--view: no page was opened; fogline view {} shows the log",
                       PathText(options.log)));
  }
  while (viewer.Runs() && !WasInterrupted()) std::this_thread::sleep_for(milliseconds(50));
  return code;
}

/// @throws CLI::ParseError for an option that contradicts --resume, or for a missing SCENARIO
/// without --resume
void CheckResume(const CLI::App& verb) {
  if (verb.get_option("--resume")->count() == 0) {
    if (verb.get_option("SCENARIO")->count() == 0) throw CLI::RequiredError("SCENARIO");
    return;
  }
  for (const char* of_the_log : {"SCENARIO", "--seed", "--set", "--log", "--force", "--run-id"}) {
    if (verb.get_option(of_the_log)->count() == 0) continue;
    throw CLI::ValidationError(
        fmt::format("{}: --resume goes on with the scenario and the log of its run", of_the_log));
  }
  if (verb.get_option("--realtime")->count() > 0) {
    throw CLI::ValidationError("--realtime: a run in real time cannot be resumed");
  }
  if (verb.get_option("--wall-clock")->count() > 0) {
    throw CLI::ValidationError("--wall-clock: --resume goes on as the log began");
  }
}

}  // namespace

void AddRun(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("run", "Run a scenario, one process for each role");
  const auto arguments = std::make_shared<RunArguments>(*verb);
  verb->callback([&action, arguments, verb] {
    CheckResume(*verb);
    action = [arguments] {
      ApplyOptions(*arguments);
      if (arguments->view) return RunAndView(*arguments);
      return arguments->resume.empty() ? RunNew(*arguments) : Resume(*arguments);
    };
  });
}

}  // namespace fogline
