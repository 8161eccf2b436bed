#include "tools/sweep/csv.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenario/loader.h"

namespace fogline {
namespace {

using Json = nlohmann::ordered_json;

std::string HeaderLine(const SweepPlan& plan) {
  std::string line;
  for (const Axis& axis : plan.axes()) line += axis.pointer + ",";
  line += "seed,si_pct";
  VisitMeasures(RunMeasures{}, [&line](std::string_view name, const auto&, std::string_view,
                                       std::string_view) { line += fmt::format(",{}", name); });
  return line + "\n";
}

void AppendRow(const SweepPlan& plan, std::int64_t unit, std::int64_t index, const SweepRow& row,
               std::string& text) {
  const auto number = [&text](const std::optional<double>& value) {
    if (value) text += fmt::format("{}", *value);
  };
  for (const std::string_view value : plan.ValuesOf(unit, index)) {
    text += value;
    text += ',';
  }
  text += fmt::format("{},", plan.SeedOf(unit));
  number(row.si_pct);
  VisitMeasures(row.measures,
                [&]<class V>(std::string_view, const V& value, std::string_view, std::string_view) {
                  text += ',';
                  if constexpr (std::is_same_v<V, std::optional<double>>) {
                    number(value);
                  } else {
                    text += fmt::format("{}", value);
                  }
                });
  text += '\n';
}

/// What a sweep is, apart from the shard.
Json Describe(const SweepPlan& plan) {
  Json grid = Json::array();
  for (const Axis& axis : plan.axes())
    grid.push_back({{"field", axis.pointer}, {"values", axis.values}});
  return {{"grid", grid},
          {"seeds", {plan.seeds().first, plan.seeds().last}},
          {"rows", plan.rows()},
          {"scenario", Json::parse(PrintScenario(plan.base()))}};
}

Json DescribeShard(const SweepPlan& plan, const Shard& shard) {
  return {{"sweep", Describe(plan)},
          {"shard", {shard.index, shard.count}},
          {"shard_rows", (plan.ShardEnd(shard) - plan.ShardBegin(shard)) * plan.rows_per_unit()}};
}

std::string Content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void WriteWhole(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) {
    throw InputError(
        fmt::format("{}: error: cannot write: {}", file.string(), std::strerror(errno)));
  }
}

}  // namespace

std::filesystem::path DescriptionFile(const std::filesystem::path& csv) {
  return csv.string() + ".json";
}

SweepFile::SweepFile(const std::filesystem::path& file, const SweepPlan& plan, const Shard& shard,
                     bool force)
    : path_(file), plan_(plan), next_unit_(plan.ShardBegin(shard)) {
  const std::string description = DescribeShard(plan, shard).dump(1) + "\n";
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  const bool there = std::filesystem::exists(file);
  if (there && !force && Content(DescriptionFile(file)) != description) {
    throw InputError(
        fmt::format("{}: error: --out: the file is there and is not of this sweep; "
                    "--force replaces it",
                    file.string()));
  }
  if (there && !force) {
    Resume();
  } else {
    WriteWhole(DescriptionFile(file), description);
    Start();
  }
}

void SweepFile::Start() {
  file_.reset(std::fopen(path_.c_str(), "wb"));
  if (!file_) {
    throw InputError(
        fmt::format("{}: error: --out: cannot write: {}", path_.string(), std::strerror(errno)));
  }
  Write(HeaderLine(plan_));
}

void SweepFile::Resume() {
  // Line by line, so that a file of any size takes no memory.
  std::ifstream in(path_, std::ios::binary);
  std::string line;
  std::uintmax_t position = 0;
  std::uintmax_t whole = 0;  // end of the last whole unit, or of the header
  std::int64_t rows = -1;    // the header is not one
  while (std::getline(in, line) && !in.eof()) {
    position += line.size() + 1;
    ++rows;
    if (rows % plan_.rows_per_unit() == 0) whole = position;
  }
  in.close();
  if (rows < 0) return Start();
  next_unit_ += rows / plan_.rows_per_unit();
  std::filesystem::resize_file(path_, whole);
  file_.reset(std::fopen(path_.c_str(), "ab"));
  if (!file_) {
    throw InputError(
        fmt::format("{}: error: --out: cannot write: {}", path_.string(), std::strerror(errno)));
  }
}

void SweepFile::Append(const std::vector<SweepRow>& rows) {
  text_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    AppendRow(plan_, next_unit_, static_cast<std::int64_t>(i), rows[i], text_);
  }
  Write(text_);
  ++next_unit_;
}

void SweepFile::Write(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() ||
      std::fflush(file_.get()) != 0) {
    throw std::runtime_error(
        fmt::format("{}: cannot write: {}", path_.string(), std::strerror(errno)));
  }
}

void MergeShards(const std::vector<std::filesystem::path>& shards,
                 const std::filesystem::path& merged, bool force) {
  if (std::filesystem::exists(merged) && !force) {
    throw InputError(
        fmt::format("{}: error: --out: the file exists; --force replaces it", merged.string()));
  }
  std::map<std::int64_t, std::filesystem::path> ordered;
  Json sweep;
  std::int64_t count = 0;
  for (const std::filesystem::path& shard : shards) {
    const Json description = Json::parse(Content(DescriptionFile(shard)), nullptr, false);
    if (description.is_discarded() || !description.contains("shard")) {
      throw InputError(fmt::format("{}: error: no sweep: {} is missing or damaged", shard.string(),
                                   DescriptionFile(shard).string()));
    }
    if (ordered.empty()) {
      sweep = description["sweep"];
      count = description["shard"][1];
    }
    if (description["sweep"] != sweep || description["shard"][1] != count) {
      throw InputError(fmt::format("{}: error: not of the same sweep as {}", shard.string(),
                                   shards.front().string()));
    }
    if (!ordered.emplace(description["shard"][0], shard).second) {
      throw InputError(fmt::format("{}: error: shard {} is given twice", shard.string(),
                                   description["shard"][0].get<std::int64_t>()));
    }
  }
  for (std::int64_t index = 1; index <= count; ++index) {
    if (!ordered.contains(index)) {
      throw InputError(fmt::format("error: shard {} of {} is missing", index, count));
    }
  }
  std::ofstream out(merged, std::ios::binary);
  for (const auto& [index, shard] : ordered) {
    std::ifstream in(shard, std::ios::binary);
    const Json description = Json::parse(Content(DescriptionFile(shard)));
    std::string line;
    std::int64_t rows = -1;
    while (std::getline(in, line) && !in.eof()) {
      if (++rows > 0 || index == 1) out << line << '\n';
    }
    if (rows != description["shard_rows"].get<std::int64_t>()) {
      throw InputError(fmt::format("{}: error: has {} of {} rows: run its sweep again to finish it",
                                   shard.string(), std::max<std::int64_t>(0, rows),
                                   description["shard_rows"].get<std::int64_t>()));
    }
  }
  if (!out.flush()) {
    throw InputError(
        fmt::format("{}: error: --out: cannot write: {}", merged.string(), std::strerror(errno)));
  }
  const Json whole{{"sweep", sweep}, {"shard", {1, 1}}, {"shard_rows", sweep["rows"]}};
  WriteWhole(DescriptionFile(merged), whole.dump(1) + "\n");
}

}  // namespace fogline
