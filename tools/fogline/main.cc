// fogline: the one program that a person runs. Every verb is in a file of its own.
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "services/runtime/version.h"
#include "tools/fogline/help.h"
#include "tools/fogline/interrupt.h"
#include "tools/fogline/refusal.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

int Main(int argc, char** argv) {
  CLI::App app{"Fogline: a distributed testbed for traded control in fog.", "fogline"};
  app.set_version_flag("--version", VersionText());
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(
      "Exit codes: 0 done, 1 a check failed, 2 bad input, 3 failure at run time, "
      "130 interrupted.\n`fogline VERB --help` explains a verb, with examples.\n\n"
      "Examples:\n"
      "  fogline run scenario/paper.json\n"
      "  fogline table --help");
  Action action;
  for (const auto add : {AddRun, AddTable, AddSweep, AddCalibrate, AddStudy, AddMetrics, AddCompare,
                         AddReport, AddDigest, AddDiff, AddEvents, AddReplay, AddExport, AddGraph,
                         AddCheck, AddTop, AddDoctor, AddKeygen}) {
    add(app, action);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    action = [&app, asked] { return app.exit(asked); };
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "{}\n", Refusal(app, error));
    return kBadInput;
  }
  const std::string name = CommandName(app);
  try {
    const int code = action();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      throw std::runtime_error("standard output cannot be written, such as on a full disk");
    }
    return code;
  } catch (const InputError& error) {
    // A mistake in a file begins with its place, one in the arguments with "error:".
    const std::string_view what = error.what();
    fmt::print(stderr, "{}{}\n", what.starts_with("error:") ? name + ": " : "", what);
    return kBadInput;
  } catch (const Interrupted& interrupted) {
    fmt::print(stderr, "{}: {}\n", name, interrupted.what());
    return kInterrupted;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: error: {}\n", name, error.what());
    return kRunFailed;
  }
}

}  // namespace
}  // namespace fogline

int main(int argc, char** argv) { return fogline::Main(argc, argv); }
