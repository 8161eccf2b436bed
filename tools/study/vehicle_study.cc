// Study `vehicle`: cars with engines, brakes, tyres and hills.
#include <array>

#include <fmt/format.h>

#include "tools/study/comparison.h"
#include "tools/study/findings.h"
#include "tools/study/study.h"

namespace fogline {
namespace {

std::vector<std::string> Cars(std::string_view car, std::string_view surface) {
  return {"/host_vehicle/model=longitudinal", fmt::format("/host_vehicle/car={}", car),
          "/follower_vehicle/model=longitudinal", fmt::format("/follower_vehicle/car={}", car),
          fmt::format("/road/surface={}", surface)};
}

std::vector<std::string> With(std::vector<std::string> overrides, std::string one) {
  overrides.push_back(std::move(one));
  return overrides;
}

std::vector<StudyCase> Cases() {
  const std::vector<std::pair<std::string, std::vector<std::string>>> kinds{
      {"point mass", {}},
      {"compact", Cars("compact", "dry")},
      {"sedan", Cars("sedan", "dry")},
      {"truck", Cars("truck", "dry")},
      {"sedan on a wet road", Cars("sedan", "wet")},
      {"sedan on ice", Cars("sedan", "ice")},
      {"sedan uphill 5 %",
       With(Cars("sedan", "dry"), R"(/road/grade=[{"position_m":0,"grade":0.05}])")},
      {"truck behind a sedan", With(Cars("sedan", "dry"), "/follower_vehicle/car=truck")}};
  std::vector<StudyCase> cases;
  for (const auto& [fog, file] :
       {std::pair("bias fog", "paper.json"), std::pair("beam fog", "dense_fog.json")}) {
    for (const auto& [name, overrides] : kinds) {
      cases.push_back({fmt::format("{}: {}", fog, name), file, overrides});
    }
  }
  return cases;
}

constexpr std::array<std::string_view, 8> kTableMeasures{"si_pct",
                                                         "mean_compromised_safety_fog_m",
                                                         "collided",
                                                         "min_host_gap_m",
                                                         "min_follower_gap_m",
                                                         "max_follower_drac_mps2",
                                                         "max_handover_jerk_mps3",
                                                         "rms_jerk_mps3"};

}  // namespace

StudyResult RunVehicleStudy(const StudyContext& context) {
  const Comparison comparison(
      context, Cases(),
      {{"none", {"/arbitrator/policy=none"}},
       {"traded", {"/arbitrator/policy=traded"}},
       {"traded jerk-limited",
        {"/arbitrator/policy=traded", "/arbitrator/transfer/profile=jerk_limited"}}});
  StudyResult result;
  result.runs = comparison.runs();
  StudySection& section = result.section;
  section.findings = CaseFindings(comparison, 1);
  section.figures = {comparison.FigureOf("mean_compromised_safety_fog_m", "vehicle-cs",
                                         "Compromised safety by vehicle", true),
                     comparison.FigureOf("max_handover_jerk_mps3", "vehicle-jerk",
                                         "Jerk at hand-overs: what a car lets through", true),
                     comparison.FigureOf("max_follower_drac_mps2", "vehicle-drac",
                                         "How hard the follower has to brake", true),
                     comparison.FigureOf("collided", "vehicle-collisions", "Collisions", true)};
  for (std::size_t v = 0; v < comparison.variants().size(); ++v) {
    section.tables.push_back(comparison.TableOfVariant(v, kTableMeasures));
  }
  section.method = fmt::format(
      "{} seeds of paper.json and dense_fog.json with host and follower as cars of that kind, "
      "without traded control, with the paper's step, and with a jerk-limited transfer. ACC and "
      "driver are those that were tuned for the point mass.",
      comparison.seeds());
  result.files = {{"vehicle.csv", comparison.Csv(0)}};
  return result;
}

}  // namespace fogline
