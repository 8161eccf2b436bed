#include "tools/cli/own_program.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "common/process/console.h"
#include "tools/processes/child.h"

namespace fogline::cli {

void AddOwnPrograms(CLI::App& app, Action&) {
  for (const OwnProgram& program : kOwnPrograms) {
    app.add_subcommand(program.verb, program.purpose);
  }
}

void BecomeOwnProgram(int argc, char** argv) {
  if (argc < 2) return;
  const bool help = argc == 3 && std::string_view(argv[1]) == "help";
  const std::string verb = argv[help ? 2 : 1];
  const auto is_verb = [&](const OwnProgram& own) { return own.verb == verb; };
  if (std::ranges::none_of(kOwnPrograms, is_verb)) return;
  std::string name = "fogline-" + verb;
  std::string option = "--help";
  const std::string program = processes::ProgramBeside(name).string();
  argv[1] = name.data();
  if (help) argv[2] = option.data();
  execv(program.c_str(), argv + 1);
  Complain(fmt::format("fogline {}: error: {}: {}{}", verb, program, std::strerror(errno),
                       errno == ENOENT ? "; it is built by: ninja -C build " + name : ""));
  std::exit(kRunFailed);
}

}  // namespace fogline::cli
