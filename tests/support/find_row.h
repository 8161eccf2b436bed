// Functions that find a row by its name in the tables of policies and measures.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "services/decision/conflict/conflict_measures.h"
#include "services/decision/policies/policies.h"

namespace fogline::test {

/// The row with this name; nullptr if there is none.
template <class Rows>
auto FindRow(const Rows& rows, std::string_view name) {
  const auto found = std::ranges::find_if(rows, [&](const auto& row) { return row.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

inline const conflict::ConflictMeasureRow* FindConflictMeasure(std::string_view name) {
  return FindRow(conflict::ConflictMeasures(), name);
}

inline const conflict::BlameMeasureRow* FindBlameMeasure(std::string_view name) {
  return FindRow(conflict::BlameMeasures(), name);
}

/// The policy with this name; nullopt if there is none.
inline std::optional<Policy> FindPolicy(std::string_view name) {
  const policies::PolicyRow* row = FindRow(policies::Policies(), name);
  if (row == nullptr) return std::nullopt;
  return static_cast<Policy>(row - policies::Policies().data());
}

}  // namespace fogline::test
