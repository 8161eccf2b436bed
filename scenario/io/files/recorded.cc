#include "scenario/io/files/recorded.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "common/csv.h"
#include "common/csv_series.h"
#include "common/file.h"
#include "common/text.h"
#include "scenario/sections/field_text.h"
#include "scenario/sections/field_view.h"

namespace fogline {
namespace {

constexpr std::string_view kFile = "/lead/recorded/file";
constexpr std::string_view kTimeColumn = "/lead/recorded/time_column";
constexpr std::string_view kSpeedColumn = "/lead/recorded/speed_column";
constexpr std::string_view kStart = "/lead/recorded/start_s";

// The range that the scenario allows for a recorded speed.
NumberSpec SpeedRange() {
  Scenario scenario;
  return FieldAt(scenario, "/lead/recorded/speeds_mps")->As<NumbersField>()->spec;
}

// Speed and time of each row.
struct Recording {
  std::vector<CsvNumber> times_s;
  std::vector<CsvNumber> speeds_mps;
};

// Reads a recording in several stages. Each stage notes the mistakes that it finds in the
// recording. The next stage runs only if there are no mistakes so far.
class RecordingReader {
 public:
  RecordingReader(const Scenario& scenario, const JsonValue& root, std::string csv_name,
                  std::uint32_t csv_source, DiagnosticList& mistakes)
      : scenario_(scenario),
        recorded_(scenario.lead.recorded),
        root_(root),
        csv_name_(std::move(csv_name)),
        csv_source_(csv_source),
        mistakes_(mistakes) {}

  std::optional<Recording> Read(const FileText& csv) {
    if (!csv.error.empty()) {
      AddInScenario(kFile, "csv-file", fmt::format("{} {}", Shown(csv_name_), csv.error));
      return std::nullopt;
    }
    const std::vector<std::string_view> header = CsvHeader(csv.text);
    if (const std::string_view separator = ForeignSeparator(header); !separator.empty()) {
      AddInScenario(kFile, "csv-separator",
                    fmt::format("{} seems to be separated by {}, but ',' is expected",
                                Shown(csv_name_), separator));
      return std::nullopt;
    }
    const std::size_t time = FindColumn(header, recorded_.time_column, kTimeColumn);
    const std::size_t speed = FindColumn(header, recorded_.speed_column, kSpeedColumn);
    if (!mistakes_.empty()) return std::nullopt;
    auto columns =
        ReadCsvColumns(csv.text, {time, speed}, [this](std::uint32_t offset, std::string message) {
          AddInCsv(offset, "csv-cell", std::move(message));
        });
    if (!mistakes_.empty()) return std::nullopt;
    Recording recording{.times_s = std::move(columns[0]), .speeds_mps = std::move(columns[1])};
    CheckRows(recording);
    if (mistakes_.empty()) CheckSpan(recording);
    if (!mistakes_.empty()) return std::nullopt;
    return recording;
  }

 private:
  void AddInScenario(std::string_view pointer, std::string_view rule, std::string message) {
    mistakes_.Add(FindPlace(root_, pointer), std::string(pointer), rule, std::move(message));
  }
  void AddInCsv(std::uint32_t offset, std::string_view rule, std::string message) {
    mistakes_.Add({.source = csv_source_, .offset = offset}, std::string(kFile), rule,
                  std::move(message));
  }

  std::size_t FindColumn(const std::vector<std::string_view>& header, std::string_view name,
                         std::string_view pointer) {
    const auto it = std::find(header.begin(), header.end(), name);
    if (it == header.end()) {
      AddInScenario(
          pointer, "csv-column",
          fmt::format("{} has no column {}; it has {}{}", Shown(csv_name_), QuoteShort(name),
                      header.empty() ? "no header line" : Shown(Names(header)),
                      DidYouMean(Nearest(name, header))));
    } else if (std::count(header.begin(), header.end(), name) > 1) {
      AddInScenario(
          pointer, "csv-column",
          fmt::format("{} has more than one column {}", Shown(csv_name_), QuoteShort(name)));
    }
    return static_cast<std::size_t>(it - header.begin());
  }

  void CheckRows(const Recording& recording) {
    const NumberSpec range = SpeedRange();
    for (std::size_t i = 0; i < recording.times_s.size(); ++i) {
      const CsvNumber& speed = recording.speeds_mps[i];
      if (speed.value < range.min || speed.value > range.max) {
        AddInCsv(speed.offset, "csv-speed",
                 fmt::format("{} is outside {}", NumberText(speed.value), Range(range)));
      }
      if (i == 0) continue;
      const double before_s = recording.times_s[i - 1].value;
      const CsvNumber& time = recording.times_s[i];
      if (time.value <= before_s) {
        AddInCsv(time.offset, "csv-time",
                 fmt::format("time {} s does not come after {} s, the time of the row above",
                             NumberText(time.value), NumberText(before_s)));
      }
    }
  }

  void CheckSpan(const Recording& recording) {
    if (recording.times_s.empty()) {
      return AddInScenario(kFile, "csv-span", Shown(csv_name_) + " has no rows");
    }
    const double first_s = recording.times_s.front().value;
    const double last_s = recording.times_s.back().value;
    const double begin_s = recorded_.start_s;
    const double end_s = begin_s + static_cast<double>(scenario_.steps - 1) * scenario_.step_s;
    if (begin_s >= first_s - CsvSeries::kSameTime_s && end_s <= last_s + CsvSeries::kSameTime_s)
      return;
    AddInScenario(
        kStart, "csv-span",
        fmt::format("{} steps of {} s from here need {} s to {} s, but {} has {} s to {} s",
                    scenario_.steps, NumberText(scenario_.step_s), TimeText(begin_s),
                    TimeText(end_s), Shown(csv_name_), TimeText(first_s), TimeText(last_s)));
  }

  const Scenario& scenario_;
  const RecordedSection& recorded_;
  const JsonValue& root_;
  std::string csv_name_;
  std::uint32_t csv_source_;
  DiagnosticList& mistakes_;
};

}  // namespace

void ResolveRecorded(const std::filesystem::path& folder, const JsonValue& root,
                     std::vector<Source> sources, Scenario& scenario) {
  DiagnosticList mistakes;
  if (scenario.steps > kMaxRecordedSpeeds) {
    mistakes.Add(FindPlace(root, "/steps"), "/steps", "csv-span",
                 fmt::format("{} steps; a recorded leader has at most {}", scenario.steps,
                             kMaxRecordedSpeeds));
    mistakes.Throw(sources);
  }
  const std::filesystem::path file = folder / scenario.lead.recorded.file;
  const FileText csv = ReadFile(file, kMaxFileBytes, ".csv");
  sources.push_back({.name = file.string(), .text = csv.text});
  RecordingReader reader(scenario, root, file.string(),
                         static_cast<std::uint32_t>(sources.size() - 1), mistakes);
  const std::optional<Recording> recording = reader.Read(csv);
  if (!recording) mistakes.Throw(sources);
  CsvSeries speed_mps(recording->times_s, recording->speeds_mps);
  std::vector<double>& speeds_mps = scenario.lead.recorded.speeds_mps;
  speeds_mps.clear();
  for (std::int64_t step = 0; step < scenario.steps; ++step) {
    const double time_s =
        scenario.lead.recorded.start_s + static_cast<double>(step) * scenario.step_s;
    speeds_mps.push_back(speed_mps.At(time_s));
  }
}

}  // namespace fogline
