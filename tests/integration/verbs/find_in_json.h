// Search for an object in a JSON array by one of its values.
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace fogline::test {

/// @return the first object whose `key` has this value. If there is none, the test fails, and the
/// result is null.
inline const nlohmann::json& Find(const nlohmann::json& array, const std::string& key,
                                  const std::string& value) {
  static const nlohmann::json kNone;
  for (const nlohmann::json& element : array) {
    if (element[key] == value) return element;
  }
  ADD_FAILURE() << "no " << key << " " << value << " in " << array.dump(1);
  return kNone;
}

}  // namespace fogline::test
