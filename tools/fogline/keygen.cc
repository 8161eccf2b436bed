// fogline keygen: a key for signed traffic.
#include <memory>

#include <fmt/core.h>

#include "services/runtime/seal.h"
#include "tools/fogline/verbs.h"

namespace fogline {

void AddKeygen(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("keygen", "Make a key for signed traffic (run --key)");
  const auto file = std::make_shared<std::string>();
  verb->add_option("FILE", *file, "Where to write it; an existing file is refused")->required();
  verb->footer(
      "The file has mode 0600; one that others can read or change is refused. Every process\n"
      "of a run needs the same key, on every machine.\n\n"
      "Examples:\n"
      "  fogline keygen lab.key\n"
      "  fogline run scenario/paper.json --key lab.key\n"
      "  FOGLINE_KEY=lab.key fogline-driver");
  verb->callback([&action, file] {
    action = [file] {
      SealKey::Create(*file);
      return kDone;
    };
  });
}

}  // namespace fogline
