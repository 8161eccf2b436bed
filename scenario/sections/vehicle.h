// Sections of a scenario for the vehicles, which follow commands in different ways, and for the
// road.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "scenario/sections/field.h"

namespace fogline {

enum class VehicleModel { kPointMass, kLongitudinal };
template <>
struct ChoiceNames<VehicleModel> {
  static constexpr std::array<std::string_view, 2> kNames{"point_mass", "longitudinal"};
  static constexpr std::array<std::string_view, 2> kDocs{
      "the paper's: it does what it is told",
      "engine, brakes, tyres, drag and hills (services/models/vehicle)"};
};

enum class CarKind { kCompact, kSedan, kTruck };
template <>
struct ChoiceNames<CarKind> {
  static constexpr std::array<std::string_view, 3> kNames{"compact", "sedan", "truck"};
  static constexpr std::array<std::string_view, 3> kDocs{"1,093 kg, 92 kW", "1,500 kg, 100 kW",
                                                         "40 t, 330 kW, with air brakes"};
};

enum class Surface { kDry, kWet, kIce };
template <>
struct ChoiceNames<Surface> {
  static constexpr std::array<std::string_view, 3> kNames{"dry", "wet", "ice"};
  static constexpr std::array<std::string_view, 3> kDocs{"friction 0.9", "friction 0.65",
                                                         "friction 0.15"};
};

/// The road's slope at one place.
struct GradePoint {
  double position_m = 0;  // along the lane, as in truth_t
  double grade = 0;       // rise per horizontal length, positive uphill: 0.05 is 5 %

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("position_m", self.position_m,
                 {.min = -1e6,
                  .max = 1e9,
                  .unit = "m",
                  .doc = "Place along the lane; the host starts at 0. Places must increase.",
                  .source = "our choice, because the host starts at 0"});
    visit.Number(
        "grade", self.grade,
        {.min = -0.3,
         .max = 0.3,
         .unit = "",
         .doc = "Rise per horizontal length, positive uphill: 0.05 is 5 %.",
         .source = "our choice, because a road is level unless the experiment says otherwise"});
  }
};

/// The road under all cars. It has no effect on a point mass.
struct RoadSection {
  Surface surface = Surface::kDry;
  std::vector<GradePoint> grade;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("surface", self.surface, "How well tyres hold.");
    visit.List("grade", self.grade,
               {.min_items = 0,
                .max_items = 10'000,
                .doc = "Slope, linear between places; no places are a level road."});
  }
};

/// One car, or all cars of a kind.
struct VehicleSection {
  VehicleModel model = VehicleModel::kPointMass;
  CarKind car = CarKind::kSedan;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Choice("model", self.model, "How an acceleration becomes motion.");
    visit.Choice("car", self.car, "For model longitudinal: which car.");
  }
};

}  // namespace fogline
