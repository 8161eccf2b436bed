// Random numbers for property tests, the same in every execution.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "common/random.h"

namespace fogline {

/// Draws a sequence of numbers from a seed.
class Draw {
 public:
  explicit Draw(std::int64_t seed) : random_(seed, kTestStream) {}

  double Uniform(double min, double max) { return min + (max - min) * Next(); }

  /// A number in [min, max]. Every order of magnitude is equally likely.
  double LogUniform(double min, double max) { return min * std::pow(max / min, Next()); }

  /// A whole number in [min, max], uniform.
  Eigen::Index Integer(Eigen::Index min, Eigen::Index max) {
    return min + static_cast<Eigen::Index>(Next() * static_cast<double>(max - min + 1));
  }

  bool Chance(double probability) { return Next() < probability; }

  Eigen::MatrixXd Matrix(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd m(rows, columns);
    for (double& entry : m.reshaped()) entry = Uniform(-1, 1);
    return m;
  }

  Eigen::VectorXd Vector(Eigen::Index size) { return Matrix(size, 1); }

 private:
  static constexpr Stream kTestStream{1000};

  double Next() { return random_.Uniform2(count_++, 0)[0]; }

  Random random_;
  std::int64_t count_ = 0;
};

}  // namespace fogline
