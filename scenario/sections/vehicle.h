// Sections of a scenario for the road, and for vehicles that follow commands in different ways.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "scenario/sections/field.h"

namespace fogline {

enum class VehicleModel { kPointMass, kLongitudinal };
constexpr auto ChoicesOf(VehicleModel) {
  return std::to_array<Choice>(
      {{"point_mass", "the paper's: it follows its commands exactly"},
       {"longitudinal", "engine, brakes, tyres, drag and hills (services/models/vehicle)"}});
}

enum class CarKind { kCompact, kSedan, kTruck };
constexpr auto ChoicesOf(CarKind) {
  return std::to_array<Choice>({{"compact", "1,093 kg, 92 kW"},
                                {"sedan", "1,500 kg, 100 kW"},
                                {"truck", "40 t, 330 kW, with air brakes"}});
}

enum class Surface { kDry, kWet, kIce };
constexpr auto ChoicesOf(Surface) {
  return std::to_array<Choice>(
      {{"dry", "friction 0.9"}, {"wet", "friction 0.65"}, {"ice", "friction 0.15"}});
}

/// The road's slope at one position along the lane, as in truth_t.
struct GradePoint {
  FOGLINE_FIELD(double, position_m, 0, {-1e6, 1e9, "m"},
                "Place along the lane; the host starts at 0. Places must increase.",
                "our choice, because the host starts at 0");
  FOGLINE_FIELD(double, grade, 0, {-0.3, 0.3},
                "Rise per horizontal length, positive uphill: 0.05 is 5 %.",
                "our choice, because a road is level unless the experiment says otherwise");

  bool operator==(const GradePoint&) const = default;
};

/// The road under all cars. The road has no effect on a car whose model is a point mass. If host or
/// following cars have tyres (model longitudinal), the road also limits the braking of the
/// preceding car (services/world).
struct RoadSection {
  FOGLINE_FIELD(Surface, surface, Surface::kDry,
                "Surface of the road, which sets the friction of the tyres. It also limits the "
                "braking of the preceding car, unless all other cars are point masses.");
  FOGLINE_FIELD(std::vector<GradePoint>, grade, {}, {0, 10'000},
                "Slope, linear between places. Without places the road is level.");

  bool operator==(const RoadSection&) const = default;
};

/// The vehicle of the host, or of all following cars.
struct VehicleSection {
  FOGLINE_FIELD(VehicleModel, model, VehicleModel::kPointMass,
                "How an acceleration becomes motion.");
  FOGLINE_FIELD(CarKind, car, CarKind::kSedan, "For model longitudinal: which car.");

  bool operator==(const VehicleSection&) const = default;
};

}  // namespace fogline
