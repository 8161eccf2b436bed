// fogline compare: compares the host of a run with a real car that was recorded behind the same
// leader.
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/compare/host_differences.h"
#include "tools/compare/recorded_car.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct CompareArguments {
  std::filesystem::path log;
  std::filesystem::path recording;
  std::string speed_column = "Speed2";
  std::string gap_column = "IVS1";
  std::filesystem::path out;
  bool json = false;
};

std::string ToText(const CompareArguments& arguments, const compare::HostDifferences& differences) {
  std::string text = fmt::format("{} beside {}, {} steps\n", PathText(arguments.log),
                                 PathText(arguments.recording), differences.speed_mps.steps());
  text += fmt::format("  {:<12}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "mean", "recorded", "RMSE",
                      "spread", "largest");
  const auto line = [](const char* name, const compare::Differences& d) {
    return fmt::format("  {:<12}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}\n", name, d.mean(),
                       d.recorded_mean(), d.rmse(), d.spread(), d.largest());
  };
  return text + line("speed [m/s]", differences.speed_mps) + line("gap [m]", differences.gap_m);
}

nlohmann::ordered_json ToJson(const CompareArguments& arguments,
                              const compare::HostDifferences& differences) {
  const compare::Differences& speed = differences.speed_mps;
  const compare::Differences& gap = differences.gap_m;
  return {{"log", arguments.log.string()},
          {"recording", arguments.recording.string()},
          {"steps", speed.steps()},
          {"speed_rmse_mps", speed.rmse()},
          {"gap_rmse_m", gap.rmse()},
          {"speed_spread_mps", speed.spread()},
          {"gap_spread_m", gap.spread()},
          {"largest_speed_difference_mps", speed.largest()},
          {"largest_gap_difference_m", gap.largest()},
          {"mean_speed_mps", speed.mean()},
          {"recorded_mean_speed_mps", speed.recorded_mean()},
          {"mean_gap_m", gap.mean()},
          {"recorded_mean_gap_m", gap.recorded_mean()}};
}

std::string ToCsv(const std::vector<compare::ComparedStep>& steps) {
  std::string csv = "time_s,speed_mps,recorded_speed_mps,gap_m,recorded_gap_m\n";
  for (const compare::ComparedStep& step : steps) {
    csv += fmt::format("{},{},{},{},{}\n", step.time_s, step.speed_mps, step.recorded_speed_mps,
                       step.gap_m, step.recorded_gap_m);
  }
  return csv;
}

int RunCompare(const CompareArguments& arguments) {
  cli::RefuseJsonBeside(arguments.out, "--out", arguments.json);
  const runner::LoggedRun run = runner::ReadLoggedRun(arguments.log);
  if (run.result.samples.empty()) cli::RefuseLog(arguments.log, "no steps");
  if (run.scenario.lead.profile != LeadProfile::kRecorded) {
    cli::RefuseLog(arguments.log, "/lead/profile: the leader of this run is not a recorded one");
  }
  const RecordedSection& recorded = run.scenario.lead.recorded;
  const compare::RecordedCar car = compare::ReadRecordedCar(
      arguments.recording, {.speed = arguments.speed_column, .gap = arguments.gap_column},
      recorded);
  compare::CheckTimes(car.times_s, recorded.start_s + run.result.samples.front().time_s,
                      recorded.start_s + run.result.samples.back().time_s, arguments.recording);
  compare::CheckLeader(car, recorded, run.result.samples, arguments.recording);
  const bool has_out = !arguments.out.empty();
  if (has_out) {
    std::error_code unknown;  // RequireWritable() says why the file cannot be examined
    if (IsReplaceable(arguments.out) && std::filesystem::exists(arguments.out, unknown)) {
      throw InputError(fmt::format("{}: error: --out: the file exists and is not replaced",
                                   PathText(arguments.out)));
    }
    RequireWritable(arguments.out, "--out");
  }
  const std::vector<compare::ComparedStep> steps =
      compare::CompareSteps(run.result.samples, recorded.start_s, car);
  const compare::HostDifferences differences = compare::DifferencesOf(steps);
  if (has_out) {
    WatchInterrupts();  // after this call, an interrupt leaves no partial file
    AtomicFile file(arguments.out);
    file.Write(ToCsv(steps));
    file.Finish();
  }
  if (!run.note.empty()) Complain(fmt::format("{}: {}", PathText(arguments.log), run.note));
  if (arguments.json) {
    cli::PrintJson(ToJson(arguments, differences));
  } else {
    cli::PrintBeside(arguments.out, ToText(arguments, differences));
  }
  return run.complete ? kDone : kCheckFailed;
}

}  // namespace

void AddCompare(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand(
      "compare", "Compare a run's host with a recorded car behind the same leader");
  const auto arguments = std::make_shared<CompareArguments>();
  verb->add_option("LOG", arguments->log, "Event log of a run behind the recorded leader")
      ->required();
  verb->add_option("RECORDING", arguments->recording,
                   "CSV file with a header line. The scenario's /lead/recorded names its time "
                   "column and the run's start")
      ->required();
  verb->add_option("--speed-column", arguments->speed_column, "Speed of the real car, m/s")
      ->capture_default_str();
  verb->add_option("--gap-column", arguments->gap_column,
                   "Gap of the real car to the leader, bumper to bumper, m")
      ->capture_default_str();
  verb->add_option("--out", arguments->out,
                   "Write run and recording, step by step, into this CSV file");
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "the log is not complete"});
  verb->footer(
      "RMSE: root mean square of the difference, run minus recording. spread: the same without\n"
      "the mean difference, which depends on the time gap. largest: the largest difference.\n\n"
      "Examples:\n"
      "  fogline run scenario/recorded_lead.json\n"
      "  fogline compare logs/recorded_lead-1.lcm scenario/data/acc_platoon_a.csv");
  verb->callback([&action, arguments] { action = [arguments] { return RunCompare(*arguments); }; });
}

}  // namespace fogline
