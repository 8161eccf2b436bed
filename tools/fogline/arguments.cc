#include "tools/fogline/arguments.h"

#include <optional>
#include <type_traits>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace fogline {

void PrepareLog(const std::filesystem::path& log, bool force) {
  if (std::filesystem::exists(log) && !force) {
    throw InputError(
        fmt::format("{}: error: --log: the file exists; --force replaces it", log.string()));
  }
  if (log.has_parent_path()) {
    std::error_code error;
    std::filesystem::create_directories(log.parent_path(), error);
    if (error) {
      throw InputError(fmt::format("{}: error: --log: cannot make the folder: {}", log.string(),
                                   error.message()));
    }
  }
}

std::filesystem::path FreshLog(const std::filesystem::path& scenario_file) {
  for (int number = 1;; ++number) {
    std::filesystem::path log = std::filesystem::path("logs") /
                                fmt::format("{}-{}.lcm", scenario_file.stem().string(), number);
    if (std::filesystem::exists(log)) continue;
    PrepareLog(log, false);
    return log;
  }
}

void PrintJson(const std::string& text) { fmt::print("{}\n", text); }

std::string MeasuresJson(const RunMeasures& measures) {
  nlohmann::ordered_json json;
  VisitMeasures(measures, [&json]<class V>(std::string_view name, const V& value, std::string_view,
                                           std::string_view) {
    if constexpr (std::is_same_v<V, std::optional<double>>) {
      json[std::string(name)] =
          value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    } else {
      json[std::string(name)] = value;
    }
  });
  return json.dump();
}

std::string MeasuresText(const RunMeasures& measures) {
  std::string text;
  VisitMeasures(measures, [&text]<class V>(std::string_view name, const V& value,
                                           std::string_view unit, std::string_view) {
    if constexpr (std::is_same_v<V, std::optional<double>>) {
      text += fmt::format("  {:<32}{:>12} {}\n", name, value ? fmt::format("{:.4f}", *value) : "-",
                          unit);
    } else {
      text += fmt::format("  {:<32}{:>12} {}\n", name, value, unit);
    }
  });
  return text;
}

}  // namespace fogline
