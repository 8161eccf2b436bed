// fogline diff: names the first step and field in which two runs differ.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/process/console.h"
#include "common/text.h"
#include "services/runtime/process/program_options.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"
#include "tools/replay/difference.h"

namespace fogline {
namespace {

struct DiffArguments {
  std::filesystem::path a;
  std::filesystem::path b;
  std::optional<std::int64_t> run_a;
  std::optional<std::int64_t> run_b;
  bool json = false;
};

/// Name of a run for the user: "log.lcm", or "run 4711 of log.lcm" if the user has chosen a run.
std::string NameOf(const std::filesystem::path& log, std::optional<std::int64_t> run_id) {
  return run_id ? fmt::format("run {} of {}", *run_id, PathText(log)) : PathText(log);
}

int RunDiff(const DiffArguments& arguments) {
  log::RunLogReader reader_a(arguments.a, {.run_id = arguments.run_a});
  log::RunLogReader reader_b(arguments.b, {.run_id = arguments.run_b});
  const std::string name_a = NameOf(arguments.a, arguments.run_a);
  const std::string name_b = NameOf(arguments.b, arguments.run_b);
  std::optional<replay::Difference> difference;
  std::int64_t step = 0;
  const log::StepMessages* a = nullptr;
  const log::StepMessages* b = nullptr;
  while (true) {
    a = reader_a.Next();
    b = reader_b.Next();
    if (a == nullptr && b == nullptr) break;
    if (a == nullptr || b == nullptr) {
      if (step == 0) break;  // one log has no whole step, so nothing is compared
      difference = {.step = step,
                    .channel = "(run)",
                    .field = "(step)",
                    .a = a == nullptr ? "none" : "there",
                    .b = b == nullptr ? "none" : "there"};
      break;
    }
    if ((difference = replay::FirstDifference(step, *a, *b))) break;
    ++step;
  }
  if (arguments.json) {
    nlohmann::ordered_json json{{"equal", !difference}};
    if (!difference && step == 0) json["equal"] = nullptr;
    if (difference) {
      json["step"] = difference->step;
      json["channel"] = difference->channel;
      json["field"] = difference->field;
      json["a"] = difference->a;
      json["b"] = difference->b;
    } else {
      json["steps"] = step;
    }
    cli::PrintJson(json);
  } else if (difference) {
    fmt::print("step {}: {} {}: {} in {}, {} in {}\n", difference->step, difference->channel,
               difference->field, difference->a, name_a, difference->b, name_b);
  } else if (step == 0) {
    fmt::print("unknown: no step is compared\n");
  } else {
    fmt::print("equal: {} steps\n", step);
  }
  // The remarks on a log are known only if the log was read to its end.
  const auto remark = [](const log::RunLogReader& reader, const std::string& name) {
    if (!reader.run().note.empty()) Complain(fmt::format("{}: {}", name, reader.run().note));
  };
  if (a == nullptr) remark(reader_a, name_a);
  if (b == nullptr) remark(reader_b, name_b);
  const bool complete = difference || (reader_a.run().complete && reader_b.run().complete);
  return difference || !complete ? kCheckFailed : kDone;
}

}  // namespace

void AddDiff(CLI::App& app, cli::Action& action) {
  CLI::App* verb =
      app.add_subcommand("diff", "Name the first step and field in which two logs differ");
  const auto arguments = std::make_shared<DiffArguments>();
  verb->add_option("A", arguments->a, "Event log")->required();
  verb->add_option("B", arguments->b, "Event log")->required();
  runtime::AddRunIdOption(*verb, "--run-a", arguments->run_a,
                          "Id of the run of A (default: the first run in the log)");
  runtime::AddRunIdOption(*verb, "--run-b", arguments->run_b,
                          "Id of the run of B (default: the first run in the log)");
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb,
                     {.done = "equal runs", .check_failed = "they differ or are not complete"});
  verb->footer(
      "Examples:\n"
      "  fogline diff logs/paper-1.lcm logs/paper-2.lcm\n"
      "  fogline diff both.lcm both.lcm --run-b 4711         two runs of one log");
  verb->callback([&action, arguments] { action = [arguments] { return RunDiff(*arguments); }; });
}

}  // namespace fogline
