// Findings of `fogline doctor`, and the functions that make them. Each function examines one
// subject and adds a finding, good or bad, for each item. No function changes anything on the
// machine.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

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
  std::string remedy;  // "" if no remedy is needed
};
using Findings = std::vector<Finding>;

/// "ok", "warning" or "problem".
std::string_view NameOf(Finding::Level level);

/// Examines route, multicast, socket filter and receive buffer, or the relay of a tcpq:// URL.
void ExamineNetwork(const std::string& url, Findings& findings);

/// Finds the runs on the network, and the runs that are announced on the network, within a second.
void ExamineTraffic(const std::string& url, Findings& findings);

/// Examines clock, wake-up time, synchronisation, processors and disk.
void ExamineMachine(Findings& findings);

/// Examines LCM's programs, Java and the message types for lcm-spy.
/// @param programs folder of this program
void ExamineTools(const std::filesystem::path& programs, Findings& findings);

/// Examines whether fogline-ROLE programs exist beside this program, and whether they print the
/// same version and message types.
void ExaminePrograms(const std::filesystem::path& programs, Findings& findings);

/// Finds processes of Fogline that run on this machine. The function does not disturb them.
void ExamineProcesses(Findings& findings);

}  // namespace fogline::doctor
