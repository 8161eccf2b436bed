#include "tools/compare/host_differences.h"

#include "common/csv_series.h"

namespace fogline::compare {

std::vector<ComparedStep> CompareSteps(std::span<const metrics::Sample> run, double start_s,
                                       const RecordedCar& car) {
  CsvSeries speed_mps(car.times_s, car.speeds_mps);
  CsvSeries gap_m(car.times_s, car.gaps_m);
  std::vector<ComparedStep> steps;
  steps.reserve(run.size());
  for (const metrics::Sample& sample : run) {
    const double time_s = start_s + sample.time_s;
    steps.push_back({.time_s = sample.time_s,
                     .speed_mps = sample.host_speed_mps,
                     .recorded_speed_mps = speed_mps.At(time_s),
                     .gap_m = sample.host_gap_m,
                     .recorded_gap_m = gap_m.At(time_s)});
  }
  return steps;
}

HostDifferences DifferencesOf(std::span<const ComparedStep> steps) {
  HostDifferences differences;
  for (const ComparedStep& step : steps) {
    differences.speed_mps.Add(step.speed_mps, step.recorded_speed_mps);
    differences.gap_m.Add(step.gap_m, step.recorded_gap_m);
  }
  return differences;
}

}  // namespace fogline::compare
