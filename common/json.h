// Values of JSON documents.
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

namespace fogline {

/// The value times a factor, for example for a change of unit; null if there is no value.
inline nlohmann::ordered_json OrNull(const std::optional<double>& value, double factor = 1) {
  return value ? nlohmann::ordered_json(factor * *value) : nlohmann::ordered_json(nullptr);
}

}  // namespace fogline
