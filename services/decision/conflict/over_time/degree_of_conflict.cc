#include "services/decision/conflict/over_time/degree_of_conflict.h"

#include <cmath>

namespace fogline::conflict {

double DegreeOfConflict(double conflict_m, double slope_per_m, double centre_m) {
  return 1 / (1 + std::exp(-slope_per_m * (conflict_m - centre_m)));
}

double ConflictWindow::Conflict(ConflictReading reading) const {
  double sum = 0;
  int count = 0;
  ForEach([&](double difference) {
    sum += reading == ConflictReading::kMeanOfAbsolute ? std::abs(difference) : difference;
    ++count;
  });
  return count == 0 ? 0 : std::abs(sum) / count;
}

}  // namespace fogline::conflict
