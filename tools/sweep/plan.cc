#include "tools/sweep/plan.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "scenario/io/loader.h"

namespace fogline::sweep {
namespace {

/// Largest number of points of an axis "first:last:count".
constexpr std::int64_t kMaxPoints = 1'000'000;

/// Largest number of rows of a sweep. With more rows, a sweep on one core would take more than a
/// year. The limit also prevents an overflow in ShardEnd(), which multiplies the number of units by
/// the index of a shard. There are at most as many units as rows, and at most kMaxShards shards. So
/// the product is at most 1e17, and a 64-bit integer can hold 9e18.
constexpr std::int64_t kMaxRows = 100'000'000'000;

/// Largest number of shards of a sweep.
constexpr std::int64_t kMaxShards = 1'000'000;

template <class T>
bool Parse(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::vector<std::string_view> Split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// The seeds of "A:B" or "A"; nullopt if the text has another form.
std::optional<SeedRange> SeedsOf(std::string_view text) {
  const std::vector<std::string_view> parts = Split(text, ':');
  SeedRange seeds;
  const bool fits = parts.size() <= 2 && Parse(parts.front(), seeds.first) &&
                    Parse(parts.back(), seeds.last) && seeds.first >= 0 &&
                    seeds.last >= seeds.first && seeds.last <= kMaxSeed;
  return fits ? std::optional(seeds) : std::nullopt;
}

/// A hint for the error message about seeds that are written "A..B" or "A-B", such as "; did you
/// mean 1:20?"; "" for other texts.
std::string SeedsHint(const std::string& text) {
  for (const std::string_view separator : {"..", "-"}) {
    const std::size_t at = text.find(separator);
    if (at == std::string::npos) continue;
    const std::string seeds = text.substr(0, at) + ":" + text.substr(at + separator.size());
    if (SeedsOf(seeds)) return fmt::format("; did you mean {}?", seeds);
  }
  return "";
}

/// The text without spaces at its ends.
std::string_view Trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// The values of "first:last:count"; empty if the text has another form. Values are printed with
/// fifteen significant digits, so 0.3 is printed as 0.3 and not as 0.30000000000000004.
std::vector<std::string> Spaced(std::string_view text) {
  std::vector<std::string_view> parts = Split(text, ':');
  for (std::string_view& part : parts) part = Trim(part);
  double first = 0;
  double last = 0;
  std::int64_t count = 0;
  if (parts.size() != 3 || !Parse(parts[0], first) || !Parse(parts[1], last) ||
      !std::isfinite(first) || !std::isfinite(last) || !Parse(parts[2], count) || count < 2 ||
      count > kMaxPoints) {
    return {};
  }
  std::vector<std::string> values;
  for (std::int64_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    values.push_back(i == count - 1 ? fmt::format("{}", last)
                                    : fmt::format("{:.15g}", first + (last - first) * share));
  }
  return values;
}

/// Refuses values that are equal. Two texts of the same number count as equal values, such as 0.5
/// and 0.50, or 0 and -0.
/// @throws InputError
void RefuseEqual(const std::string& argument, const std::vector<std::string>& values) {
  std::set<std::string> known;
  for (const std::string& value : values) {
    double number = 0;
    const std::string plain =
        Parse(std::string_view(value), number) ? fmt::format("{}", number + 0.0) : value;
    if (!known.insert(plain).second) {
      throw InputError(fmt::format("error: {}: {} comes twice", argument, plain));
    }
  }
}

/// Checks a value of a field by the rules of scenario files. `argument` names the source of the
/// value in messages.
/// @throws InputError
void CheckSetting(const std::string& argument, const std::string& base, const std::string& pointer,
                  const std::string& value) {
  try {
    ParseScenario(base, "scenario", {fmt::format("{}={}", pointer, value)});
  } catch (const ScenarioError& error) {
    const Diagnostic& diagnostic = error.diagnostics().front();
    throw InputError(fmt::format("error: {}: {}{}", argument,
                                 diagnostic.pointer == pointer ? "" : diagnostic.pointer + ": ",
                                 diagnostic.message));
  }
}

}  // namespace

std::vector<std::string> ParseValues(const std::string& argument, std::string_view values) {
  if (values.find(':') != std::string_view::npos) {
    std::vector<std::string> spaced = Spaced(values);
    if (spaced.empty()) {
      throw InputError(
          fmt::format("error: {}: not first:last:count with two finite numbers and a count from 2 "
                      "to {}",
                      argument, kMaxPoints));
    }
    RefuseEqual(argument, spaced);
    return spaced;
  }
  std::vector<std::string> list;
  for (const std::string_view part : Split(values, ',')) {
    const std::string_view value = Trim(part);
    if (value.empty()) throw InputError(fmt::format("error: {}: an empty value", argument));
    list.emplace_back(value);
  }
  RefuseEqual(argument, list);
  return list;
}

Axis ParseAxis(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || !text.starts_with('/')) {
    throw InputError(fmt::format(
        "error: --grid {}: neither /pointer=a,b,c nor /pointer=first:last:count", text));
  }
  const std::string_view values = std::string_view(text).substr(equals + 1);
  return {.pointer = text.substr(0, equals),
          .values = ParseValues(fmt::format("--grid {}", text), values)};
}

std::vector<double> ParseThresholds(const std::string& text) {
  const std::string argument = "--thresholds " + text;
  std::vector<double> thresholds;
  for (const std::string& value : ParseValues(argument, text)) {
    double threshold = 0;
    if (!Parse(std::string_view(value), threshold) || !(threshold >= 0 && threshold <= 1)) {
      throw InputError(fmt::format("error: {}: {} is no number from 0 to 1", argument, value));
    }
    thresholds.push_back(threshold);
  }
  return thresholds;
}

SeedRange ParseSeeds(const std::string& text) {
  if (const auto seeds = SeedsOf(text)) return *seeds;
  throw InputError(
      fmt::format("error: --seeds {}: neither A:B with 0 <= A <= B <= {} nor one seed{}", text,
                  kMaxSeed, SeedsHint(text)));
}

Shard ParseShard(const std::string& text) {
  const std::vector<std::string_view> parts = Split(text, '/');
  Shard shard;
  if (parts.size() != 2 || !Parse(parts[0], shard.index) || !Parse(parts[1], shard.count) ||
      shard.index < 1 || shard.index > shard.count || shard.count > kMaxShards) {
    throw InputError(
        fmt::format("error: --shard {}: not I/N with 1 <= I <= N <= {}", text, kMaxShards));
  }
  return shard;
}

SweepPlan::SweepPlan(Scenario base, std::vector<Axis> axes, SeedRange seeds, std::string file)
    : base_(std::move(base)), file_(std::move(file)), axes_(std::move(axes)), seeds_(seeds) {
  const std::string text = PrintScenario(base_);
  CheckSetting(fmt::format("--seeds {}", seeds_.last), text, "/seed",
               fmt::format("{}", seeds_.last));
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (axes_[j].pointer == axes_[i].pointer) {
        throw InputError(fmt::format("error: --grid {}: given twice", axes_[i].pointer));
      }
    }
    AddAxis(text, axes_[i]);
  }
  std::int64_t left = kMaxRows;
  for (const Axis& axis : axes_) left /= static_cast<std::int64_t>(axis.values.size());
  if (left == 0) throw InputError(fmt::format("error: --grid: more than {} rows", kMaxRows));
  if (left < seeds_.count()) {
    throw InputError(fmt::format("error: --seeds {}:{}: more than {} rows in all", seeds_.first,
                                 seeds_.last, kMaxRows));
  }
  // The axes of the arbitrator and the other axes form two separate grids. stride_ is the number of
  // points of the grid from one value of an axis to its next value. The last axis of a grid varies
  // fastest.
  stride_.resize(axes_.size());
  for (std::size_t i = axes_.size(); i-- > 0;) {
    std::int64_t& points = inner_[i] ? inner_points_ : outer_points_;
    stride_[i] = points;
    points *= static_cast<std::int64_t>(axes_[i].values.size());
  }
}

bool IsOfRecording(const Scenario& scenario, std::string_view pointer) {
  return scenario.lead.profile == LeadProfile::kRecorded && !scenario.lead.recorded.file.empty() &&
         (pointer == "/step_s" || pointer.starts_with("/lead/recorded/"));
}

void SweepPlan::AddAxis(const std::string& base, const Axis& axis) {
  const auto refuse = [&axis](std::string_view why) {
    throw InputError(fmt::format("error: --grid {}: {}", axis.pointer, why));
  };
  if (axis.pointer == "/seed") refuse("seeds are given by --seeds");
  if (axis.pointer == "/steps") refuse("runs of one sweep are equally long");
  if (IsOfRecording(base_, axis.pointer)) refuse(kRecordingIsReadOnce);
  fields_.emplace_back(axis.pointer);
  inner_.push_back(axis.pointer.starts_with("/arbitrator/"));
  Scenario scratch = base_;
  for (const std::string& value : axis.values) {
    CheckSetting(fmt::format("--grid {}={}", axis.pointer, value), base, axis.pointer, value);
    fields_.back().Set(scratch, value);
  }
}

std::size_t SweepPlan::ValueIndex(std::size_t axis, std::int64_t unit, std::int64_t row) const {
  const std::int64_t point = inner_[axis] ? row : unit / seeds_.count();
  return static_cast<std::size_t>(point / stride_[axis]) % axes_[axis].values.size();
}

void SweepPlan::Configure(std::int64_t unit, std::int64_t row, Scenario& scenario) const {
  scenario.seed = SeedOf(unit);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    fields_[i].Set(scenario, axes_[i].values[ValueIndex(i, unit, row)]);
  }
}

std::vector<std::string_view> SweepPlan::ValuesOf(std::int64_t unit, std::int64_t row) const {
  std::vector<std::string_view> values;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    values.push_back(axes_[i].values[ValueIndex(i, unit, row)]);
  }
  return values;
}

std::string SweepPlan::NameOf(std::int64_t unit, std::int64_t row) const {
  const std::vector<std::string_view> values = ValuesOf(unit, row);
  std::string name;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    name += fmt::format("{}={}, ", axes_[i].pointer, values[i]);
  }
  return fmt::format("{}seed {}", name, SeedOf(unit));
}

}  // namespace fogline::sweep
