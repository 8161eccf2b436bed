// fogline doctor: examines machine, network and types, and says what to do.
#include <algorithm>
#include <exception>
#include <functional>
#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/clock.h"
#include "common/errors.h"
#include "common/interrupt.h"
#include "common/process/programs.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/doctor/doctor_findings.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

using Level = doctor::Finding::Level;

constexpr const char* kExplanation =
    R"(Each finding is a line: its level, the finding, -> and a remedy. The level is ok, warning (runs
work, but slower or with less convenience) or problem (runs will fail). The doctor changes nothing
on the machine and ends no process. It takes about two seconds. Some findings have recipes below
them. A recipe has shell commands for root. Choose one that fits the machine. Its effect remains
after a restart of the machine, unless its title says otherwise.

With --with, two machines examine whether they hear each other: call it on both, each with the name
of the other. Each says which direction fails.

Examples:
  fogline doctor
  fogline doctor --with lab2 --lcm-url 'udpm://239.255.76.67:7700?ttl=1'     on lab1
  fogline doctor --with lab1 --lcm-url 'udpm://239.255.76.67:7700?ttl=1'     on lab2
  fogline doctor --lcm-url 'udpm://239.255.76.67:7700?ttl=1'
  fogline doctor --json | jq '.findings[] | select(.level != "ok")')";

struct DoctorArguments {
  explicit DoctorArguments(CLI::App& verb) : network(verb, "to examine") {
    CLI::Option* other = verb.add_option(
        "--with", with, "Another machine, on which `fogline doctor --with THIS_MACHINE` is called");
    verb.add_option("--wait", wait_s, "With --with: longest wait for the other machine, in s")
        ->check(cli::NumberIn(1, 1e6))
        ->needs(other)
        ->capture_default_str();
    verb.add_flag("--json", json, "Print the findings as JSON");
    cli::ShowExitCodes(verb,
                       {.done = "no problem", .check_failed = "a problem", .interruptible = true});
    verb.footer(kExplanation);
  }

  cli::NetworkArguments network;
  std::string with;
  double wait_s = 60;
  bool json = false;
};

/// Runs an examination. An exception other than InputError and Interrupted becomes a finding.
void Attempt(const char* check, doctor::Findings& findings, const std::function<void()>& examine) {
  try {
    examine();
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    findings.push_back({check, Level::kProblem, error.what(), ""});
  }
}

doctor::Findings Examine(const DoctorArguments& arguments) {
  const std::string url = arguments.network.Url();
  const std::filesystem::path programs = OwnFolder();
  doctor::Findings findings;
  Attempt("network", findings, [&] { doctor::ExamineNetwork(url, findings); });
  const bool works = std::ranges::none_of(
      findings, [](const doctor::Finding& finding) { return finding.level == Level::kProblem; });
  if (works && !arguments.with.empty()) {
    const auto limit = duration_cast<Duration>(std::chrono::duration<double>(arguments.wait_s));
    Attempt("with", findings, [&] { doctor::ExamineWith(url, arguments.with, limit, findings); });
  }
  if (works) Attempt("other_runs", findings, [&] { doctor::ExamineTraffic(url, findings); });
  Attempt("processes", findings, [&] { doctor::ExamineProcesses(findings); });
  Attempt("programs", findings, [&] { doctor::ExaminePrograms(programs, findings); });
  Attempt("tools", findings, [&] { doctor::ExamineTools(programs, findings); });
  Attempt("machine", findings, [&] { doctor::ExamineMachine(programs, findings); });
  return findings;
}

void PrintAsJson(const std::string& url, const doctor::Findings& findings) {
  nlohmann::ordered_json json{
      {"lcm_url", url}, {"problems", 0}, {"warnings", 0}, {"findings", nlohmann::json::array()}};
  for (const doctor::Finding& finding : findings) {
    if (finding.level == Level::kProblem) json["problems"] = json["problems"].get<int>() + 1;
    if (finding.level == Level::kWarning) json["warnings"] = json["warnings"].get<int>() + 1;
    nlohmann::ordered_json recipes = nlohmann::json::array();
    for (const doctor::Recipe& recipe : finding.recipes) {
      recipes.push_back({{"title", recipe.title}, {"script", recipe.script}});
    }
    json["findings"].push_back({{"check", finding.check},
                                {"level", NameOf(finding.level)},
                                {"what", finding.what},
                                {"remedy", finding.remedy},
                                {"recipes", std::move(recipes)}});
  }
  cli::PrintJson(json);
}

void PrintAsText(const doctor::Findings& findings) {
  for (const doctor::Finding& finding : findings) {
    // Any user can choose the names of processes, and the texts contain these names. So the texts
    // are escaped.
    fmt::print("{:<9}{}{}{}\n", NameOf(finding.level), EscapeControls(finding.what),
               finding.remedy.empty() ? "" : "  -> ", EscapeControls(finding.remedy));
    for (const doctor::Recipe& recipe : finding.recipes) {
      fmt::print("\n# {}\n{}", EscapeControls(recipe.title), EscapeLines(recipe.script));
    }
    if (!finding.recipes.empty()) fmt::print("\n");
  }
}

int Doctor(const DoctorArguments& arguments) {
  const std::string url = arguments.network.Url();
  if (!arguments.with.empty()) WatchInterrupts();  // the examination takes long
  const doctor::Findings findings = Examine(arguments);
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
