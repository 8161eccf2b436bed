// Study `vehicle`: cars with engines, brakes, tyres and hills.
#include <array>

#include <fmt/format.h>

#include "services/models/vehicle/vehicle_parameters.h"
#include "tools/study/claims.h"
#include "tools/study/comparison.h"
#include "tools/study/design.h"
#include "tools/study/sensor_noise.h"
#include "tools/study/study.h"

namespace fogline::study {
namespace {

std::vector<std::string> Cars(std::string_view car, std::string_view surface) {
  return {"/host_vehicle/model=longitudinal", fmt::format("/host_vehicle/car={}", car),
          "/follower_vehicle/model=longitudinal", fmt::format("/follower_vehicle/car={}", car),
          fmt::format("/road/surface={}", surface)};
}

/// Overrides for a slope along the whole road. A loaded truck has 330 kW, and needs 260 kW to keep
/// 20 m/s on this slope. The remaining power allows an acceleration of 0.08 m/s2.
std::vector<std::string> Uphill(std::vector<std::string> overrides) {
  overrides.emplace_back(R"(/road/grade=[{"position_m":0,"grade":0.02}])");
  return overrides;
}

/// Overrides for a sedan on ice. The leader is on the same ice, and brakes less hard than the limit
/// of the ice, 1.47 m/s2.
std::vector<std::string> SedanOnIce() {
  std::vector<std::string> overrides = Cars("sedan", "ice");
  overrides.emplace_back("/lead/emergency_brake/deceleration_mps2=1.4");
  return overrides;
}

std::vector<std::string> TruckBehindSedan() {
  std::vector<std::string> overrides = Cars("sedan", "dry");
  overrides.emplace_back("/follower_vehicle/car=truck");
  return overrides;
}

/// A kind of fog, with or without a braking leader.
struct Ground {
  std::string_view name;
  std::string_view file;
  std::vector<std::string> overrides;
  bool is_dense;  // whether the fog is so dense that the cars accelerate and brake noticeably
  bool brakes;    // whether the cars must brake hard
};

/// All kinds of fog. In the hard-braking case, the leader brakes to a third of its speed in the
/// middle of the dense fog. Its deceleration is that of ASAM OSC-ALKS scenario 4.3_2.
std::vector<Ground> Grounds() {
  return {{"bias fog", "paper.json", {}, false, false},
          {"beam fog", "dense_fog.json", {}, true, false},
          {"hard braking in beam fog",
           "dense_fog.json",
           {"/lead/profile=emergency_brake", "/lead/emergency_brake/start_s=30",
            "/lead/emergency_brake/deceleration_mps2=6", "/lead/emergency_brake/final_speed_mps=7"},
           true,
           true}};
}

/// The cases of the study. If a kind of car never reaches its limits in a case, the case would have
/// the same runs as another case. Such a case is omitted. VehicleMethod() names the omitted cases.
std::vector<StudyCase> VehicleCases() {
  std::vector<StudyCase> cases;
  for (const Ground& ground : Grounds()) {
    const auto add = [&](std::string_view name, const std::vector<std::string>& overrides) {
      StudyCase& one =
          cases.emplace_back(StudyCase{.name = fmt::format("{}: {}", ground.name, name),
                                       .file = std::string(ground.file),
                                       .overrides = ground.overrides,
                                       .group = std::string(ground.name)});
      one.overrides.insert(one.overrides.end(), overrides.begin(), overrides.end());
    };
    add("point mass", {});
    add("sedan", Cars("sedan", "dry"));
    add("truck", Cars("truck", "dry"));
    add("truck behind a sedan", TruckBehindSedan());
    if (ground.is_dense) add("truck uphill 2 %", Uphill(Cars("truck", "dry")));
    if (!ground.brakes) continue;
    add("compact", Cars("compact", "dry"));
    add("sedan on ice", SedanOnIce());
  }
  return cases;
}

/// The cases "sedan" and "truck" of each of Grounds(), with realistic noise. The cases with a slope
/// or ice, or with cars of two kinds, are left out.
std::vector<StudyCase> NoisyCars() {
  std::vector<StudyCase> noisy = VehicleCases();
  std::erase_if(noisy, [](const StudyCase& one) {
    return !one.name.ends_with(": sedan") && !one.name.ends_with(": truck");
  });
  for (StudyCase& one : noisy) one = WithRealisticNoise(std::move(one));
  return noisy;
}

constexpr std::array<std::string_view, 8> kVehicleTable{"si_pct",
                                                        "mean_compromised_safety_fog_m",
                                                        "collided",
                                                        "min_host_gap_m",
                                                        "min_follower_gap_m",
                                                        "max_follower_drac_mps2",
                                                        "max_handover_jerk_mps3",
                                                        "rms_jerk_mps3"};

constexpr std::string_view kVehicleAnswer =
    "Yes, but in dense fog the safety improvement is smaller than for a point mass, and smallest "
    "for a truck. Behind a leader that brakes hard in the fog on a dry road, handing over does "
    "harm with point masses, passenger cars (compact, sedan) and trucks; but with half of the "
    "parameter sets of study ensemble it helps with point masses and passenger cars. Behind such a "
    "leader, with the parameters of this study, a jerk limit on the transfer lets trucks collide.";
constexpr std::string_view kVehicleWouldChange =
    "An ACC and a driver that are tuned to the car, or automatic emergency braking.";

std::vector<PlannedClaim> VehicleClaims() {
  std::vector<PlannedClaim> claims;
  const auto add = [&](std::string says, std::string_view name, std::string_view a,
                       std::string_view b, std::string_view measure, Sign sign) {
    claims.push_back(PairClaim(std::move(says), {name, a}, {name, b}, measure, sign));
  };
  for (const std::string_view car : {"sedan", "truck", "truck behind a sedan"}) {
    for (const std::string_view fog : {"bias fog", "beam fog"}) {
      const std::string name = fmt::format("{}: {}", fog, car);
      add(fmt::format("Traded control helps: {}.", name), name, "traded", "none", kShortfall,
          Sign::kLess);
    }
  }
  claims.push_back(PairClaim("A sedan has less safety improvement than a point mass.",
                             {"beam fog: sedan", "traded"}, {"beam fog: point mass", "traded"},
                             "si_pct", Sign::kLess));
  claims.push_back(PairClaim("A truck has less safety improvement than a sedan.",
                             {"beam fog: truck", "traded"}, {"beam fog: sedan", "traded"}, "si_pct",
                             Sign::kLess));
  for (const std::string_view car :
       {"point mass", "sedan", "truck", "truck behind a sedan", "truck uphill 2 %", "compact"}) {
    const std::string name = fmt::format("hard braking in beam fog: {}", car);
    add(fmt::format("Traded control does harm: {}.", name), name, "traded", "none", kShortfall,
        Sign::kMore);
  }
  add("Behind a leader that brakes hard, a jerk limit lets trucks collide.",
      "hard braking in beam fog: truck", "traded jerk-limited", "traded", "collided", Sign::kMore);
  for (const std::string_view car : {"sedan", "truck"}) {
    for (const std::string_view fog : {"bias fog", "beam fog"}) {
      const std::string name = fmt::format("{}: {}{}", fog, car, kWithRealisticNoise);
      add(fmt::format("Traded control helps: {}.", name), name, "traded", "none", kShortfall,
          Sign::kLess);
    }
    const std::string name =
        fmt::format("hard braking in beam fog: {}{}", car, kWithRealisticNoise);
    add(fmt::format("Traded control does harm: {}.", name), name, "traded", "none", kShortfall,
        Sign::kMore);
  }
  return claims;
}

/// Each kind of car with traded control, in the cases in which the car's limits matter.
report::StudyTable VehicleMainTable(const Comparison& comparison) {
  std::vector<NamedCell> rows;
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    const StudyCase& one = comparison.cases()[c];
    if (one.group == "bias fog" || one.name.ends_with("uphill 2 %")) continue;
    if (one.name.ends_with(kWithRealisticNoise)) continue;
    rows.push_back({one.name, {c, comparison.VariantNamed("traded")}});
  }
  return comparison.TableOf("Traded control", "case", rows, kVehicleTable);
}

/// Largest magnitude of the host's acceleration in all runs.
double HardestOf(const Comparison& comparison) {
  double hardest = 0;
  for (std::size_t c = 0; c < comparison.cases().size(); ++c) {
    for (std::size_t v = 0; v < comparison.variants().size(); ++v) {
      for (const double value : comparison.Values({c, v}, "max_abs_acceleration_mps2")) {
        if (value > hardest) hardest = value;
      }
    }
  }
  return hardest;
}

std::string VehicleMethod(const Comparison& comparison) {
  constexpr double kGravity_mps2 = 9.81;
  const double hardest = HardestOf(comparison);
  const double wet = models::FrictionOf(Surface::kWet) * kGravity_mps2;
  return fmt::format(
      "{} seeds of paper.json, of dense_fog.json, and of dense_fog.json with a leader that brakes "
      "with 6 m/s2 (on ice with 1.4 m/s2, because friction allows hardly more) from 20 to 7 m/s in "
      "the middle of the fog. Host and follower are cars of the kind that the case names. There "
      "are three variants: no traded control, traded control with the paper's step, and traded "
      "control with a jerk-limited transfer. ACC and driver are tuned for the point mass. Each "
      "case reaches another limit of the car: delay and lag in every car, the little power that a "
      "truck has left on a slope, the tyres on ice under hard braking. The compact has the delays "
      "and lags of the sedan, so it appears only under hard braking. No case has a wet road: "
      "friction on a wet road allows {:.1f} m/s2, and the hardest acceleration or braking of a "
      "host in any of these runs is {:.1f} m/s2{}. {}",
      comparison.seeds(), wet, hardest,
      hardest < wet ? ", so a wet road would give the results of the dry road" : "",
      RealisticNoiseText());
}

}  // namespace

StudyDesign VehicleDesign() {
  std::vector<StudyCase> cases = VehicleCases();
  for (StudyCase& one : NoisyCars()) cases.push_back(std::move(one));
  return {
      .cases = std::move(cases),
      .variants = {{"none", {"/arbitrator/policy=none"}},
                   {"traded", {"/arbitrator/policy=traded"}},
                   {"traded jerk-limited",
                    {"/arbitrator/policy=traded", "/arbitrator/transfer/profile=jerk_limited"}}},
      .claims = VehicleClaims()};
}

StudyResult RunVehicleStudy(const StudyContext& context) {
  const StudyDesign design = VehicleDesign();
  const Comparison comparison(context, design.cases, design.variants);
  StudyResult result;
  result.runs = comparison.runs();
  report::StudySection& section = result.section;
  section.answer = kVehicleAnswer;
  section.would_change = kVehicleWouldChange;
  result.claims = ClaimsOf(comparison, design.claims);
  section.figures = {comparison.FigureOf("mean_compromised_safety_fog_m", "vehicle-cs",
                                         "Compromised safety by vehicle", true),
                     comparison.FigureOf("max_handover_jerk_mps3", "vehicle-jerk",
                                         "Jerk at hand-overs by vehicle", true),
                     comparison.FigureOf("max_follower_drac_mps2", "vehicle-drac",
                                         "How hard the follower has to brake", true),
                     comparison.FigureOf("collided", "vehicle-collisions", "Collisions", true)};
  section.tables = {VehicleMainTable(comparison)};
  for (std::size_t v = 0; v < comparison.variants().size(); ++v) {
    section.tables.push_back(comparison.TableOfVariant(v, kVehicleTable));
  }
  section.method = VehicleMethod(comparison);
  result.files = {{"vehicle.csv", comparison.Csv(0)}};
  return result;
}

}  // namespace fogline::study
