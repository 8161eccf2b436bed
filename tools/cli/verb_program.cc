#include "tools/cli/verb_program.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/this_process.h"
#include "common/text.h"
#include "services/runtime/process/version.h"
#include "tools/cli/completion/completion.h"
#include "tools/cli/help.h"
#include "tools/cli/refusal.h"

namespace fogline::cli {
namespace {

constexpr const char* kNoStdout = "standard output cannot be written (a full disk?)";

/// Runs the action of a verb, and prints the verb's error, if any. @return the exit code of the
/// verb
int Run(const CLI::App& app, const Action& action) {
  const std::string name = CommandName(app);
  try {
    const int code = action();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      throw std::runtime_error(kNoStdout);
    }
    return code;
  } catch (const InputError& error) {
    // An error in a file has a text that begins with the place of the error. An error in the
    // arguments has a text that begins with "error:".
    const std::string_view what = error.what();
    Complain(what.starts_with("error:") ? fmt::format("{}: {}", name, EscapeControls(what))
                                        : std::string(what));
    return kBadInput;
  } catch (const Interrupted& interrupted) {
    Complain(fmt::format("{}: {}", name, interrupted.what()));
    return kInterrupted;
  } catch (const CheckFailed& error) {
    Complain(fmt::format("{}: error: {}", name, error.what()));
    return kCheckFailed;
  } catch (const std::system_error& error) {
    // An error of fmt::print() does not say which file cannot be written. If this file is stdout,
    // kNoStdout says so.
    Complain(fmt::format("{}: error: {}", name, std::ferror(stdout) ? kNoStdout : error.what()));
    return kRunFailed;
  } catch (const std::exception& error) {
    Complain(fmt::format("{}: error: {}", name, error.what()));
    return kRunFailed;
  }
}

/// @param arguments the command line without the program's name, in reverse order, as CLI11 needs
///     it
/// @param asks_for_completion whether to print the words that may replace the last argument
int Main(std::vector<std::string> arguments, std::initializer_list<AddVerb> verbs,
         bool asks_for_completion) {
  FailWritesBeyondTheSizeLimit();
  CLI::App app{"Fogline: a distributed testbed for traded control in fog.", "fogline"};
  app.set_version_flag("--version", runtime::VersionText());
  app.require_subcommand(0, 1);
  app.formatter(std::make_shared<HelpFormatter>());
  ShowExitCodes(app, {.check_failed = "a check failed", .interruptible = true});
  app.footer(
      "`fogline VERB --help` or `fogline help VERB` explains a verb, with examples.\n\n"
      "Examples:\n"
      "  fogline run scenario/paper.json\n"
      "  fogline table --help");
  Action action;
  for (const AddVerb add : verbs) add(app, action);
  if (asks_for_completion) {
    std::ranges::reverse(arguments);
    fmt::print("{}", ToText(Complete(app, arguments)));
    return kDone;
  }
  RefuseIgnoredValues(app);
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::Success& asked) {  // --help, --version
    if (const std::string misfit = UnknownVerb(app); !misfit.empty()) {
      Complain(misfit);
      return kBadInput;
    }
    action = [&app, asked] { return app.exit(asked); };
  } catch (const CLI::ParseError& error) {
    Complain(Refusal(app, error));
    return kBadInput;
  }
  if (!action) {  // without a verb: print the help, exit code 0, as Rust's cargo does
    action = [&app] {
      fmt::print("{}", HelpText(app, app));
      return kDone;
    };
  }
  return Run(app, action);
}

/// Whether a command line asks for completion. Then its other words are the command line to
/// complete.
bool AsksForCompletion(int argc, char** argv) {
  return argc > 1 && std::string_view(argv[1]) == kComplete;
}

std::vector<std::string> Reversed(int argc, char** argv) {
  std::vector<std::string> arguments = AsksForCompletion(argc, argv)
                                           ? std::vector<std::string>(argv + 2, argv + argc)
                                           : SeparateEmptyValues({argv + 1, argv + argc});
  std::ranges::reverse(arguments);
  return arguments;
}

}  // namespace

int RunVerbs(int argc, char** argv, std::initializer_list<AddVerb> verbs) {
  TakeStandardDescriptors();
  return Main(Reversed(argc, argv), verbs, AsksForCompletion(argc, argv));
}

int RunOneVerb(int argc, char** argv, AddVerb verb) {
  TakeStandardDescriptors();
  if (argc == 2 && std::string_view(argv[1]) == "--version") return RunVerbs(argc, argv, {verb});
  CLI::App probe;
  Action ignored;
  verb(probe, ignored);
  std::vector<std::string> arguments = Reversed(argc, argv);
  arguments.push_back(probe.get_subcommands({}).front()->get_name());
  return Main(std::move(arguments), {verb}, AsksForCompletion(argc, argv));
}

}  // namespace fogline::cli
