#include "tools/fogline/own_program.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "tools/fogline/child.h"

namespace fogline {

void AddOwnPrograms(CLI::App& app, Action&) {
  for (const OwnProgram& program : kOwnPrograms) {
    app.add_subcommand(program.verb, program.purpose);
  }
}

void BecomeOwnProgram(int argc, char** argv) {
  if (argc < 2 || std::ranges::find(kOwnPrograms, std::string_view(argv[1]), [](const auto& own) {
                    return std::string_view(own.verb);
                  }) == kOwnPrograms.end()) {
    return;
  }
  const std::string verb = argv[1];
  std::string name = "fogline-" + verb;
  const std::string program = ProgramBeside(name).string();
  argv[1] = name.data();
  execv(program.c_str(), argv + 1);
  fmt::print(stderr, "fogline {}: error: {}: {}{}\n", verb, program, std::strerror(errno),
             errno == ENOENT ? "; it is built by: ninja -C build " + name : "");
  std::exit(kRunFailed);
}

}  // namespace fogline
