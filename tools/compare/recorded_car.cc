#include "tools/compare/recorded_car.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "common/csv_series.h"
#include "common/errors.h"
#include "common/file.h"
#include "common/parse_number.h"
#include "common/text.h"
#include "scenario/io/json.h"

namespace fogline::compare {
namespace {

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
/// @throws InputError that names the first value outside of this range
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

}  // namespace

RecordedCar ReadRecordedCar(const std::filesystem::path& file, const RecordedColumns& car,
                            const RecordedSection& leader) {
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
  std::vector<std::size_t> columns{column(leader.time_column), column(car.speed), column(car.gap)};
  const bool has_leader = std::ranges::find(header, leader.speed_column) != header.end();
  if (has_leader) columns.push_back(column(leader.speed_column));
  auto numbers =
      ReadCsvColumns(csv.text, columns, [&](std::uint32_t offset, const std::string& why) {
        RefuseCell(file, csv.text, offset, why);
      });
  if (!has_leader) numbers.emplace_back();
  RequireBetween(-kFastest_mps, kFastest_mps, car.speed, numbers[1], file, csv.text);
  RequireBetween(0, kFarthest_m, car.gap, numbers[2], file, csv.text);
  return {std::move(numbers[0]), std::move(numbers[1]), std::move(numbers[2]),
          std::move(numbers[3])};
}

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

void CheckLeader(const RecordedCar& car, const RecordedSection& leader,
                 std::span<const metrics::Sample> run, const std::filesystem::path& file) {
  if (car.leader_mps.empty()) return;
  CsvSeries recorded_mps(car.times_s, car.leader_mps);
  for (const metrics::Sample& sample : run) {
    const double time_s = leader.start_s + sample.time_s;
    const double there_mps = recorded_mps.At(time_s);
    if (std::abs(there_mps - sample.preceding_speed_mps) <= kSameLeader_mps) continue;
    Refuse(file, fmt::format("its leader is not that of the run: {} is {:.2f} m/s at {:.1f} s, but "
                             "the run's leader drives {:.2f} m/s",
                             leader.speed_column, there_mps, time_s, sample.preceding_speed_mps));
  }
}

}  // namespace fogline::compare
