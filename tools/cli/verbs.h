// The verbs of `fogline`. Each verb has a file of its own with one function, which adds the verb to
// the command line and, when the verb is chosen, sets `action`; main() runs the action then.
#pragma once

#include <functional>
#include <stdexcept>

#include <CLI/CLI.hpp>

namespace fogline {

/// Action of the chosen verb; returns the exit code.
using Action = std::function<int()>;

/// Exit codes of every verb.
enum ExitCode : int {
  kDone = 0,
  kCheckFailed = 1,
  kBadInput = 2,
  kRunFailed = 3,
  kInterrupted = 130
};

/// Ends a verb with kCheckFailed.
class CheckFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void AddRun(CLI::App& app, Action& action);
void AddTable(CLI::App& app, Action& action);
void AddSweep(CLI::App& app, Action& action);
void AddMetrics(CLI::App& app, Action& action);
void AddCompare(CLI::App& app, Action& action);
void AddReport(CLI::App& app, Action& action);
void AddDigest(CLI::App& app, Action& action);
void AddEvents(CLI::App& app, Action& action);
void AddDiff(CLI::App& app, Action& action);
void AddReplay(CLI::App& app, Action& action);
void AddExport(CLI::App& app, Action& action);
void AddGraph(CLI::App& app, Action& action);
void AddCheck(CLI::App& app, Action& action);
void AddTop(CLI::App& app, Action& action);
void AddSpy(CLI::App& app, Action& action);
void AddDoctor(CLI::App& app, Action& action);
void AddKeygen(CLI::App& app, Action& action);
void AddHelp(CLI::App& app, Action& action);

}  // namespace fogline
