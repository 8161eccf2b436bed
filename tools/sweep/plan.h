// The rows of a sweep: a grid over fields of a scenario and a range of seeds, in a defined order.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/io/assignment.h"
#include "scenario/sections/scenario.h"

namespace fogline::sweep {

/// One field, and the values that the sweep gives it. Values are written as in a scenario file.
struct Axis {
  std::string pointer;
  std::vector<std::string> values;
};

/// Reads values as a person writes them: "a,b,c", or "first:last:count" for evenly spaced numbers.
/// No value may come twice. Spaces around a value do not count.
/// @param argument the beginning of an error message, such as "--thresholds 1:2"
/// @throws InputError
std::vector<std::string> ParseValues(const std::string& argument, std::string_view values);

/// Reads an axis "/pointer=a,b,c", or "/pointer=first:last:count" for evenly spaced numbers.
/// @throws InputError
Axis ParseAxis(const std::string& text);

/// Reads thresholds of the Degree of Conflict, written as the values of an axis, each in [0, 1].
/// @throws InputError
std::vector<double> ParseThresholds(const std::string& text);

/// Largest seed of a scenario, and largest value of every other seed that a user chooses.
inline constexpr std::int64_t kMaxSeed = 9'007'199'254'740'991;

/// First and last seed of "A:B", or of "A".
struct SeedRange {
  std::int64_t first = 1;
  std::int64_t last = 1;
  std::int64_t count() const { return last - first + 1; }
};
/// Reads seeds "A:B" or "A". @throws InputError
SeedRange ParseSeeds(const std::string& text);

/// Whether the speeds of a recorded leader depend on this field. They are read once, together with
/// the scenario. So such a field must be the same in all runs.
bool IsOfRecording(const Scenario& scenario, std::string_view pointer);
inline constexpr std::string_view kRecordingIsReadOnce =
    "the recording of the leader is read once, before the runs";

/// Part `index` of a sweep that is divided into `count` parts; `index` counts from 1. The parts
/// have equal numbers of units (SweepPlan), or numbers that differ by 1.
struct Shard {
  std::int64_t index = 1;
  std::int64_t count = 1;
  bool operator==(const Shard&) const = default;
};
/// Reads a shard "I/N". @throws InputError
Shard ParseShard(const std::string& text);

/// The rows of a sweep. Each row is paired with a run without traded control. Axes of the
/// arbitrator do not change this run. So rows that differ only in these axes share one paired run.
/// These rows follow each other and form one unit of work. Rows are ordered by the other axes (in
/// the given order), then by seed, then by the arbitrator's axes.
class SweepPlan {
 public:
  /// @param file source of the scenario, for messages
  /// @throws InputError, ScenarioError if a value is not valid for its field
  SweepPlan(Scenario base, std::vector<Axis> axes, SeedRange seeds, std::string file = "scenario");

  std::int64_t units() const { return outer_points_ * seeds_.count(); }
  std::int64_t rows_per_unit() const { return inner_points_; }
  std::int64_t rows() const { return units() * rows_per_unit(); }
  /// First unit of a shard. The index count + 1 gives units(), the end of the last shard.
  std::int64_t ShardBegin(const Shard& shard) const {
    return units() * (shard.index - 1) / shard.count;
  }
  std::int64_t ShardEnd(const Shard& shard) const { return units() * shard.index / shard.count; }

  /// Makes `scenario` the scenario of a row. `row` counts within the unit, from 0 to
  /// rows_per_unit() - 1. `scenario` must be a copy of base(); it may have the values of another
  /// row.
  void Configure(std::int64_t unit, std::int64_t row, Scenario& scenario) const;
  /// The value of every axis in a row, in the order in which the axes were given.
  std::vector<std::string_view> ValuesOf(std::int64_t unit, std::int64_t row) const;
  /// Name of a row for messages, such as "/arbitrator/threshold=0.5, seed 7".
  std::string NameOf(std::int64_t unit, std::int64_t row) const;
  std::int64_t SeedOf(std::int64_t unit) const { return seeds_.first + unit % seeds_.count(); }

  const Scenario& base() const { return base_; }
  const std::string& file() const { return file_; }
  const std::vector<Axis>& axes() const { return axes_; }
  const SeedRange& seeds() const { return seeds_; }

 private:
  void AddAxis(const std::string& base, const Axis& axis);
  /// Index of the value that an axis has in a row.
  std::size_t ValueIndex(std::size_t axis, std::int64_t unit, std::int64_t row) const;

  Scenario base_;
  std::string file_;
  std::vector<Axis> axes_;
  SeedRange seeds_;
  std::vector<FieldAssignment> fields_;  // one for each axis
  std::vector<bool> inner_;              // for each axis: whether it belongs to the arbitrator
  std::vector<std::int64_t> stride_;     // for each axis; see the constructor
  std::int64_t outer_points_ = 1;
  std::int64_t inner_points_ = 1;
};

}  // namespace fogline::sweep
