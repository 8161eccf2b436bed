// fogline doctor: examines machine, network and types, and says what to do.
#include <algorithm>
#include <exception>
#include <functional>
#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/errors.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/doctor/doctor_findings.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

using Level = doctor::Finding::Level;

constexpr const char* kExplanation =
    R"(Each finding is a line: its level, what was found, and after -> what to do. The level is ok,
warning (runs work, but slower or with less convenience) or problem (runs will fail). The doctor
changes nothing on the machine and ends no process. It takes about two seconds.

Examples:
  fogline doctor
  fogline doctor --lcm-url 'udpm://239.255.76.67:7700?ttl=1'
  fogline doctor --json | jq '.findings[] | select(.level != "ok")')";

struct DoctorArguments {
  explicit DoctorArguments(CLI::App& verb) : network(verb, "to examine") {
    verb.add_flag("--json", json, "Print the findings as JSON");
    cli::ShowExitCodes(verb, {.done = "no problem", .check_failed = "a problem"});
    verb.footer(kExplanation);
  }

  cli::NetworkArguments network;
  bool json = false;
};

/// Runs an examination. An exception (except InputError) becomes a finding, too.
void Attempt(const char* check, doctor::Findings& findings, const std::function<void()>& examine) {
  try {
    examine();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    findings.push_back({check, Level::kProblem, error.what(), ""});
  }
}

doctor::Findings Examine(const std::string& url) {
  const auto programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  doctor::Findings findings;
  Attempt("network", findings, [&] { doctor::ExamineNetwork(url, findings); });
  const bool works = std::ranges::none_of(
      findings, [](const doctor::Finding& finding) { return finding.level == Level::kProblem; });
  if (works) Attempt("other_runs", findings, [&] { doctor::ExamineTraffic(url, findings); });
  Attempt("processes", findings, [&] { doctor::ExamineProcesses(findings); });
  Attempt("programs", findings, [&] { doctor::ExaminePrograms(programs, findings); });
  Attempt("tools", findings, [&] { doctor::ExamineTools(programs, findings); });
  Attempt("machine", findings, [&] { doctor::ExamineMachine(findings); });
  return findings;
}

void PrintAsJson(const std::string& url, const doctor::Findings& findings) {
  nlohmann::ordered_json json{
      {"lcm_url", url}, {"problems", 0}, {"warnings", 0}, {"findings", nlohmann::json::array()}};
  for (const doctor::Finding& finding : findings) {
    if (finding.level == Level::kProblem) json["problems"] = json["problems"].get<int>() + 1;
    if (finding.level == Level::kWarning) json["warnings"] = json["warnings"].get<int>() + 1;
    json["findings"].push_back({{"check", finding.check},
                                {"level", NameOf(finding.level)},
                                {"what", finding.what},
                                {"remedy", finding.remedy}});
  }
  cli::PrintJson(json);
}

void PrintAsText(const doctor::Findings& findings) {
  for (const doctor::Finding& finding : findings) {
    // Texts contain names of processes, which any user can choose. So they are escaped.
    fmt::print("{:<9}{}{}{}\n", NameOf(finding.level), EscapeControls(finding.what),
               finding.remedy.empty() ? "" : "  -> ", EscapeControls(finding.remedy));
  }
}

int Doctor(const DoctorArguments& arguments) {
  const std::string url = arguments.network.Url();
  const doctor::Findings findings = Examine(url);
  arguments.json ? PrintAsJson(url, findings) : PrintAsText(findings);
  const bool problem = std::ranges::any_of(
      findings, [](const doctor::Finding& finding) { return finding.level == Level::kProblem; });
  return problem ? kCheckFailed : kDone;
}

}  // namespace

void AddDoctor(CLI::App& app, cli::Action& action) {
  CLI::App* verb =
      app.add_subcommand("doctor", "Examine machine, network and types, and say what to do");
  const auto arguments = std::make_shared<DoctorArguments>(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return Doctor(*arguments); }; });
}

}  // namespace fogline
