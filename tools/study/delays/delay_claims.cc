#include "tools/study/delays/delay_claims.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "tools/study/detection/conflict_runs.h"
#include "tools/study/detection/conflict_tables.h"
#include "tools/study/detection/detector_bank.h"

namespace fogline::study {
namespace {

// Length of a step of paper.json.
constexpr double kStep_s = 0.1;

constexpr std::array kStatements{
    DelayStatement{"a measure of a single step is slower.", "nis", "doc", Sign::kMore},
    DelayStatement{"the window explains a part of the lead.", kDocParts[1].detector,
                   kDocParts[0].detector, Sign::kLess},
    DelayStatement{"the sign explains another part of the lead.", kDocParts[2].detector,
                   kDocParts[1].detector, Sign::kLess},
    // The sigmoid rises with the distance to which it is applied. So each threshold of the sigmoid
    // gives the same alarms as one threshold of this distance.
    DelayStatement{"the sigmoid changes no alarm, by definition.", kDocParts[3].detector,
                   kDocParts[2].detector, Sign::kEqual, kStep_s, true},
    DelayStatement{"a sum over all steps is faster.", "cusum", "doc", Sign::kLess}};

}  // namespace

std::span<const DelayStatement> DelayStatements() { return kStatements; }

std::string SaysOf(const DelayStatement& statement, std::string_view noise) {
  if (noise != kUsualNoise) return fmt::format("With {} noise {}", noise, statement.says);
  std::string sentence(statement.says);
  sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  return sentence;
}

std::vector<Claim> RunDelayClaims(const StudyContext& context,
                                  const std::vector<std::string>& overrides) {
  std::vector<std::size_t> detectors;
  const auto place_of = [&](std::string_view name) {
    const std::size_t detector = DetectorNamed(name);
    const auto found = std::ranges::find(detectors, detector);
    const auto place = static_cast<std::size_t>(found - detectors.begin());
    if (found == detectors.end()) detectors.push_back(detector);
    return place;
  };
  for (const DelayStatement& one : kStatements) {
    if (one.is_by_definition) continue;
    place_of(one.a);
    place_of(one.b);
  }
  const std::vector<DelayOutcome> outcomes = RunDelays(context, detectors, overrides);
  std::vector<Claim> claims;
  for (const DelayStatement& one : kStatements) {
    if (one.is_by_definition) continue;
    const DelayOutcome& a = outcomes[place_of(one.a)];
    const DelayOutcome& b = outcomes[place_of(one.b)];
    const bool are_compared = a.is_compared && b.is_compared;
    claims.push_back(
        {.says = SaysOf(one, kUsualNoise),
         .compared = fmt::format("bias, {} noise: {} against {}, delay from fog to alarm (s)",
                                 kUsualNoise, one.a, one.b),
         .sign = one.sign,
         .difference = are_compared ? DelayDifference(a.detection, b.detection) : Estimate{},
         .margin = one.margin,
         .p = {},
         .hindrance = are_compared ? "" : "no threshold for this rate of false alarms"});
  }
  return claims;
}

}  // namespace fogline::study
