// Reads a CSV file with the recording of a real car behind a leader, and checks the recording.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "common/csv.h"
#include "scenario/sections/road.h"
#include "services/metrics/sample.h"

namespace fogline::compare {

/// Recorded data of the real car, and of its leader if the file has data of the leader.
struct RecordedCar {
  std::vector<CsvNumber> times_s;
  std::vector<CsvNumber> speeds_mps;
  std::vector<CsvNumber> gaps_m;  // to the leader, bumper to bumper
  std::vector<CsvNumber> leader_mps;
};

/// The names of the car's columns.
struct RecordedColumns {
  std::string speed;
  std::string gap;
};

/// @param leader names the columns of the time and of the leader's speed
/// @throws InputError that names the file, and the line of a wrong value
RecordedCar ReadRecordedCar(const std::filesystem::path& file, const RecordedColumns& car,
                            const RecordedSection& leader);

/// @param file the file that the error message names
/// @throws InputError if the times do not ascend, or do not cover the times of the run
void CheckTimes(const std::vector<CsvNumber>& times_s, double begin_s, double end_s,
                const std::filesystem::path& file);

/// @param run the samples of all steps
/// @throws InputError if the leader of the recording is not the leader of the run
void CheckLeader(const RecordedCar& car, const RecordedSection& leader,
                 std::span<const metrics::Sample> run, const std::filesystem::path& file);

}  // namespace fogline::compare
