#include "tools/cli/arguments.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/file.h"
#include "common/json.h"
#include "common/parse_number.h"
#include "common/process/console.h"
#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "services/log/event_log.h"
#include "services/runtime/transport/lcm_url.h"
#include "tools/report/metric_text.h"

namespace fogline::cli {

namespace {

/// Makes a new empty file. @return false if a file of this name exists @throws InputError
bool Reserve(const std::filesystem::path& log) {
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST) return false;
  if (file < 0) ThrowIfExhausted(errno, PathText(log));
  if (file < 0) {
    throw InputError(
        fmt::format("{}: error: --log: cannot write: {}", PathText(log), std::strerror(errno)));
  }
  close(file);
  return true;
}

}  // namespace

void RefuseOverride(std::span<const std::string> overrides, std::string_view pointer,
                    std::string_view why) {
  for (const std::string& one : overrides) {
    if (std::string_view(one).substr(0, one.find('=')) != pointer) continue;
    throw InputError(fmt::format("error: --set {}: {}", pointer, why));
  }
}

const std::string& ScenarioArguments::CheckedSeed() const {
  const IntegerSpec& range = FindField("/seed")->As<IntegerField>()->spec;
  const auto seed = ParseNumber<std::int64_t>(seed_);
  if (!seed || *seed < range.min || *seed > range.max) {
    throw InputError(fmt::format("error: --seed: {} is no seed: a whole number from {} to {}",
                                 QuoteShort(seed_), range.min, range.max));
  }
  return seed_;
}

log::LogOfRun PrepareLog(const std::filesystem::path& log, bool force) {
  RequireFolderOf(log, "--log");
  std::error_code ignored;
  if (std::filesystem::exists(log, ignored) && !std::filesystem::is_regular_file(log, ignored)) {
    throw InputError(fmt::format("{}: error: --log: not a file", PathText(log)));
  }
  // /dev/stdout and /proc/self/fd/1 name another file in the recorder's process than in this
  // process.
  if (!IsReplaceable(log)) {
    throw InputError(fmt::format(
        "{}: error: --log: this path names an open file of this process; name a file to write",
        PathText(log)));
  }
  if (const std::string older = log::TakeBackOlder(log, "--log"); !older.empty()) Complain(older);
  // The lock makes the file if the file is missing. If two runs start at the same time, only one of
  // them gets the lock. The other run may have made the file, so the size decides whether the file
  // is new. Even --force does not replace a file that another run is writing.
  auto lock = std::make_unique<FileLock>(log, FileLock::Kind::kOwn, "--log", "run");
  if (std::filesystem::is_empty(log, ignored)) return {log, std::move(lock)};
  if (!force) {
    throw InputError(
        fmt::format("{}: error: --log: the file exists; --force replaces it", PathText(log)));
  }
  if (!log::IsEventLogOrEmpty(log)) {
    throw InputError(fmt::format(
        "{}: error: --log: the file is no event log and is not replaced, even with --force",
        PathText(log)));
  }
  return log::LogOfRun::InPlaceOf(log, std::move(lock));
}

log::LogOfRun FreshLog(const std::filesystem::path& scenario_file) {
  const std::filesystem::path folder = kDefaultFolder;
  RequireFolderOf(folder / "log", "--log");
  for (int number = 1;; ++number) {
    std::filesystem::path log =
        folder / fmt::format("{}-{}.lcm", scenario_file.stem().string(), number);
    if (Reserve(log)) return log::LogOfRun(log);
  }
}

sweep::SeedRange ReadSeeds(const std::string& text) {
  const sweep::SeedRange seeds = sweep::ParseSeeds(text);
  if (seeds.count() == 1 && seeds.first > 1 && text.find(':') == std::string::npos) {
    Notice(fmt::format("--seeds {0} is the one seed {0}; seeds 1 to {0} are --seeds 1:{0}",
                       seeds.first));
  }
  return seeds;
}

void PrintJson(const nlohmann::ordered_json& json, int indent) {
  PrintJson(json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void PrintJson(const std::string& text) { fmt::print("{}\n", EscapeLines(text)); }

void RefuseJsonBeside(const std::filesystem::path& document, std::string_view option, bool json) {
  std::error_code ignored;
  // /dev/null may get both the document and the JSON text, because nothing reads it.
  if (!json || !IsStdout(document) ||
      std::filesystem::canonical(document, ignored) == "/dev/null") {
    return;
  }
  throw InputError(fmt::format("error: --json: {0} {1} uses stdout already; give {0} a file",
                               option, PathText(document)));
}

void PrintBeside(const std::filesystem::path& document, std::string_view text) {
  if (!IsStdout(document)) return fmt::print("{}", text);
  if (text.ends_with('\n')) text.remove_suffix(1);
  Complain(text);
}

nlohmann::ordered_json BuildJson(runtime::BuildId build) {
  if (build == runtime::kUnknownBuild) return nullptr;
  return runtime::BuildText(build);
}

NetworkArguments::NetworkArguments(CLI::App& verb, std::string_view what) {
  verb.add_option("--lcm-url", url_,
                  fmt::format("LCM network {} (default: $LCM_DEFAULT_URL, else {}, and the runs "
                              "announced there)",
                              what, runtime::kLcmDefaultUrl));
}

std::string CheckedNetworkUrl(const std::string& given) {
  const std::string url = runtime::NetworkUrl(given);
  const std::string_view source = given.empty() ? "LCM_DEFAULT_URL" : "--lcm-url";
  if (runtime::IsInMemory(url)) {
    throw InputError(
        fmt::format("error: {} {}: other processes cannot look into the memory of a process; give "
                    "the run a udpm:// URL",
                    source, url));
  }
  runtime::CheckUrl(source, url);
  return url;
}

namespace {

/// Returns a visitor that puts every measure into a JSON object.
auto Into(nlohmann::ordered_json& json) {
  return
      [&json]<class V>(std::string_view name, const V& value, std::string_view, std::string_view) {
        if constexpr (std::is_same_v<V, std::optional<double>>) {
          json[std::string(name)] = OrNull(value);
        } else {
          json[std::string(name)] = value;
        }
      };
}

std::string Cell(std::string_view name, std::optional<double> value, std::string_view unit) {
  return value ? report::MetricText(name, *value, unit) : "-";
}

/// A table: a line of column names, then one line for each following car.
std::string FollowersText(const std::vector<metrics::FollowerMetrics>& followers) {
  std::string text = fmt::format("  {:<10}", "follower");
  metrics::VisitFollowerMetrics(metrics::FollowerMetrics(),
                                [&text](std::string_view name, const auto&, std::string_view,
                                        std::string_view) { text += fmt::format("  {}", name); });
  text += '\n';
  for (std::size_t i = 0; i < followers.size(); ++i) {
    text += fmt::format("  {:<10}", i + 1);
    metrics::VisitFollowerMetrics(followers[i], [&text](std::string_view name, const auto& value,
                                                        std::string_view unit, std::string_view) {
      text += fmt::format("  {:>{}}", Cell(name, value, unit), name.size());
    });
    text += '\n';
  }
  return text;
}

}  // namespace

std::string MetricsJson(const runner::ExperimentResult& result) {
  nlohmann::ordered_json json;
  metrics::VisitMetrics(result.measures, Into(json));
  for (auto& [name, value] : json.items()) {
    if (!metrics::IsKnown(name, !value.is_null(), result.lack)) value = nullptr;
  }
  if (result.followers.size() > 1) {
    for (const metrics::FollowerMetrics& follower : result.followers) {
      metrics::VisitFollowerMetrics(follower, Into(json["followers"].emplace_back()));
    }
  }
  return json.dump();
}

std::string MetricsText(const runner::ExperimentResult& result) {
  std::string text;
  metrics::VisitMetrics(result.measures, [&]<class V>(std::string_view name, const V& value,
                                                      std::string_view unit, std::string_view) {
    if (!metrics::IsKnown(name, value, result.lack)) {
      text += fmt::format("  {:<32}{:>12}\n", name, "unknown");
    } else if constexpr (std::is_same_v<V, std::optional<double>>) {
      text += fmt::format("  {:<32}{:>12} {}\n", name, Cell(name, value, unit), unit);
    } else {
      text += fmt::format("  {:<32}{:>12} {}\n", name, value, unit);
    }
  });
  return result.followers.size() > 1 ? text + FollowersText(result.followers) : text;
}

nlohmann::ordered_json RealtimeJson(const log::RealtimeFigures& figures) {
  nlohmann::ordered_json json;
  log::VisitFigures(figures, [&](std::string_view name, const auto& value, std::string_view,
                                 std::string_view) {
    json[std::string(name)] = log::IsKnown(name, figures) ? nlohmann::ordered_json(value) : nullptr;
  });
  json["fallbacks"] = nlohmann::ordered_json::array();
  for (const runtime::Fallback& fallback : figures.fallbacks) {
    nlohmann::ordered_json entry{
        {"step", fallback.step}, {"role", fallback.role}, {"what", fallback.what}};
    entry["culprit"] = nullptr;
    if (!fallback.culprit.empty()) entry["culprit"] = fallback.culprit;
    json["fallbacks"].push_back(std::move(entry));
  }
  json["fallbacks_left_out"] = figures.fallbacks_left_out;
  if (figures.priority) {
    json["priority"] = {{"granted", figures.priority->granted},
                        {"refused", figures.priority->refused},
                        {"unknown", figures.priority->unknown}};
  }
  return json;
}

std::string PriorityText(const log::RealtimePriority& priority) {
  std::string text;
  const auto add = [&text](const char* what, const std::vector<std::string>& roles) {
    if (!roles.empty()) text += fmt::format("  {}: {}\n", what, fmt::join(roles, ", "));
  };
  add("with real-time priority", priority.granted);
  add("without real-time priority", priority.refused);
  add("on other machines, real-time priority unknown", priority.unknown);
  return text;
}

std::string RealtimeText(const log::RealtimeFigures& figures) {
  std::string text;
  log::VisitFigures(figures, [&](std::string_view name, const auto& value, std::string_view unit,
                                 std::string_view) {
    const bool known = log::IsKnown(name, figures);
    text += known ? fmt::format("  {:<32}{:>12} {}\n", name, value, unit)
                  : fmt::format("  {:<32}{:>12}\n", name, "unknown");
  });
  if (figures.priority) text += PriorityText(*figures.priority);
  for (const runtime::Fallback& fallback : figures.fallbacks) {
    text += fmt::format("  {}\n", fallback.Text());
  }
  if (figures.fallbacks_left_out > 0) {
    text += fmt::format("  ... and {} more\n", figures.fallbacks_left_out);
  }
  return text;
}

}  // namespace fogline::cli
