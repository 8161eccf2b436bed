// What `fogline doctor` finds, and who finds it. Each function examines one subject and adds a
// finding for each thing that it looked at, good or bad; none changes anything on the machine.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fogline {

struct Finding {
  enum class Level {
    kOk,
    kWarning,  // works, but slower, less exactly or without some convenience
    kProblem,  // runs over this network will fail
  };
  std::string check;  // what was looked at: a key for programs
  Level level = Level::kOk;
  std::string what;
  std::string remedy;  // "" where there is nothing to do
};
using Findings = std::vector<Finding>;

/// "ok", "warning" or "problem".
std::string_view NameOf(Finding::Level level);

/// Route, multicast on this machine, socket filter, receive buffer, or the relay of a tcpq:// URL.
void ExamineNetwork(const std::string& url, Findings& findings);

/// What is heard on the network within a second: runs there, and runs that are announced there.
void ExamineTraffic(const std::string& url, Findings& findings);

/// Clock, wake-up, synchronisation, processors, disk.
void ExamineMachine(Findings& findings);

/// LCM's programs, Java and the message types for lcm-spy.
/// @param programs folder of this program
void ExamineTools(const std::filesystem::path& programs, Findings& findings);

/// fogline-ROLE beside this program: there, and of the same build.
void ExaminePrograms(const std::filesystem::path& programs, Findings& findings);

/// Processes of Fogline that run on this machine. None is touched.
void ExamineProcesses(Findings& findings);

}  // namespace fogline
