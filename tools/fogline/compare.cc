// fogline compare: compares the host of a run with a real car that was recorded behind the same
// leader.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <ostream>
#include <sstream>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/csv.h"
#include "common/csv_series.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/parse_number.h"
#include "common/process/console.h"
#include "common/text.h"
#include "scenario/io/json.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct CompareArguments {
  std::filesystem::path log;
  std::filesystem::path recording;
  std::string speed_column = "Speed2";
  std::string gap_column = "IVS1";
  std::filesystem::path out;
  bool json = false;
};

/// Recorded data of the real car, and of its leader if the file has data of the leader.
struct Recording {
  std::vector<CsvNumber> times_s;
  std::vector<CsvNumber> speeds_mps;
  std::vector<CsvNumber> gaps_m;
  std::vector<CsvNumber> leader_mps;
};

// Limits for a car on a road. A value beyond these limits belongs to another quantity or unit, or
// marks a missing value.
constexpr double kFastest_mps = 150;
constexpr double kFarthest_m = 10'000;
// The run's leader counts as the recorded leader if their speeds differ by at most this value at
// all times.
constexpr double kSameLeader_mps = 0.5;

[[noreturn]] void Refuse(const std::filesystem::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: error: {}", PathText(file), why));
}

std::size_t FindColumn(const std::vector<std::string_view>& header, const std::string& name,
                       const std::filesystem::path& file) {
  const auto it = std::ranges::find(header, name);
  if (it == header.end()) {
    Refuse(file, fmt::format("no column {}; it has {}{}", QuoteShort(name), Shown(Names(header)),
                             DidYouMean(Nearest(name, header))));
  }
  return static_cast<std::size_t>(it - header.begin());
}

[[noreturn]] void RefuseCell(const std::filesystem::path& file, const std::string& text,
                             std::uint32_t offset, const std::string& why) {
  const auto line = 1 + std::count(text.begin(), text.begin() + offset, '\n');
  throw InputError(fmt::format("{}:{}: error: {}", PathText(file), line, why));
}

/// Checks that all values of a column are in [least, most].
/// @throws InputError that names the first other value
void RequireBetween(double least, double most, const std::string& column,
                    const std::vector<CsvNumber>& numbers, const std::filesystem::path& file,
                    const std::string& text) {
  for (const CsvNumber& number : numbers) {
    if (number.value >= least && number.value <= most) continue;
    RefuseCell(
        file, text, number.offset,
        fmt::format("{} is {:g}, not between {:g} and {:g}", column, number.value, least, most));
  }
}

Recording ReadRecording(const CompareArguments& arguments, const RecordedSection& leader) {
  const std::filesystem::path& file = arguments.recording;
  const FileText csv = ReadFile(file, kMaxFileBytes, ".csv");
  if (!csv.error.empty()) Refuse(file, csv.error);
  const std::vector<std::string_view> header = CsvHeader(csv.text);
  if (header.empty()) {
    Refuse(file, csv.text.empty() ? "the file is empty; it needs a header line that names columns"
                                  : "the first line is empty; it must name the columns");
  }
  if (std::ranges::all_of(
          header, [](std::string_view cell) { return ParseNumber<double>(cell).has_value(); })) {
    Refuse(file,
           fmt::format("the first line is {}; it must name the columns", Shown(Names(header))));
  }
  if (const std::string_view separator = ForeignSeparator(header); !separator.empty()) {
    Refuse(file, fmt::format("seems to be separated by {}, but ',' is expected", separator));
  }
  const auto column = [&](const std::string& name) { return FindColumn(header, name, file); };
  std::vector<std::size_t> columns{column(leader.time_column), column(arguments.speed_column),
                                   column(arguments.gap_column)};
  const bool has_leader = std::ranges::find(header, leader.speed_column) != header.end();
  if (has_leader) columns.push_back(column(leader.speed_column));
  auto numbers =
      ReadCsvColumns(csv.text, columns, [&](std::uint32_t offset, const std::string& why) {
        RefuseCell(file, csv.text, offset, why);
      });
  if (!has_leader) numbers.emplace_back();
  RequireBetween(-kFastest_mps, kFastest_mps, arguments.speed_column, numbers[1], file, csv.text);
  RequireBetween(0, kFarthest_m, arguments.gap_column, numbers[2], file, csv.text);
  return {std::move(numbers[0]), std::move(numbers[1]), std::move(numbers[2]),
          std::move(numbers[3])};
}

/// @throws InputError if the recording's times do not ascend, or do not cover the times of the run
void CheckTimes(const std::vector<CsvNumber>& times_s, double begin_s, double end_s,
                const std::filesystem::path& file) {
  if (times_s.empty()) Refuse(file, "no rows");
  const auto descent = std::ranges::adjacent_find(
      times_s, [](const CsvNumber& a, const CsvNumber& b) { return b.value <= a.value; });
  if (descent != times_s.end()) {
    Refuse(file, fmt::format("time {} s is followed by {} s", NumberText(descent->value),
                             NumberText(descent[1].value)));
  }
  if (begin_s >= times_s.front().value - CsvSeries::kSameTime_s &&
      end_s <= times_s.back().value + CsvSeries::kSameTime_s) {
    return;
  }
  Refuse(file, fmt::format("has {} s to {} s, but the run is from {} s to {} s",
                           TimeText(times_s.front().value), TimeText(times_s.back().value),
                           TimeText(begin_s), TimeText(end_s)));
}

/// @throws InputError if the leader of the recording is not the leader of the run
void CheckLeader(const runner::LoggedRun& run, const Recording& recording,
                 const std::filesystem::path& file) {
  if (recording.leader_mps.empty()) return;
  const RecordedSection& leader = run.scenario.lead.recorded;
  CsvSeries recorded_mps(recording.times_s, recording.leader_mps);
  for (const metrics::Sample& sample : run.result.samples) {
    const double time_s = leader.start_s + sample.time_s;
    const double there_mps = recorded_mps.At(time_s);
    if (std::abs(there_mps - sample.preceding_speed_mps) <= kSameLeader_mps) continue;
    Refuse(file, fmt::format("its leader is not that of the run: {} is {:.2f} m/s at {:.1f} s, but "
                             "the run's leader drives {:.2f} m/s",
                             leader.speed_column, there_mps, time_s, sample.preceding_speed_mps));
  }
}

/// Differences of one quantity between the run and the recording, over all steps.
class Differences {
 public:
  void Add(double ours, double recorded) {
    const double difference = ours - recorded;
    ++steps_;
    ours_ += ours;
    recorded_ += recorded;
    squares_ += difference * difference;
    largest_ = std::max(largest_, std::abs(difference));
  }
  std::int64_t steps() const { return steps_; }
  double mean() const { return ours_ / Count(); }
  double recorded_mean() const { return recorded_ / Count(); }
  double rmse() const { return std::sqrt(squares_ / Count()); }
  /// Standard deviation of the differences. It leaves out the mean difference, which depends on the
  /// chosen time gap.
  double spread() const {
    const double bias = mean() - recorded_mean();
    return std::sqrt(std::max(0.0, squares_ / Count() - bias * bias));
  }
  double largest() const { return largest_; }

 private:
  double Count() const { return static_cast<double>(steps_); }

  std::int64_t steps_ = 0;
  double ours_ = 0;
  double recorded_ = 0;
  double squares_ = 0;
  double largest_ = 0;
};

struct Comparison {
  Differences speed_mps;
  Differences gap_m;
};

/// @param out stream for the values of each step, as CSV; nullptr: no such output
Comparison Compare(const runner::LoggedRun& run, const Recording& recording, std::ostream* out) {
  const double start_s = run.scenario.lead.recorded.start_s;
  CsvSeries speed_mps(recording.times_s, recording.speeds_mps);
  CsvSeries gap_m(recording.times_s, recording.gaps_m);
  Comparison comparison;
  if (out != nullptr) *out << "time_s,speed_mps,recorded_speed_mps,gap_m,recorded_gap_m\n";
  for (const metrics::Sample& sample : run.result.samples) {
    const double recorded_mps = speed_mps.At(start_s + sample.time_s);
    const double recorded_m = gap_m.At(start_s + sample.time_s);
    comparison.speed_mps.Add(sample.host_speed_mps, recorded_mps);
    comparison.gap_m.Add(sample.host_gap_m, recorded_m);
    if (out != nullptr) {
      *out << fmt::format("{},{},{},{},{}\n", sample.time_s, sample.host_speed_mps, recorded_mps,
                          sample.host_gap_m, recorded_m);
    }
  }
  return comparison;
}

std::string ToText(const CompareArguments& arguments, const Comparison& comparison) {
  std::string text = fmt::format("{} beside {}, {} steps\n", PathText(arguments.log),
                                 PathText(arguments.recording), comparison.speed_mps.steps());
  text += fmt::format("  {:<12}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "", "mean", "recorded", "RMSE",
                      "spread", "largest");
  const auto line = [](const char* name, const Differences& d) {
    return fmt::format("  {:<12}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}\n", name, d.mean(),
                       d.recorded_mean(), d.rmse(), d.spread(), d.largest());
  };
  return text + line("speed [m/s]", comparison.speed_mps) + line("gap [m]", comparison.gap_m);
}

nlohmann::ordered_json ToJson(const CompareArguments& arguments, const Comparison& comparison) {
  const Differences& speed = comparison.speed_mps;
  const Differences& gap = comparison.gap_m;
  return {{"log", arguments.log.string()},
          {"recording", arguments.recording.string()},
          {"steps", speed.steps()},
          {"speed_rmse_mps", speed.rmse()},
          {"gap_rmse_m", gap.rmse()},
          {"speed_spread_mps", speed.spread()},
          {"gap_spread_m", gap.spread()},
          {"largest_speed_difference_mps", speed.largest()},
          {"largest_gap_difference_m", gap.largest()},
          {"mean_speed_mps", speed.mean()},
          {"recorded_mean_speed_mps", speed.recorded_mean()},
          {"mean_gap_m", gap.mean()},
          {"recorded_mean_gap_m", gap.recorded_mean()}};
}

int RunCompare(const CompareArguments& arguments) {
  cli::RefuseJsonBeside(arguments.out, "--out", arguments.json);
  const runner::LoggedRun run = runner::ReadLoggedRun(arguments.log);
  if (run.result.samples.empty()) Refuse(arguments.log, "no steps");
  if (run.scenario.lead.profile != LeadProfile::kRecorded) {
    Refuse(arguments.log, "/lead/profile: the leader of this run is not a recorded one");
  }
  const RecordedSection& recorded = run.scenario.lead.recorded;
  const Recording recording = ReadRecording(arguments, recorded);
  CheckTimes(recording.times_s, recorded.start_s + run.result.samples.front().time_s,
             recorded.start_s + run.result.samples.back().time_s, arguments.recording);
  CheckLeader(run, recording, arguments.recording);
  const bool has_out = !arguments.out.empty();
  if (has_out) {
    if (IsReplaceable(arguments.out) && std::filesystem::exists(arguments.out)) {
      Refuse(arguments.out, "--out: the file exists and is not replaced");
    }
    RequireWritable(arguments.out, "--out");
  }
  std::ostringstream out;
  const Comparison comparison = Compare(run, recording, has_out ? &out : nullptr);
  if (has_out) {
    WatchInterrupts();  // after this call, an interrupt leaves no partial file
    AtomicFile file(arguments.out);
    file.Write(out.str());
    file.Finish();
  }
  if (!run.note.empty()) Complain(fmt::format("{}: {}", PathText(arguments.log), run.note));
  if (arguments.json) {
    cli::PrintJson(ToJson(arguments, comparison));
  } else {
    cli::PrintBeside(arguments.out, ToText(arguments, comparison));
  }
  return run.complete ? kDone : kCheckFailed;
}

}  // namespace

void AddCompare(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand(
      "compare", "Compare a run's host with a recorded car behind the same leader");
  const auto arguments = std::make_shared<CompareArguments>();
  verb->add_option("LOG", arguments->log, "Event log of a run behind the recorded leader")
      ->required();
  verb->add_option("RECORDING", arguments->recording,
                   "CSV file with a header line. The scenario's /lead/recorded names its time "
                   "column and the run's start")
      ->required();
  verb->add_option("--speed-column", arguments->speed_column, "Speed of the real car, m/s")
      ->capture_default_str();
  verb->add_option("--gap-column", arguments->gap_column,
                   "Gap of the real car to the leader, bumper to bumper, m")
      ->capture_default_str();
  verb->add_option("--out", arguments->out,
                   "Write run and recording, step by step, into this CSV file");
  verb->add_flag("--json", arguments->json, "Print as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "the log is not complete"});
  verb->footer(
      "RMSE: root mean square of the difference, run minus recording. spread: the same without\n"
      "the mean difference, which depends on the time gap. largest: the largest difference.\n\n"
      "Examples:\n"
      "  fogline run scenario/recorded_lead.json\n"
      "  fogline compare logs/recorded_lead-1.lcm scenario/data/acc_platoon_a.csv");
  verb->callback([&action, arguments] { action = [arguments] { return RunCompare(*arguments); }; });
}

}  // namespace fogline
