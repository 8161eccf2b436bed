#include "services/acc/acc_model.h"

#include <unsupported/Eigen/MatrixFunctions>

namespace fogline::acc {

AccModel MakeAccModel(const AccSection& section) {
  const double engine_rate = 1.0 / section.engine_time_constant_s;
  AccModel model;
  model.a << 0, 1, -section.headway_s,  //
      0, 0, -1,                         //
      0, 0, -engine_rate;
  model.b << 0, 0, -section.engine_gain * engine_rate;
  model.c << 0, 0, 1;
  return model;
}

DiscreteAccModel Discretise(const AccModel& model, double step_s) {
  Eigen::Matrix4d augmented = Eigen::Matrix4d::Zero();
  augmented.topLeftCorner<3, 3>() = model.a * step_s;
  augmented.topRightCorner<3, 1>() = model.b * step_s;
  const Eigen::Matrix4d exponential = augmented.exp();
  return {.phi = exponential.topLeftCorner<3, 3>(), .gamma = exponential.topRightCorner<3, 1>()};
}

}  // namespace fogline::acc
