// fogline graph: prints the roles and channels, from the table that defines them.
#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "services/graph.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

std::string NamesOf(const RoleSet& roles) {
  std::string names;
  for (const RoleInfo& info : kRoles) {
    if (roles.Has(info.role)) names += fmt::format("{}{}", names.empty() ? "" : ", ", info.name);
  }
  if (roles.Has(Role::kRunner)) names += names.empty() ? "runner" : ", runner";
  return names;
}

std::string Consumers(const ChannelInfo& channel) {
  if (channel.name == "RUN" || channel.name == "RESEND") return "everyone";
  if (channel.name == "TRIAL") return "recorder";
  return NamesOf(channel.to) + (channel.name == "STATUS" ? "" : ", recorder");
}

std::string Producer(const ChannelInfo& channel) {
  if (channel.name == "DRIVER_INPUT") return "a seat";
  if (channel.name == "TRIAL") return "an experiment";
  const bool many = channel.pace == Pace::kControl && channel.name != "RUN";
  return many ? "everyone" : std::string(NameOf(channel.from));
}

template <class Visit>
void ForEachChannel(Visit&& visit) {
  std::size_t i = 0;
  std::apply([&](const auto&... channel) { (visit(kChannels[i++], channel), ...); }, kGraph);
}

void PrintMarkdown() {
  fmt::print("| role | program | does |\n|---|---|---|\n");
  for (const RoleInfo& role : kRoles) {
    fmt::print("| {0} | `fogline-{0}` | {1} |\n", role.name, role.purpose);
  }
  fmt::print("\n| channel | type | from | to | what |\n|---|---|---|---|---|\n");
  ForEachChannel([](const ChannelInfo& info, const auto& channel) {
    using M = typename std::decay_t<decltype(channel)>::Message;
    const std::string on_demand = NamesOf(info.on_demand);
    fmt::print("| {} | `{}` | {} | {}{}{} | {} |\n", info.name, M::getTypeName(), Producer(info),
               Consumers(info), on_demand.empty() ? "" : "; on demand ", on_demand, info.what);
  });
}

void PrintAsJson() {
  nlohmann::ordered_json json{{"roles", nlohmann::ordered_json::array()},
                              {"channels", nlohmann::ordered_json::array()}};
  for (const RoleInfo& role : kRoles) {
    json["roles"].push_back({{"name", role.name}, {"purpose", role.purpose}});
  }
  ForEachChannel([&json](const ChannelInfo& info, const auto& channel) {
    using M = typename std::decay_t<decltype(channel)>::Message;
    json["channels"].push_back({{"name", info.name},
                                {"type", M::getTypeName()},
                                {"from", Producer(info)},
                                {"to", Consumers(info)},
                                {"on_demand", NamesOf(info.on_demand)},
                                {"per_step", info.pace == Pace::kStep},
                                {"logged", info.Logged()},
                                {"what", info.what}});
  });
  cli::PrintJson(json);
}

}  // namespace

void AddGraph(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("graph", "Print the roles and channels");
  const auto json = std::make_shared<bool>(false);
  verb->add_flag("--json", *json, "Print as JSON instead of Markdown tables");
  cli::ShowExitCodes(*verb);
  verb->footer("Example:\n  fogline graph");
  verb->callback([&action, json] {
    action = [json] {
      *json ? PrintAsJson() : PrintMarkdown();
      return kDone;
    };
  });
}

}  // namespace fogline
