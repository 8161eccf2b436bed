// Writes findings as text for people and as JSON for programs.
#pragma once

#include <string>
#include <vector>

#include "tools/benchmarks/comparison.h"

namespace fogline::benchmarks {

/// Machine and date of a measurement.
struct Occasion {
  std::string cpu;  // model name, as the kernel gives it
  unsigned cores = 0;
  std::string date;  // 2024-12-31, UTC
  int rounds = 0;
};

Occasion ThisOccasion(int rounds);

/// Puts commas between the thousands of a whole number: "12,300".
std::string WithThousands(std::string digits);

std::string ToText(const std::vector<Finding>& findings, const Occasion& occasion);
std::string ToMarkdown(const std::vector<Finding>& findings, const Occasion& occasion);
std::string ToJson(const std::vector<Finding>& findings, const Occasion& occasion);

}  // namespace fogline::benchmarks
