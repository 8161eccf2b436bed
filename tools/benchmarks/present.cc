#include "tools/benchmarks/present.h"

#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace fogline::benchmarks {
namespace {

std::string CpuModel() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(": ") + 2);
  }
  return "unknown CPU";
}

/// The number with three significant digits, and separators between thousands: 0.0123, 4.56, 78.9,
/// 12,300.
std::string Rounded(double value) {
  constexpr double kWhole = 100;
  if (std::abs(value) < kWhole) return fmt::format("{:#.3g}", value);
  const double digit = std::pow(10, std::floor(std::log10(std::abs(value))) - 2);
  return WithThousands(fmt::format("{:.0f}", std::round(value / digit) * digit));
}

std::string WithUnit(const Spread& spread, const std::string& unit) {
  return Rounded(spread.median) + " " + unit;
}

std::string Ratio(const Finding& finding) {
  return fmt::format("{} [{}, {}]", Rounded(finding.ratio.median),
                     Rounded(finding.ratio.lower_quartile), Rounded(finding.ratio.upper_quartile));
}

std::string Goal(const Comparison& comparison) {
  return fmt::format("{} {}", comparison.bound == Bound::kAtMost ? "<=" : ">=",
                     fmt::format("{:g}", comparison.goal));
}

std::string Caption(const Occasion& occasion) {
  return fmt::format("Medians of {} rounds [quartiles of the ratio]; {}, {} cores, {}.",
                     occasion.rounds, occasion.cpu, occasion.cores, occasion.date);
}

}  // namespace

std::string WithThousands(std::string digits) {
  constexpr std::size_t kGroup = 3;
  for (std::size_t i = digits.size(); i > kGroup; i -= kGroup) digits.insert(i - kGroup, 1, ',');
  return digits;
}

Occasion ThisOccasion(int rounds) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {.cpu = CpuModel(),
          .cores = std::thread::hardware_concurrency(),
          .date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(now)),
          .rounds = rounds};
}

std::string ToText(const std::vector<Finding>& findings, const Occasion& occasion) {
  std::string text = Caption(occasion) + "\n";
  for (const Finding& finding : findings) {
    const Comparison& comparison = finding.comparison;
    text += fmt::format("\n{}: {}\n", comparison.name, comparison.quantity);
    if (!finding.note.empty()) {
      text += fmt::format("  {}: {}\n", finding.Verdict(), finding.note);
      continue;
    }
    text +=
        fmt::format("  {:<58}{:>14}\n", comparison.ours, WithUnit(finding.ours, comparison.unit));
    text += fmt::format("  {:<58}{:>14}\n", comparison.reference,
                        WithUnit(finding.reference, comparison.unit));
    text += fmt::format("  ratio {}, goal {}: {}\n", Ratio(finding), Goal(comparison),
                        finding.Verdict());
  }
  return text;
}

std::string ToMarkdown(const std::vector<Finding>& findings, const Occasion& occasion) {
  std::string text = "| | Fogline | beside | ratio | goal | |\n|---|---|---|---|---|---|\n";
  for (const Finding& finding : findings) {
    const Comparison& comparison = finding.comparison;
    if (!finding.note.empty()) {
      text += fmt::format("| {} | {} | {} | {} | {} | not measured |\n", comparison.quantity,
                          comparison.ours, comparison.reference, finding.note, Goal(comparison));
      continue;
    }
    text += fmt::format("| {} | {}: {} | {}: {} | {} | {} | {} |\n", comparison.quantity,
                        comparison.ours, WithUnit(finding.ours, comparison.unit),
                        comparison.reference, WithUnit(finding.reference, comparison.unit),
                        Ratio(finding), Goal(comparison), finding.Verdict());
  }
  return text + "\n" + Caption(occasion) + "\n";
}

std::string ToJson(const std::vector<Finding>& findings, const Occasion& occasion) {
  const auto spread = [](const Spread& s) {
    return nlohmann::ordered_json{{"median", s.median},
                                  {"quartiles", {s.lower_quartile, s.upper_quartile}}};
  };
  nlohmann::ordered_json json{{"cpu", occasion.cpu},
                              {"cores", occasion.cores},
                              {"date", occasion.date},
                              {"rounds", occasion.rounds}};
  for (const Finding& finding : findings) {
    const Comparison& comparison = finding.comparison;
    nlohmann::ordered_json row{
        {"name", comparison.name},
        {"quantity", comparison.quantity},
        {"unit", comparison.unit},
        {"ours", comparison.ours},
        {"reference", comparison.reference},
        {"bound", comparison.bound == Bound::kAtMost ? "at_most" : "at_least"},
        {"goal", comparison.goal},
        {"met", finding.met()}};
    if (comparison.bar) row["bar"] = *comparison.bar;
    if (finding.note.empty()) {
      row["ours_measured"] = spread(finding.ours);
      row["reference_measured"] = spread(finding.reference);
      row["ratio"] = spread(finding.ratio);
    } else {
      row["ratio"] = nullptr;
      row["note"] = finding.note;
    }
    json["comparisons"].push_back(std::move(row));
  }
  return json.dump(2) + "\n";
}

}  // namespace fogline::benchmarks
