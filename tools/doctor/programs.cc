// Examines the programs that a run and its observers need.
#include <lcm/lcm.h>
#include <unistd.h>

#include <algorithm>
#include <map>

#include <fmt/core.h>

#include "common/clock.h"
#include "common/process/programs.h"
#include "common/text.h"
#include "services/graph.h"
#include "services/runtime/process/version.h"
#include "tools/doctor/doctor_findings.h"
#include "tools/processes/child.h"
#include "tools/processes/process_group.h"
#include "tools/spy/spy_parts.h"

namespace fogline::doctor {
namespace {

using Level = Finding::Level;
namespace fs = std::filesystem;

/// What to do if programs are missing or of another version.
std::string HowToGetPrograms() {
  const std::string command = processes::BuildCommand("fogline_programs");
  return command.empty() ? "install all programs of one version of Fogline" : command;
}

/// What to do if the message types for lcm-spy are missing. CMake builds them only if it has found
/// a JDK. So CMake must run again after a JDK is installed.
std::string HowToGetTypes() {
  const std::string build = processes::BuildFolder();
  return "apt-get install default-jdk; " +
         (build.empty() ? "build and install Fogline again"
                        : fmt::format("cmake {0} && ninja -C {0} fogline_lcmtypes_java", build));
}

void ExamineJava(Findings& findings) {
  const fs::path java = spy::JavaProgram();
  if (java.empty()) {
    findings.push_back({"java", Level::kWarning, "there is no Java: no lcm-spy",
                        "apt-get install default-jre; `fogline top` needs none"});
    return;
  }
  if (!spy::OpensWindows(java)) {
    findings.push_back({"java", Level::kWarning,
                        fmt::format("{} cannot open windows: no lcm-spy", PathText(java)),
                        "apt-get install default-jre (headless is not enough)"});
    return;
  }
  findings.push_back({"java", Level::kOk, fmt::format("{} is there", PathText(java)), ""});
}

void ExamineSpy(const fs::path& programs, Findings& findings) {
  for (const auto& [jar, package] :
       {std::pair{"lcm.jar", "liblcm-java"}, std::pair{"jchart2d.jar", "libjchart2d-java"}}) {
    if (!spy::InstalledJar(jar).empty()) continue;
    findings.push_back({"lcm_spy", Level::kWarning,
                        fmt::format("there is no /usr/share/java/{}: no lcm-spy", jar),
                        fmt::format("apt-get install {}", package)});
    return;
  }
  findings.push_back({"lcm_spy", Level::kOk, "the libraries of lcm-spy are there", ""});
  if (const fs::path jar = spy::TypesJar(programs); !jar.empty()) {
    findings.push_back({"lcm_spy_types", Level::kOk,
                        fmt::format("message types for lcm-spy: {}", PathText(jar)), ""});
    return;
  }
  findings.push_back({"lcm_spy_types", Level::kWarning,
                      "the message types for lcm-spy are not built: it decodes nothing",
                      HowToGetTypes()});
}

/// First line of the output of each role's program when it is called with --version.
std::map<Role, std::string> AskVersions(const fs::path& programs) {
  // Limit for all programs together. A busy machine takes a second to start one.
  constexpr Duration kLimit = milliseconds(20'000);
  std::map<Role, std::string> versions;
  processes::ProcessGroup group;
  for (const RoleInfo& info : kRoles) {
    const fs::path program = programs / fmt::format("fogline-{}", info.name);
    if (IsExecutable(program)) group.Start(info.role, program, {"--version"});
  }
  const TimePoint end = Clock::now() + kLimit;
  while (!group.empty() && Clock::now() < end) {
    for (const processes::ProcessGroup::Exit& exit : group.Collect()) {
      versions[exit.role] = exit.lines.empty() ? exit.how : exit.lines.front();
    }
    usleep(1000);
  }
  return versions;
}

}  // namespace

void ExamineTools(const fs::path& programs, Findings& findings) {
  findings.push_back(
      {"lcm", Level::kOk,
       fmt::format("LCM {}.{}.{}", LCM_MAJOR_VERSION, LCM_MINOR_VERSION, LCM_MICRO_VERSION), ""});
  for (const char* program : {"lcm-logger", "lcm-logplayer"}) {
    const fs::path file = FindProgram(program);
    if (file.empty()) {
      findings.push_back({"lcm_tools", Level::kWarning, fmt::format("there is no {}", program),
                          "apt-get install liblcm-bin"});
    } else {
      findings.push_back({"lcm_tools", Level::kOk, fmt::format("{} is there", PathText(file)), ""});
    }
  }
  ExamineJava(findings);
  ExamineSpy(programs, findings);
}

void ExaminePrograms(const fs::path& programs, Findings& findings) {
  const std::map<Role, std::string> versions = AskVersions(programs);
  const std::string own = runtime::VersionText();
  bool good = true;
  for (const RoleInfo& info : kRoles) {
    const std::string program = (programs / fmt::format("fogline-{}", info.name)).string();
    const auto version = versions.find(info.role);
    if (version != versions.end() && version->second == own) continue;
    good = false;
    findings.push_back(
        {"programs", Level::kProblem,
         version == versions.end()
             ? fmt::format("{} cannot be run", program)
             : fmt::format("{} is \"{}\", but fogline is \"{}\"", program, version->second, own),
         HowToGetPrograms()});
  }
  if (!good) return;
  findings.push_back(
      {"programs", Level::kOk,
       fmt::format("all {} programs in {} are {}", kRoles.size(), PathText(programs), own), ""});
}

}  // namespace fogline::doctor
