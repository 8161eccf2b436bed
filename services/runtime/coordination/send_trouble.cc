#include "services/runtime/coordination/send_trouble.h"

#include <algorithm>

#include <fmt/core.h>

namespace fogline::runtime {

std::string Text(const std::vector<SendTrouble>& troubles) {
  std::string text;
  std::vector<std::string> told;
  for (const SendTrouble& first : troubles) {
    if (std::ranges::find(told, first.error) != told.end()) continue;
    told.push_back(first.error);
    std::string roles;
    for (const SendTrouble& one : troubles) {
      if (one.error != first.error) continue;
      roles += fmt::format("{}{} {}", roles.empty() ? "" : ", ", one.role, one.count);
    }
    text += fmt::format("{}{} ({})", text.empty() ? "" : "; ", roles, first.error);
  }
  return text;
}

}  // namespace fogline::runtime
