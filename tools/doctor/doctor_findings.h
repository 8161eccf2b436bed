// Findings of `fogline doctor`, and the functions that make them. Each function examines one
// subject and adds a finding, good or bad, for each item. No function changes anything on the
// machine.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/clock.h"
#include "tools/doctor/recipes.h"

namespace fogline::doctor {

struct Finding {
  enum class Level {
    kOk,
    kWarning,  // works, but slower, less exact or less convenient
    kProblem,  // runs over this network will fail
  };
  std::string check;  // key of the examined item, for programs that read the findings
  Level level = Level::kOk;
  std::string what;
  std::string remedy;           // "" if no remedy is needed
  std::vector<Recipe> recipes;  // shell commands for the remedy; a title says the purpose of each
};
using Findings = std::vector<Finding>;

/// Name of a level: "ok", "warning" or "problem".
std::string_view NameOf(Finding::Level level);

/// Examines route, multicast, socket filter and receive buffer, or the relay of a tcpq:// URL.
void ExamineNetwork(const std::string& url, Findings& findings);

/// Listens to the network for a second. Finds the runs on the network, the runs that are announced
/// there, and the roles that wait for a run.
void ExamineTraffic(const std::string& url, Findings& findings);

/// Examines whether this machine and another machine hear each other on the network. `fogline
/// doctor --with` must run on both machines at the same time.
/// @param host name or address of the other machine
/// @param limit longest wait for messages of the other machine
/// @throws Interrupted
void ExamineWith(const std::string& url, const std::string& host, Duration limit,
                 Findings& findings);

/// Examines clock, real-time priority, wake-up time, synchronisation, processors and disk.
/// @param programs folder of this program
void ExamineMachine(const std::filesystem::path& programs, Findings& findings);

/// Examines LCM's programs, Java and the message types for lcm-spy.
/// @param programs folder of this program
void ExamineTools(const std::filesystem::path& programs, Findings& findings);

/// Examines whether fogline-ROLE programs exist beside this program, and whether they print the
/// same version and message types.
void ExaminePrograms(const std::filesystem::path& programs, Findings& findings);

/// Finds processes of Fogline that run on this machine. The function does not disturb them.
void ExamineProcesses(Findings& findings);

}  // namespace fogline::doctor
