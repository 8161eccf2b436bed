#include "tools/export/run_tables.h"

#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/errors.h"
#include "common/interrupt.h"
#include "common/text.h"
#include "services/log/run_log.h"
#include "services/log/undecodable.h"
#include "services/log/wall_clock.h"
#include "services/runtime/wire/wire.h"

namespace fogline::exports {
namespace {

// Every message begins with its header, so these are the first columns of every table.
constexpr std::size_t kRunId = 0;
constexpr std::size_t kStep = 1;
constexpr std::size_t kUtime = 2;

template <class M>
constexpr std::string_view NameOfTable() {
  if constexpr (std::is_same_v<M, wall_clock_t>) {
    return log::kWallClockChannel;
  } else {
    return ChannelOf<M>().name;
  }
}

/// Adds messages of type M to the table of their channel.
template <class M>
class Tabulator {
 public:
  /// @throws InputError whose text lacks the log's name; the caller adds the name
  void Add(runtime::Bytes bytes) {
    if (bytes.empty()) return;  // a run in real time may lack a message
    if (!runtime::Decode(bytes, message_)) {
      throw InputError(
          log::DoesNotDecode(fmt::format("message {} of {}", table_.messages, table_.name)));
    }
    if (table_.fields.empty()) BeginTable();
    next_ = 0;
    VisitFields(message_, [this]<class V>(std::string_view name, const V& value) {
      if constexpr (std::is_same_v<V, header_t>) {
        AddValues(fmt::format("{}.run_id", name), std::span(&value.run_id, 1));
        AddValues(fmt::format("{}.step", name), std::span(&value.step, 1));
        AddValues(fmt::format("{}.utime", name), std::span(&value.utime, 1));
      } else if constexpr (requires { value.data(); }) {
        AddValues(name, std::span(value.data(), value.size()));
      } else {
        AddValues(name, std::span(&value, 1));
      }
    });
    ++table_.messages;
  }

  /// Adds a row for a message that the log lacks. SetTimesOfGaps() sets the time of this row.
  void AddGap(std::int64_t run_id, std::int64_t step) {
    // The width of a list is not known before the first message. So a gap before this message is
    // stored in early_gaps_, and BeginTable() adds its row.
    if (table_.fields.empty()) {
      early_gaps_.emplace_back(run_id, step);
    } else {
      AddGapRow(run_id, step);
    }
  }

  /// The table. It has its columns even if it has no message.
  ChannelTable& table() {
    if (table_.fields.empty()) BeginTable();
    return table_;
  }

 private:
  /// Adds the fields of message_, and the rows of the gaps so far.
  void BeginTable() {
    DefineFields();
    for (const auto& [run_id, step] : early_gaps_) AddGapRow(run_id, step);
  }

  /// Adds the fields of message_, without values.
  void DefineFields() {
    VisitFields(message_, [this]<class V>(std::string_view name, const V& value) {
      if constexpr (std::is_same_v<V, header_t>) {
        for (const char* field : {"run_id", "step", "utime"}) {
          table_.fields.push_back(
              {.name = fmt::format("{}.{}", name, field), .values = std::vector<std::int64_t>()});
        }
      } else if constexpr (requires { value.data(); }) {
        using T = std::remove_cvref_t<decltype(*value.data())>;
        table_.fields.push_back({.name = std::string(name),
                                 .is_list = true,
                                 .width = value.size(),
                                 .values = std::vector<T>()});
      } else {
        table_.fields.push_back({.name = std::string(name), .values = std::vector<V>()});
      }
    });
  }

  void AddGapRow(std::int64_t run_id, std::int64_t step) {
    for (FieldTable& field : table_.fields) {
      std::visit(
          [&]<class T>(std::vector<T>& values) {
            const T none =
                std::numeric_limits<T>::has_quiet_NaN ? std::numeric_limits<T>::quiet_NaN() : T{};
            values.insert(values.end(), field.width, none);
          },
          field.values);
    }
    std::get<std::vector<std::int64_t>>(table_.fields[kRunId].values).back() = run_id;
    std::get<std::vector<std::int64_t>>(table_.fields[kStep].values).back() = step;
    table_.gaps.push_back(table_.messages++);
  }

  template <class T>
  void AddValues(std::string_view name, std::span<const T> values) {
    FieldTable& field = table_.fields[next_++];
    if (values.size() != field.width) {
      throw InputError(
          fmt::format("message {} of {} has {} values in {}, but the messages before have {}",
                      table_.messages, table_.name, values.size(), name, field.width));
    }
    auto& column = std::get<std::vector<T>>(field.values);
    column.insert(column.end(), values.begin(), values.end());
  }

  ChannelTable table_{.name = NameOfTable<M>()};
  M message_{};
  std::size_t next_ = 0;  // index of the message's next field
  // Run and step of the gaps before the first message.
  std::vector<std::pair<std::int64_t, std::int64_t>> early_gaps_;
};

template <class Graph>
struct TabulatorsOf;
template <class... M>
struct TabulatorsOf<const std::tuple<Channel<M>...>> {
  using Type = std::tuple<Tabulator<M>...>;
};

const std::vector<std::int64_t>& Numbers(const ChannelTable& table, std::size_t field) {
  return std::get<std::vector<std::int64_t>>(table.fields[field].values);
}

/// The simulated duration of a step, in us, computed from the log; 0 if the log has no message of a
/// step after step 0.
std::int64_t StepTimeIn(const std::vector<ChannelTable>& tables) {
  for (const ChannelTable& table : tables) {
    const std::size_t rows = table.messages;
    for (std::size_t row = 0; row < rows; ++row) {
      const std::int64_t step = Numbers(table, kStep)[row];
      if (step > 0 && !table.IsGap(row)) return Numbers(table, kUtime)[row] / step;
    }
  }
  return 0;
}

/// Gives each missing message the simulated time of its step.
void SetTimesOfGaps(RunTables& tables) {
  const std::int64_t step_us = tables.run.has_scenario
                                   ? std::llround(tables.run.scenario.step_s * kMicrosPerSecond)
                                   : StepTimeIn(tables.channels);
  for (ChannelTable& table : tables.channels) {
    auto& times = std::get<std::vector<std::int64_t>>(table.fields[kUtime].values);
    for (const std::size_t row : table.gaps) times[row] = Numbers(table, kStep)[row] * step_us;
  }
}

}  // namespace

RunTables ReadRunTables(const std::filesystem::path& log, const log::ReadOptions& options) {
  RunTables tables;
  log::RunLogReader reader(log, options);
  typename TabulatorsOf<decltype(kGraph)>::Type tabulators;
  try {
    while (const log::StepMessages* messages = reader.Next()) {
      if (WasInterrupted()) throw Interrupted("interrupted; no file was written");
      ForEachStepChannel([&]<class M>(std::size_t channel) {
        auto& tabulator = std::get<Tabulator<M>>(tabulators);
        const runtime::Bytes bytes = (*messages)[channel];
        tabulator.Add(bytes);
        if (bytes.empty() && reader.ReadsGaps()) {
          tabulator.AddGap(reader.run().run_id, reader.step());
        }
      });
    }
  } catch (const InputError& error) {
    const std::string_view what = error.what();
    if (what.starts_with(PathText(log))) throw;
    throw InputError(fmt::format("{}: error: {}", PathText(log), what));
  }
  const log::RunLog& run = reader.run();
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    if (!run.channels[channel]) return;
    tables.channels.push_back(std::move(std::get<Tabulator<M>>(tabulators).table()));
  });
  tables.run = run;
  Tabulator<wall_clock_t> clocks;
  log::ForEachWallClock(
      log, tables.run.run_id,
      [&clocks](const wall_clock_t&, runtime::Bytes bytes) { clocks.Add(bytes); });
  if (clocks.table().messages > 0) tables.channels.push_back(std::move(clocks.table()));
  constexpr int kIndent = 2;
  if (tables.run.has_scenario) {
    tables.scenario = nlohmann::ordered_json::parse(tables.run.scenario_text)
                          .dump(kIndent, ' ', /*ensure_ascii=*/true);
  }
  SetTimesOfGaps(tables);
  return tables;
}

}  // namespace fogline::exports
