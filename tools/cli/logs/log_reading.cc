#include "tools/cli/logs/log_reading.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/errors.h"
#include "common/process/console.h"
#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/runtime/process/program_options.h"

namespace fogline::cli {

void AddRunOption(CLI::App& verb, std::optional<std::int64_t>& run_id) {
  runtime::AddRunIdOption(verb, "--run", run_id,
                          "Id of the run to read (default: the first run in the log)");
}

LogReading::LogReading(CLI::App& verb) {
  AddRunOption(verb, run_id_);
  verb.add_option("--scenario", scenario_,
                  "Effective scenario of a log that lacks it (fogline check --print); checked by "
                  "its hash if the log has the hash");
}

log::ReadOptions LogReading::Options() const {
  log::ReadOptions options{.gaps = true, .run_id = run_id_};
  if (!scenario_.empty()) options.scenario_text = PrintScenario(LoadScenario(scenario_));
  return options;
}

void RefuseLog(const std::filesystem::path& log, const std::string& why) {
  throw InputError(fmt::format("{}: error: {}", PathText(log), why));
}

void SayAboutLog(const std::filesystem::path& log, const log::RunLog& run) {
  if (!run.note.empty()) Complain(fmt::format("{}: {}", PathText(log), run.note));
  if (run.other_runs.empty()) return;
  std::string others;
  for (const log::RunInLog& other : run.other_runs) {
    others += fmt::format("{}{} ({} message{})", others.empty() ? "" : ", ", other.run_id,
                          other.messages, other.messages == 1 ? "" : "s");
  }
  Complain(fmt::format("{}: this is run {}; the log also has run {}; --run chooses", PathText(log),
                       run.run_id, others));
}

nlohmann::ordered_json GapsJson(const log::LogGaps& gaps) {
  nlohmann::ordered_json json{{"first_step", gaps.first},
                              {"steps", gaps.steps},
                              {"messages", nlohmann::ordered_json::object()},
                              {"gaps", nlohmann::ordered_json::array()},
                              {"gaps_left_out", gaps.left_out}};
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    if (gaps.messages[i] > 0) json["messages"][std::string(kChannels[i].name)] = gaps.messages[i];
  }
  for (const log::Gap& gap : gaps.gaps) {
    auto channels = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      if (gap.channels[i]) channels.push_back(kChannels[i].name);
    }
    json["gaps"].push_back(
        {{"first_step", gap.first}, {"last_step", gap.last}, {"channels", channels}});
  }
  return json;
}

nlohmann::ordered_json DigestJson(const log::RunLog& run) {
  if (run.digest.empty()) return nullptr;
  return run.digest;
}

std::vector<std::string> UnknownMeasures(const runner::RunResult& result) {
  std::vector<std::string> names;
  metrics::VisitMetrics(result.measures, [&](std::string_view name, const auto& value,
                                             std::string_view, std::string_view) {
    if (!metrics::IsKnown(name, value, result.lack)) names.emplace_back(name);
  });
  return names;
}

std::string UnknownMeasuresText(const runner::RunResult& result) {
  if (result.lack.every[IndexOf<truth_t>()]) return "all measures";
  return fmt::format("{}", fmt::join(UnknownMeasures(result), ", "));
}

std::string UnknownTakeOvers(const runner::LoggedRun& run) {
  if (run.scenario.arbitrator.take_over.mode != TakeOverMode::kRequested) return "";
  const metrics::Lack& lack = run.result.lack;
  if (lack.channels[IndexOf<arbitration_t>()] || lack.every[IndexOf<arbitration_t>()]) {
    return "requests in a gap and the measures of take-overs";
  }
  if (!metrics::AreTakeOversKnown(lack)) return "the measures of take-overs";
  std::vector<std::string> unknown;
  if (lack.beginning_of_request) {
    unknown.emplace_back("the measures of a request that may have begun before the log");
  } else if (lack.beginning) {
    unknown.emplace_back("requests before the beginning of the log");
  }
  if (lack.end) unknown.emplace_back("requests after the end of the log");
  return fmt::format("{}", fmt::join(unknown, ", "));
}

void SayWhatIsUnknown(const runner::LoggedRun& run, const std::string& of_pair) {
  if (run.steps == 0 && !run.gaps.Any()) return;  // SayAboutLog() says that no step is complete
  const bool has_truth = !run.result.lack.every[IndexOf<truth_t>()];
  std::string unknown = UnknownMeasuresText(run.result);
  for (const std::string& other : {of_pair, UnknownTakeOvers(run)}) {
    if (has_truth && !other.empty()) unknown += (unknown.empty() ? "" : ", ") + other;
  }
  if (unknown.empty() && !run.ended) {
    Complain(fmt::format("{}: the measures are of the steps in the log", PathText(run.result.log)));
  }
  if (unknown.empty()) return;
  const std::string others = has_truth ? "; the other measures are of the steps in the log" : "";
  Complain(fmt::format("{}: unknown, because messages are missing: {}{}", PathText(run.result.log),
                       unknown, others));
}

}  // namespace fogline::cli
