// fogline: the one program that a person runs. Every verb is in a file of its own.
#include <cstdio>
#include <exception>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "tools/fogline/interrupt.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

int Main(int argc, char** argv) {
  CLI::App app{"Fogline: a distributed testbed for traded control in fog.", "fogline"};
  app.set_version_flag("--version", FOGLINE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "Exit codes: 0 done, 1 a check failed, 2 bad input, 3 failure at run time, "
      "130 interrupted.\n`fogline VERB --help` explains a verb, with examples.");
  Action action;
  for (const auto add : {AddRun, AddTable, AddSweep, AddCalibrate, AddMetrics, AddReport, AddDigest,
                         AddDiff, AddGraph, AddCheck}) {
    add(app, action);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  try {
    return action();
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  } catch (const Interrupted& interrupted) {
    fmt::print(stderr, "fogline: {}\n", interrupted.what());
    return kInterrupted;
  } catch (const std::exception& error) {
    fmt::print(stderr, "fogline: error: {}\n", error.what());
    return kRunFailed;
  }
}

}  // namespace
}  // namespace fogline

int main(int argc, char** argv) { return fogline::Main(argc, argv); }
