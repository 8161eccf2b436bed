// The verbs of `fogline`. Each verb has a file of its own with one function. The function adds the
// verb to the command line and, when the verb is chosen, sets `action`. main() then runs this
// action.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/cli/action.h"

namespace fogline {

void AddRun(CLI::App& app, cli::Action& action);
void AddDrive(CLI::App& app, cli::Action& action);
void AddTable(CLI::App& app, cli::Action& action);
void AddSweep(CLI::App& app, cli::Action& action);
void AddMetrics(CLI::App& app, cli::Action& action);
void AddCompare(CLI::App& app, cli::Action& action);
void AddReport(CLI::App& app, cli::Action& action);
void AddDigest(CLI::App& app, cli::Action& action);
void AddEvents(CLI::App& app, cli::Action& action);
void AddDiff(CLI::App& app, cli::Action& action);
void AddReplay(CLI::App& app, cli::Action& action);
void AddExport(CLI::App& app, cli::Action& action);
void AddGraph(CLI::App& app, cli::Action& action);
void AddCheck(CLI::App& app, cli::Action& action);
void AddRecord(CLI::App& app, cli::Action& action);
void AddTop(CLI::App& app, cli::Action& action);
void AddSpy(CLI::App& app, cli::Action& action);
void AddLogplayer(CLI::App& app, cli::Action& action);
void AddHost(CLI::App& app, cli::Action& action);
void AddDoctor(CLI::App& app, cli::Action& action);
void AddKeygen(CLI::App& app, cli::Action& action);
void AddHelp(CLI::App& app, cli::Action& action);

}  // namespace fogline
