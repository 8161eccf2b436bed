// Verbs that are programs of their own beside `fogline`: few people need them, and they take long
// to build. `fogline VERB ...` is the same as `fogline-VERB ...`.
#pragma once

#include <array>

#include "tools/fogline/verbs.h"

namespace fogline {

struct OwnProgram {
  const char* verb;
  const char* purpose;  // one line in the list of verbs
};

inline constexpr OwnProgram kCalibrate{"calibrate", "Find values of fields that meet a table"};
inline constexpr OwnProgram kStudy{"study", "Answer an open question with runs and intervals"};
inline constexpr std::array kOwnPrograms{kCalibrate, kStudy};

/// Adds them to the list of verbs, for help and spelling; they have no action here.
void AddOwnPrograms(CLI::App& app, Action& action);

/// Becomes the program of the verb argv[1], or argv[2] after "help", if it is one of these. Returns
/// if not. A program that cannot be started is named on stderr and ends the process with
/// kRunFailed.
void BecomeOwnProgram(int argc, char** argv);

}  // namespace fogline
