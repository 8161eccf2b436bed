#include "services/decision/conflict/one_step/degree_of_conflict.h"

#include <cmath>

namespace fogline::conflict {

double DegreeOfConflict(double conflict_m, double slope_per_m, double centre_m) {
  return 1 / (1 + std::exp(-slope_per_m * (conflict_m - centre_m)));
}

void ConflictWindow::Push(std::optional<double> difference_m) {
  differences_[oldest_] = difference_m;
  oldest_ = (oldest_ + 1) % differences_.size();
}

double ConflictWindow::Conflict(ConflictReading reading) const {
  double sum = 0;
  int count = 0;
  const auto add = [&](const std::optional<double>& difference) {
    if (!difference) return;
    sum += reading == ConflictReading::kMeanOfAbsolute ? std::abs(*difference) : *difference;
    ++count;
  };
  for (std::size_t i = oldest_; i < differences_.size(); ++i) add(differences_[i]);
  for (std::size_t i = 0; i < oldest_; ++i) add(differences_[i]);
  return count == 0 ? 0 : std::abs(sum) / count;
}

}  // namespace fogline::conflict
