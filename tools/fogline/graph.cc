// fogline graph: prints the roles and channels, from the table that defines them.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/file.h"
#include "common/text.h"
#include "fogline/fingerprint.hpp"
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
  const std::string names = NamesOf(channel.to);
  if (channel.name == "STATUS") return names;
  return names.empty() ? "recorder" : names + ", recorder";
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

constexpr std::string_view kHeadOfRoles = "| role | program | does |\n";
constexpr std::string_view kHeadOfChannels = "| channel | type | from | to | what |\n";

std::string TableOfRoles() {
  std::string table = fmt::format("{}|---|---|---|\n", kHeadOfRoles);
  for (const RoleInfo& role : kRoles) {
    table += fmt::format("| {0} | `fogline-{0}` | {1} |\n", role.name, role.purpose);
  }
  return table;
}

std::string TableOfChannels() {
  std::string table = fmt::format("{}|---|---|---|---|---|\n", kHeadOfChannels);
  ForEachChannel([&table](const ChannelInfo& info, const auto& channel) {
    using M = typename std::decay_t<decltype(channel)>::Message;
    const std::string on_demand = NamesOf(info.on_demand);
    table += fmt::format("| {} | `{}` | {} | {}{}{} | {} |\n", info.name, M::getTypeName(),
                         Producer(info), Consumers(info), on_demand.empty() ? "" : "; on demand ",
                         on_demand, info.what);
  });
  return table;
}

/// Replaces a table in a Markdown page. @return whether the page has a table with this head
bool ReplaceTable(std::string& page, std::string_view head, const std::string& table) {
  const std::size_t begin = page.find(head);
  if (begin == std::string::npos) return false;
  std::size_t end = begin;
  while (end < page.size() && page[end] == '|') end = page.find('\n', end) + 1;
  page.replace(begin, end - begin, table);
  return true;
}

/// Replaces the tables of roles and channels in a Markdown page. @return the new page
/// @throws InputError if the page has neither table
std::string WithTables(const std::filesystem::path& file) {
  constexpr std::size_t kMostBytes = 10 << 20;
  FileText page = ReadFile(file, kMostBytes);
  if (!page.error.empty()) {
    throw InputError(fmt::format("{}: error: {}", PathText(file), page.error));
  }
  if (!page.text.ends_with('\n')) page.text += '\n';
  const bool has_roles = ReplaceTable(page.text, kHeadOfRoles, TableOfRoles());
  const bool has_channels = ReplaceTable(page.text, kHeadOfChannels, TableOfChannels());
  if (!has_roles && !has_channels) {
    throw InputError(fmt::format("{}: error: no table that begins with \"{}\" or \"{}\"",
                                 PathText(file), kHeadOfRoles.substr(0, kHeadOfRoles.size() - 1),
                                 kHeadOfChannels.substr(0, kHeadOfChannels.size() - 1)));
  }
  return std::move(page.text);
}

/// Replaces the tables in all pages. If one page has no table, no page is changed.
/// @throws InputError
void PutInto(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> pages;
  for (const std::filesystem::path& file : files) pages.push_back(WithTables(file));
  for (std::size_t i = 0; i < files.size(); ++i) {
    AtomicFile out(files[i]);
    out.Write(pages[i]);
    out.Finish();
  }
}

std::string Hexadecimal(std::int64_t hash) {
  return fmt::format("0x{:016x}", static_cast<std::uint64_t>(hash));
}

void PrintAsJson() {
  nlohmann::ordered_json json{{"type_fingerprint", Hexadecimal(TypeFingerprint())},
                              {"roles", nlohmann::ordered_json::array()},
                              {"channels", nlohmann::ordered_json::array()}};
  for (const RoleInfo& role : kRoles) {
    json["roles"].push_back({{"name", role.name}, {"purpose", role.purpose}});
  }
  ForEachChannel([&json](const ChannelInfo& info, const auto& channel) {
    using M = typename std::decay_t<decltype(channel)>::Message;
    json["channels"].push_back({{"name", info.name},
                                {"type", M::getTypeName()},
                                {"type_hash", Hexadecimal(M::getHash())},
                                {"from", Producer(info)},
                                {"to", Consumers(info)},
                                {"on_demand", NamesOf(info.on_demand)},
                                {"per_step", info.pace == Pace::kStep},
                                {"logged", info.Logged()},
                                {"what", info.what}});
  });
  cli::PrintJson(json);
}

struct GraphArguments {
  bool json = false;
  bool markdown = false;
  std::vector<std::filesystem::path> into;
};

}  // namespace

void AddGraph(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("graph", "Print the roles and channels");
  const auto arguments = std::make_shared<GraphArguments>();
  CLI::Option* json =
      verb->add_flag("--json", arguments->json, "Print as JSON instead of Markdown tables");
  CLI::Option* markdown =
      verb->add_flag("--markdown", arguments->markdown, "Print as Markdown tables, the default");
  verb->add_option("--into", arguments->into,
                   "Replace the tables of roles and channels in these pages, and print nothing")
      ->type_name("FILE...")
      ->excludes(json)
      ->excludes(markdown);
  markdown->excludes(json);
  cli::ShowExitCodes(*verb);
  verb->footer(
      "Examples:\n"
      "  fogline graph\n"
      "  fogline graph --into README.md docs/architecture.md   # after a change of the graph");
  verb->callback([&action, arguments] {
    action = [arguments] {
      PutInto(arguments->into);
      if (!arguments->into.empty()) return kDone;
      if (arguments->json) {
        PrintAsJson();
      } else {
        fmt::print("{}\n{}", TableOfRoles(), TableOfChannels());
      }
      return kDone;
    };
  });
}

}  // namespace fogline
