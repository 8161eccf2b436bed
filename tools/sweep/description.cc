#include "tools/sweep/description.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/file.h"
#include "common/text.h"
#include "scenario/io/json.h"
#include "scenario/io/loader.h"

namespace fogline::sweep {
namespace {

using Json = nlohmann::ordered_json;

Json DescribeSweep(const SweepPlan& plan) {
  Json grid = Json::array();
  for (const Axis& axis : plan.axes()) {
    grid.push_back({{"field", axis.pointer}, {"values", axis.values}});
  }
  return {{"grid", grid},
          {"seeds", {plan.seeds().first, plan.seeds().last}},
          {"rows", plan.rows()},
          {"scenario", Json::parse(PrintScenario(plan.base()))}};
}

}  // namespace

Description Describe(const SweepPlan& plan, const Shard& shard) {
  return {.sweep = DescribeSweep(plan).dump(),
          .shard = shard,
          .rows = (plan.ShardEnd(shard) - plan.ShardBegin(shard)) * plan.rows_per_unit(),
          .all_rows = plan.rows()};
}

std::filesystem::path DescriptionFile(const std::filesystem::path& csv) {
  return std::filesystem::path(csv) += ".json";
}

bool IsSweep(const std::filesystem::path& csv) {
  try {
    ReadDescription(csv);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

Description ReadDescription(const std::filesystem::path& csv) {
  const std::filesystem::path file = DescriptionFile(csv);
  const FileText read = ReadFile(file, kMaxFileBytes);
  try {
    const Json json = Json::parse(read.text);
    const Json& sweep = json.at("sweep");
    const Json& shard = json.at("shard");
    return {.sweep = sweep.dump(),
            .shard = {.index = shard.at(0), .count = shard.at(1)},
            .rows = json.at("shard_rows"),
            .all_rows = sweep.at("rows")};
  } catch (const Json::exception&) {
    throw InputError(fmt::format("{}: error: not the result of a sweep: {} {}", PathText(csv),
                                 PathText(file), read.error.empty() ? "is damaged" : "is missing"));
  }
}

void WriteDescription(const std::filesystem::path& csv, const Description& description) {
  const Json json{{"sweep", Json::parse(description.sweep)},
                  {"shard", {description.shard.index, description.shard.count}},
                  {"shard_rows", description.rows}};
  AtomicFile file(DescriptionFile(csv));
  file.Write(json.dump(1) + "\n");
  file.Finish();
}

}  // namespace fogline::sweep
