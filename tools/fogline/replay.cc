// fogline replay: checks whether a role computes the same messages as those in a log.
#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/process/console.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/fogline/logs/live_replay.h"
#include "tools/fogline/verbs.h"
#include "tools/replay/role_check.h"
#include "tools/watch/role_cell.h"

namespace fogline {
namespace {

struct ReplayArguments {
  explicit ReplayArguments(CLI::App& verb) : live(verb) {}

  log::ReadOptions Options() const { return {.run_id = run_id}; }

  LiveReplay live;
  std::filesystem::path log;
  std::optional<std::int64_t> run_id;
  std::string role;
  bool all = false;
  bool json = false;
};

/// The run of a log, without its steps.
log::RunLog ReadRun(const ReplayArguments& arguments) {
  log::RunLogReader reader(arguments.log, arguments.Options());
  while (reader.Next() != nullptr) {
  }
  return reader.run();
}

/// @throws InputError if the log lacks data that one of the roles needs to be computed again
void RefuseOthers(const std::filesystem::path& log, const std::vector<replay::RoleCheck>& roles,
                  const log::RunLog& run) {
  const bool all = std::ranges::all_of(
      roles, [&](const replay::RoleCheck& one) { return replay::CanReplay(one.role, run); });
  if (all) return;
  cli::RefuseLog(
      log,
      "a run in real time: its log does not show which inputs had come by a role's deadline; "
      "replay computes all roles of a run in lockstep, but only the role driver of a run that a "
      "person drove");
}

/// @throws InputError if the chosen name is not a role, or if this role cannot be computed
std::vector<replay::RoleCheck> ChosenRoles(const ReplayArguments& arguments,
                                           const log::RunLog& run) {
  const log::DriverInputs inputs =
      run.scenario.person.drives
          ? log::DriverInputs(log::ReadDriverInputs(arguments.log, run.run_id))
          : log::DriverInputs();
  std::vector<replay::RoleCheck> roles = replay::MakeRoleChecks(run, inputs);
  std::erase_if(roles, [&](const replay::RoleCheck& one) {
    const std::string missing = replay::MissingChannels(one.role, run);
    if (missing.empty()) return false;
    const std::string why =
        fmt::format("the log has no {}, which the role {} needs here", missing, NameOf(one.role));
    if (NameOf(one.role) == arguments.role) cli::RefuseLog(arguments.log, why);
    if (arguments.all) Notice(fmt::format("{}: {}", PathText(arguments.log), why));
    return true;
  });
  std::vector<std::string_view> names;
  for (const replay::RoleCheck& one : roles) names.push_back(NameOf(one.role));
  if (arguments.all) return roles;
  std::erase_if(roles,
                [&](const replay::RoleCheck& one) { return NameOf(one.role) != arguments.role; });
  if (!roles.empty()) return roles;
  throw InputError(fmt::format("error: --role {}: not one of {}{}", Shown(arguments.role),
                               Shown(Names(names)), DidYouMean(Nearest(arguments.role, names))));
}

/// Whether a role computes the same messages: null if the log has no step to compare.
nlohmann::ordered_json SameJson(bool same, std::int64_t steps) {
  if (steps == 0) return nullptr;
  return same;
}

nlohmann::ordered_json ToJson(const replay::RoleCheck& one, std::int64_t steps) {
  nlohmann::ordered_json json{{"role", NameOf(one.role)},
                              {"same", SameJson(!one.first, steps)},
                              {"steps_that_differ", one.steps_that_differ}};
  if (!one.first) return json;
  json["first"] = {{"step", one.first->step},
                   {"channel", one.first->channel},
                   {"field", one.first->field},
                   {"log", one.first->a},
                   {"replay", one.first->b}};
  return json;
}

void PrintText(const replay::RoleCheck& one, std::int64_t steps) {
  if (steps == 0) {
    fmt::print("{} unknown: no step is compared\n", RoleCell(NameOf(one.role)));
    return;
  }
  if (!one.first) {
    fmt::print("{} same: {} steps\n", RoleCell(NameOf(one.role)), steps);
    return;
  }
  fmt::print("{} differs in {} of {} steps, first in step {}: {} {}: {} in the log, {} here\n",
             RoleCell(NameOf(one.role)), one.steps_that_differ, steps, one.first->step,
             one.first->channel, one.first->field, one.first->a, one.first->b);
}

int RunReplay(const ReplayArguments& arguments) {
  if (arguments.live.chosen()) {
    if (arguments.all || !arguments.role.empty()) {
      throw InputError("error: --live makes a run; --role and --all compute the steps of the log");
    }
    return arguments.live.Run(arguments.log, arguments.run_id, arguments.json);
  }
  if (arguments.all == !arguments.role.empty()) {
    throw InputError("error: give one of --role and --all");
  }
  const log::RunLog run = ReadRun(arguments);
  std::vector<replay::RoleCheck> roles = ChosenRoles(arguments, run);
  RefuseOthers(arguments.log, roles, run);
  log::RunLogReader reader(arguments.log, arguments.Options());
  try {
    replay::CheckRoles(reader, roles);
  } catch (const InputError& error) {
    cli::RefuseLog(arguments.log, error.what());
  }
  const bool same = std::ranges::all_of(
      roles, [](const replay::RoleCheck& one) { return !one.first.has_value(); });
  if (arguments.json) {
    nlohmann::ordered_json json{{"log", arguments.log.string()},
                                {"steps", run.steps},
                                {"complete", run.complete},
                                {"same", SameJson(same, run.steps)},
                                {"roles", nlohmann::ordered_json::array()}};
    for (const replay::RoleCheck& one : roles) json["roles"].push_back(ToJson(one, run.steps));
    cli::PrintJson(json);
  } else {
    for (const replay::RoleCheck& one : roles) PrintText(one, run.steps);
  }
  cli::SayAboutLog(arguments.log, run);
  return same && run.complete ? kDone : kCheckFailed;
}

}  // namespace

void AddReplay(CLI::App& app, cli::Action& action) {
  CLI::App* verb =
      app.add_subcommand("replay", "Compute a log's steps again, role by role, and compare");
  const auto arguments = std::make_shared<ReplayArguments>(*verb);
  verb->add_option("LOG", arguments->log, "Event log of a run")->required();
  CLI::Option* role =
      verb->add_option("--role", arguments->role, "Role to replay, such as fusion or arbitrator");
  verb->add_flag("--all", arguments->all, "Replay every role, each by itself")->excludes(role);
  cli::AddRunOption(*verb, arguments->run_id);
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "differs or is incomplete", .interruptible = true});
  verb->footer(
      "Each step takes its inputs from the log, so a difference in one role does not affect\n"
      "another role. Scenario and seed are those of the log, too. Outputs are compared bit by\n"
      "bit: a log from before a change shows which steps of which role the change alters.\n"
      "In a run in real time, only the role driver can be computed again, and only if a person\n"
      "drove: each command names the input of the person from which it was made.\n\n"
      "With --live, the messages of some channels come from the log, and all other roles compute\n"
      "new messages. This is an open loop: the recorded sensors do not react to the new motion of\n"
      "the cars. The scenario is that of the log; --set changes the roles that compute. The verb\n"
      "prints how much TRACK then differs from the log.\n\n"
      "Examples:\n"
      "  fogline run scenario/paper.json --log before.lcm\n"
      "  fogline replay before.lcm --role fusion      # after a change of the fusion\n"
      "  fogline replay before.lcm --all --json\n"
      "  fogline replay before.lcm --live --channels RADAR,LIDAR --set "
      "/fusion/radar_range_std_m=0.1");
  verb->callback([&action, arguments] { action = [arguments] { return RunReplay(*arguments); }; });
}

}  // namespace fogline
