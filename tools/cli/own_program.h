// Verbs that are separate programs in the folder of `fogline`. They take long to build, and
// `fogline` itself does not need their libraries. `fogline VERB ...` does the same as `PROGRAM
// ...`.
#pragma once

#include <array>

#include <CLI/CLI.hpp>

#include "tools/cli/action.h"

namespace fogline::cli {

struct OwnProgram {
  const char* verb;
  const char* program;
  const char* purpose;  // one line in the list of verbs
};

inline constexpr OwnProgram kCalibrate{"calibrate", "fogline-calibrate",
                                       "Find values of fields that meet a table"};
inline constexpr OwnProgram kStudy{"study", "fogline-study",
                                   "Answer an open question with runs and intervals"};
inline constexpr OwnProgram kExperiment{"experiment", "fogline-experiment",
                                        "Make trials with people: orders, questions, tables"};
inline constexpr OwnProgram kView{"view", "fogline-web", "Show a run or a log in a browser"};
inline constexpr std::array kOwnPrograms{kCalibrate, kStudy, kExperiment, kView};

/// Adds the verbs of kOwnPrograms to the list of verbs, for the help text and for spelling hints.
/// These verbs get no action, because BecomeOwnProgram() starts their programs.
void AddOwnPrograms(CLI::App& app, Action& action);

/// Replaces this process by the program of a verb. The verb is argv[1], or argv[2] if argv[1] is
/// "help" or "--complete". The function returns if this verb has no program of its own. If the
/// program cannot be started, the function prints an error on stderr and ends the process with
/// kRunFailed.
void BecomeOwnProgram(int argc, char** argv);

}  // namespace fogline::cli
