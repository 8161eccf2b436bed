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
#include "tools/cli/completion/completion.h"
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
  // After kComplete come the words up to the cursor, and the last word is to be completed. With
  // argc > 3 the last word is not the verb. So the program of the verb completes it.
  const bool completes = argc > 3 && std::string_view(argv[1]) == kComplete;
  const std::string verb = argv[help || completes ? 2 : 1];
  const auto is_verb = [&](const OwnProgram& program) { return program.verb == verb; };
  const auto own = std::ranges::find_if(kOwnPrograms, is_verb);
  if (own == kOwnPrograms.end()) return;
  std::string name = own->program;
  std::string option = help ? "--help" : kComplete;
  const std::string path = processes::ProgramBeside(name).string();
  argv[1] = name.data();
  if (help || completes) argv[2] = option.data();
  execv(path.c_str(), argv + 1);
  const int error = errno;
  Complain(fmt::format("fogline {}: error: {}: {}{}", verb, path, std::strerror(error),
                       error == ENOENT ? processes::HowToBuild(name) : ""));
  std::exit(kRunFailed);
}

}  // namespace fogline::cli
