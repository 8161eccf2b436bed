// The keys of the messages between a runner and `fogline host` (json_lines.h). Both programs must
// have the same version. The first message of `fogline host` contains its version.
#pragma once

#include "common/clock.h"

namespace fogline::hosts {

// Keys of messages from the machine to the runner. "with:" means that the same message has the keys
// of the next lines, too.
inline constexpr const char* kHello = "fogline_host";  // version and message types; with:
inline constexpr const char* kHost = "host";           //   name of the machine
inline constexpr const char* kRunner = "runner";       //   address of the runner's machine, or ""
inline constexpr const char* kProblems = "problems";   // texts: result of the check
inline constexpr const char* kStarted = "started";     // a role: answer to kStart; with kPid, or:
inline constexpr const char* kWhy = "why";             //   why it cannot be started
inline constexpr const char* kEnded = "ended";         // a role: its process has ended; with kPid:
inline constexpr const char* kHow = "how";             //   how it ended
inline constexpr const char* kKilled = "killed";       //   whether a signal ended it
inline constexpr const char* kLines = "lines";         //   the last lines that it printed

// Keys of messages from the runner to the machine. "with:" has the same meaning as above.
inline constexpr const char* kCheck = "check";      // URL of the network to examine; with:
inline constexpr const char* kKey = "key";          //   the key, as in its file; "": none
inline constexpr const char* kSilence = "silence";  //   longest silence of the runner, in s
inline constexpr const char* kStart = "start";      // a role to start; with:
inline constexpr const char* kArguments = "arguments";
inline constexpr const char* kKill = "kill";  // process id of a role to kill

// In both directions.
inline constexpr const char* kPid = "pid";
// A sign of life. The machine answers with a list of [process id, activity].
inline constexpr const char* kAlive = "alive";

/// The interval between two signs of life of the runner. After one or two seconds without a STATUS,
/// the runner decides whether a process hangs. For this decision it compares two values of the
/// process's activity (RolePlace::ActivityOf()). Both must arrive within these one or two seconds.
inline constexpr Duration kAliveEvery = milliseconds(250);

}  // namespace fogline::hosts
