// fogline keygen: makes a key for signed traffic.
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "services/runtime/wire/message_signer.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct KeygenArguments {
  std::string file;
  bool json = false;
};

int Keygen(const KeygenArguments& arguments) {
  runtime::SigningKey::Create(arguments.file);
  if (arguments.json) cli::PrintJson(nlohmann::ordered_json{{"file", arguments.file}});
  return kDone;
}

}  // namespace

void AddKeygen(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("keygen", "Make a key for signed traffic (run --key)");
  const auto arguments = std::make_shared<KeygenArguments>();
  verb->add_option("FILE", arguments->file, "File to write; an existing file is refused")
      ->required();
  verb->add_flag("--json", arguments->json, "Print the name of the file as JSON");
  cli::ShowExitCodes(*verb);
  verb->footer(
      "The file has mode 0600. A key file that other users can read or change is refused. Every\n"
      "process of a run needs the same key, on every machine.\n\n"
      "Examples:\n"
      "  fogline keygen ~/lab.key\n"
      "  fogline run scenario/paper.json --key ~/lab.key\n"
      "  FOGLINE_KEY=~/lab.key fogline-driver");
  verb->callback([&action, arguments] { action = [arguments] { return Keygen(*arguments); }; });
}

}  // namespace fogline
