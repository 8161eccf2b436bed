#include "tools/hosts/run_plan.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/errors.h"
#include "common/text.h"
#include "services/runtime/transport/tcpq_url.h"
#include "tools/hosts/lab_file.h"

namespace fogline::hosts {
namespace {

constexpr const char* kSshVariable = "FOGLINE_SSH";

/// Returns the index of the machine in the plan. Adds the machine if the plan lacks it.
/// @throws InputError if the plan has the machine with another folder of programs
std::size_t PlaceOf(HostPlan host, RunPlan& plan, std::string_view where) {
  const auto found = std::ranges::find(plan.hosts, host.name, &HostPlan::name);
  const auto place = static_cast<std::size_t>(found - plan.hosts.begin());
  if (found == plan.hosts.end()) {
    plan.hosts.push_back(std::move(host));
  } else if (host.programs.empty()) {
    // The machine keeps the folder that the laboratory's file or another --on has given.
  } else if (found->programs.empty()) {
    found->programs = host.programs;
  } else if (found->programs != host.programs) {
    throw InputError(fmt::format("error: {}: the programs of {} are in {} already", where,
                                 Quote(host.name), Quote(found->programs)));
  }
  return place;
}

/// Adds the role and the machine of "ROLE=HOST" to the plan. @param placed the roles of the earlier
/// options; the function adds this role
/// @throws InputError
void AddPlace(const std::string& text, std::set<Role>& placed, RunPlan& plan) {
  const std::string where = "--on " + text;
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw InputError(fmt::format("error: {}: must be ROLE=HOST, such as fusion=user@lab2", where));
  }
  const std::string role = text.substr(0, equals);
  if (const std::string why = WhyNoRemoteRole(role); !why.empty()) {
    throw InputError(fmt::format("error: {}: {}", where, why));
  }
  if (!placed.insert(*RoleNamed(role)).second) {
    throw InputError(fmt::format("error: {}: another --on has a machine for the {}", where, role));
  }
  plan.places[*RoleNamed(role)] = PlaceOf(ReadHost(text.substr(equals + 1), where), plan, where);
}

/// Removes the machines that have no role.
void DropIdleHosts(RunPlan& plan) {
  std::vector<HostPlan> used;
  std::map<std::size_t, std::size_t> new_places;
  for (auto& [role, place] : plan.places) {
    const auto [at, is_new] = new_places.emplace(place, used.size());
    if (is_new) used.push_back(plan.hosts[place]);
    place = at->second;
  }
  plan.hosts = std::move(used);
}

RunPlan FromLab(const std::filesystem::path& file) {
  const LabPlan lab = LoadLab(file);
  RunPlan plan;
  for (const LabHostSection& host : lab.hosts) {
    for (const std::string& role : host.roles) plan.places[*RoleNamed(role)] = plan.hosts.size();
    plan.hosts.push_back({.name = host.name,
                          .destination = host.ssh.empty() ? host.name : host.ssh,
                          .programs = host.programs});
  }
  plan.ssh = lab.ssh;
  plan.relay = lab.relay || !lab.relay_at.empty();
  plan.relay_at = lab.relay_at;
  plan.url = lab.url;
  if (!lab.key.empty()) plan.key_file = (file.parent_path() / lab.key).string();
  return plan;
}

std::vector<std::string> WordsOf(const PlanWords& given) {
  std::vector<std::string> words;
  if (!given.lab.empty()) words.insert(words.end(), {"--lab", given.lab});
  for (const std::string& place : given.on) words.insert(words.end(), {"--on", place});
  if (!given.ssh.empty()) words.insert(words.end(), {"--ssh", given.ssh});
  if (given.relay) words.emplace_back("--relay");
  if (!given.relay_at.empty()) words.insert(words.end(), {"--relay-at", given.relay_at});
  return words;
}

}  // namespace

std::optional<Role> RoleNamed(std::string_view name) {
  const auto found = std::ranges::find(kRoles, name, &RoleInfo::name);
  return found == kRoles.end() ? std::nullopt : std::optional(found->role);
}

std::string WhyNoRemoteRole(std::string_view name) {
  if (name == NameOf(Role::kRecorder)) {
    return "the recorder runs on the machine of the run, whose result is read from its log";
  }
  if (RoleNamed(name)) return "";
  std::vector<std::string_view> names;
  for (const RoleInfo& info : kRoles) {
    if (info.role != Role::kRecorder) names.push_back(info.name);
  }
  return fmt::format("{} is no role{}; roles are {}", QuoteShort(name),
                     DidYouMean(Nearest(name, names)), Names(names));
}

std::string WhyNoDestination(std::string_view destination) {
  if (destination.empty()) return "the name of the machine is missing";
  if (destination.front() == '-') {
    return fmt::format("{} is no machine, because ssh would read it as an option",
                       QuoteShort(destination));
  }
  if (destination.find_first_of(" \t") != std::string_view::npos) {
    return fmt::format("{} is no machine, because it has a space", QuoteShort(destination));
  }
  if (destination.find('/') != std::string_view::npos && !destination.starts_with("ssh://")) {
    return fmt::format("{} is no machine, because it has a \"/\"; a folder begins with / or ~/",
                       QuoteShort(destination));
  }
  return "";
}

HostPlan ReadHost(std::string_view text, std::string_view where) {
  HostPlan host;
  const std::size_t colon = std::min(text.find(":/"), text.find(":~/"));
  // In "ssh://HOST", which is also a destination of ssh, the colon does not begin a folder.
  const bool has_folder = colon != std::string_view::npos && text.substr(colon, 3) != "://";
  host.destination = text.substr(0, has_folder ? colon : std::string_view::npos);
  host.name = host.destination;
  if (has_folder) host.programs = text.substr(colon + 1);
  if (const std::string why = WhyNoDestination(host.destination); !why.empty()) {
    throw InputError(fmt::format("error: {}: {}", where, why));
  }
  return host;
}

RunPlan MakePlan(const PlanWords& words) {
  RunPlan plan;
  if (!words.lab.empty()) plan = FromLab(words.lab);
  std::set<Role> placed;
  for (const std::string& place : words.on) AddPlace(place, placed, plan);
  DropIdleHosts(plan);
  if (!words.ssh.empty()) plan.ssh = words.ssh;
  if (plan.ssh.empty()) {
    const char* variable = std::getenv(kSshVariable);
    plan.ssh = variable != nullptr && *variable != '\0' ? variable : "ssh";
  }
  if (!words.relay_at.empty()) plan.relay_at = words.relay_at;
  plan.relay = plan.relay || words.relay || !words.relay_at.empty();
  plan.words = WordsOf(words);
  if (plan.empty() && !plan.words.empty()) {
    throw InputError(fmt::format("error: {}: no role runs on another machine; see --on",
                                 fmt::join(plan.words, " ")));
  }
  if (!plan.relay_at.empty()) {
    const std::string from = words.relay_at.empty() ? words.lab + ": /relay_at" : "--relay-at";
    if (plan.relay_at.starts_with(':')) {
      throw InputError(fmt::format("error: {}: the address before the port is missing", from));
    }
    if (runtime::tcpq::ResolveOwn(plan.relay_at, from).address == "0.0.0.0") {
      throw InputError(fmt::format(
          "error: {}: 0.0.0.0 is each machine itself; name the address at which the other machines "
          "reach this one",
          from));
    }
  }
  return plan;
}

}  // namespace fogline::hosts
