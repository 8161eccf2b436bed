// fogline host: starts roles on this machine for a run of another machine.
#include <unistd.h>

#include <string>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/process/console.h"
#include "tools/cli/help.h"
#include "tools/doctor/doctor_findings.h"
#include "tools/fogline/verbs.h"
#include "tools/hosts/host_agent.h"
#include "tools/hosts/json_lines.h"

namespace fogline {
namespace {

constexpr const char* kHostExplanation =
    R"(fogline run --on ROLE=HOST starts this verb on HOST by ssh. It reads orders on stdin and answers
on stdout, with a JSON object on each line. It ends the roles that it has started when stdin ends,
or when the run is silent for 15 s longer than the run's stall timeout.

Examples:
  fogline run scenario/paper.json --on fusion=user@lab2
  ssh user@lab2 fogline host </dev/null        shows what lab2 would answer)";

/// The problems that this machine has with a network, each with its remedy if there is one.
std::vector<std::string> ProblemsOf(const std::string& url) {
  doctor::Findings findings;
  try {
    doctor::ExamineNetwork(url, findings);
  } catch (const std::exception& error) {
    return {error.what()};
  }
  std::vector<std::string> problems;
  for (const doctor::Finding& finding : findings) {
    if (finding.level != doctor::Finding::Level::kProblem) continue;
    problems.push_back(finding.remedy.empty()
                           ? finding.what
                           : fmt::format("{} -> {}", finding.what, finding.remedy));
  }
  return problems;
}

int Host() {
  if (isatty(STDIN_FILENO) == 1) {
    throw InputError("error: stdin is a terminal: fogline run --on ROLE=HOST starts this verb");
  }
  try {
    hosts::ServeRunner(ProblemsOf);
  } catch (const hosts::NotUnderstood& error) {
    throw InputError(fmt::format("error: stdin: {}", error.what()));
  }
  return kDone;
}

}  // namespace

void AddHost(CLI::App& app, cli::Action& action) {
  CLI::App* verb =
      app.add_subcommand("host", "Start roles on this machine for a run of another machine");
  cli::ShowExitCodes(*verb, {.done = "the run has ended"});
  verb->footer(kHostExplanation);
  verb->callback([&action] { action = [] { return Host(); }; });
}

}  // namespace fogline
