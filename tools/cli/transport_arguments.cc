#include "tools/cli/transport_arguments.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/graph.h"
#include "services/runtime/process/program_options.h"
#include "services/runtime/transport/lcm_url.h"
#include "tools/cli/help.h"

namespace fogline::cli {
namespace {

// The options and the variable that may choose the transport of a run.
constexpr const char* kTransportOption = "--transport";
constexpr const char* kUrlOption = "--lcm-url";
constexpr const char* kUrlVariable = "LCM_DEFAULT_URL";
constexpr const char* kRelayFlag = "--relay";

// The names of the roles that may be external. The recorder may not: the runner reads the result
// from the log, so the recorder writes the log on the runner's machine.
std::vector<std::string> ExternalRoleNames() {
  std::vector<std::string> names;
  for (const RoleInfo& info : kRoles) {
    if (info.role != Role::kRecorder) names.emplace_back(info.name);
  }
  return names;
}

/// Checks a name in --external: refuses the recorder, and says why. The check against the list of
/// names would not say why.
std::string RefuseRecorder(const std::string& role) {
  return role == NameOf(Role::kRecorder) ? "recorder: the run's result is read from its own log"
                                         : "";
}

/// The option or variable that chose the transport of a run, and the transport, for an error
/// message.
std::string Said(const runner::RunOptions& options) {
  return options.transport_source + " " + options.transport;
}

/// Adds the options that start roles on other machines.
void AddPlanOptions(CLI::App& app, hosts::PlanWords& words) {
  app.add_option("--on", words.on,
                 "Start this role on another machine by ssh: fusion=[USER@]HOST, or "
                 "fusion=HOST:/FOLDER of Fogline's programs there (repeatable)")
      ->type_name("ROLE=HOST")
      ->allow_extra_args(false);
  app.add_option("--lab", words.lab,
                 "File with machines, their roles, network and key; --on wins if both name a role");
  app.add_option("--ssh", words.ssh,
                 "Command in place of ssh, with its options, such as 'ssh -p 2222' (default: "
                 "$FOGLINE_SSH, or ssh)");
  app.add_flag(kRelayFlag, words.relay,
               "With --on: messages go over TCP through a fogline-relay on this machine, because "
               "the network carries no multicast");
  app.add_option("--relay-at", words.relay_at,
                 "With --on: the relay listens at this ADDRESS[:PORT] (default: the address at "
                 "which the other machines see this one)");
}

}  // namespace

TransportArguments::TransportArguments(CLI::App& verb, std::string transport)
    : transport_(std::move(transport)) {
  said_ =
      verb.add_option(kTransportOption, transport_,
                      fmt::format("direct: one process, no messages; memq: one process, LCM in "
                                  "memory; udpm: one process per role on a multicast port of its "
                                  "own; tcpq: the same over TCP, through a fogline-relay of its "
                                  "own; or an LCM URL{}",
                                  transport_ == "direct" ? " (with --on or --lab: udpm)" : ""))
          ->capture_default_str();
  verb.add_option(kUrlOption, url_,
                  fmt::format("The same as --transport URL. Without either, processes{} use "
                              "$LCM_DEFAULT_URL, if set",
                              transport_ == "direct" ? " for --external" : ""))
      ->excludes(said_);
  verb.add_option("--external", external_, "Wait for this role, started elsewhere (repeatable)")
      ->allow_extra_args(false)
      ->check(RefuseRecorder)
      ->check(CLI::IsMember(ExternalRoleNames()));
  AddPlanOptions(verb, hosts_);
  verb.add_option("--wait", wait_s_, "Longest wait for roles started elsewhere, in s (0: for ever)")
      ->check(NumberIn(0, 1e6))
      ->capture_default_str();
  verb.add_flag("--same-build", same_build_,
                "End the run if the build of a role is unknown, or is not that of the runner");
  CLI::Option* verify = verb.add_flag(
      "--verify", verify_,
      "Compute each step again from the log and compare (default with --external, --on and "
      "--lab, and for a resumed run). Roles of another build and runs in real time are not "
      "compared");
  verb.add_flag("--no-verify", no_verify_, "Do not compute the steps again")->excludes(verify);
  runtime::AddTrafficOptions(verb, traffic_);
}

std::pair<std::string, std::string> TransportArguments::Chosen(const hosts::RunPlan& plan) const {
  if (!url_.empty()) return {url_, kUrlOption};
  if (said_->count() > 0) return {transport_, kTransportOption};
  if (plan.relay) return {"tcpq", kRelayFlag};
  if (!plan.url.empty()) return {plan.url, "--lab"};
  const std::string usual = transport_ == "direct" && !plan.empty() ? "udpm" : transport_;
  const bool as_processes = usual != "direct" || !external_.empty();
  const auto url = runtime::UrlOfEnvironment();
  if (url && as_processes) return {*url, kUrlVariable};
  return {usual, kTransportOption};
}

void TransportArguments::Apply(runner::RunOptions& options) const {
  options.hosts = hosts::MakePlan(hosts_);
  std::tie(options.transport, options.transport_source) = Chosen(options.hosts);
  const std::string& source = options.transport_source;
  const bool may_be_name = source == kTransportOption || source == kRelayFlag;
  if (!may_be_name || runtime::IsLcmUrl(options.transport)) {
    runtime::CheckUrl(source, options.transport);
  }
  options.wait = duration_cast<Duration>(std::chrono::duration<double>(wait_s_));
  options.traffic = traffic_;
  if (traffic_.key_file.empty()) options.traffic.key_file = options.hosts.key_file;
  // A wrong key is refused even if the run signs no messages.
  runtime::Check(options.traffic);
  if (options.transport == "direct" && !traffic_.faults.empty()) {
    throw InputError("error: --faults: a run with --transport direct has no messages");
  }
  if (options.transport == "direct" && verify_) {
    throw InputError(
        "error: --verify: a run with --transport direct is one process and has no messages that "
        "could be altered");
  }
  options.external.clear();
  for (const RoleInfo& info : kRoles) {
    if (std::ranges::find(external_, info.name) != external_.end()) {
      options.external.push_back(info.role);
    }
  }
  options.verify = verify_ ? std::optional(true) : no_verify_ ? std::optional(false) : std::nullopt;
  options.same_build = same_build_;
  CheckHosts(options);
  if (external_.empty()) return;
  if (IsOneProcess(options.transport)) {
    throw InputError(
        fmt::format("error: --external {}: no other process can join a run with {}, which is one "
                    "process",
                    external_.front(), Said(options)));
  }
}

void TransportArguments::CheckHosts(const runner::RunOptions& options) const {
  const hosts::RunPlan& plan = options.hosts;
  if (plan.empty()) return;
  const auto [role, place] = *plan.places.begin();
  const std::string where = fmt::format("{} on {}", NameOf(role), plan.hosts[place].name);
  if (IsOneProcess(options.transport)) {
    throw InputError(fmt::format("error: {}: a run with {} is one process", where, Said(options)));
  }
  if (plan.relay && options.transport != "tcpq") {
    throw InputError(
        fmt::format("error: --relay: the run has a relay of its own, and not the network {}",
                    options.transport));
  }
  const auto address = runtime::ParseMulticastUrl(options.transport);
  if (address && address->ttl == 0) {
    throw InputError(
        fmt::format("error: {}: messages to {} stay on this machine; other machines need ttl=1",
                    where, options.transport));
  }
  for (const Role external : options.external) {
    if (!plan.places.contains(external)) continue;
    throw InputError(fmt::format("error: --external {0}: the run itself starts the {0} on {1}",
                                 NameOf(external), plan.hosts[plan.places.at(external)].name));
  }
}

bool IsOneProcess(const std::string& transport) {
  return transport == "direct" || transport == "memq" || runtime::IsInMemory(transport);
}

void RequireProcesses(const runner::RunOptions& options, std::string_view what) {
  if (!IsOneProcess(options.transport)) return;
  throw InputError(
      fmt::format("error: {}: all roles are in one process; {} needs a process for each role",
                  Said(options), what));
}

void RunInRealtime(runner::RunOptions& options, double speed) {
  RequireProcesses(options, "a run in real time");
  if (options.pace != 0) {
    throw InputError("error: --pace: limits the speed of lockstep; with --realtime use --speed");
  }
  options.realtime = true;
  options.pace = speed;
}

void CheckPeriod(const Scenario& scenario, double speed) {
  const std::string why = runner::WhyTooFast(scenario, speed);
  if (!why.empty()) throw InputError(fmt::format("error: --speed {:g}: {}", speed, why));
}

}  // namespace fogline::cli
