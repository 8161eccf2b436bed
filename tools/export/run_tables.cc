#include "tools/export/run_tables.h"

#include <span>
#include <tuple>
#include <type_traits>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/errors.h"
#include "common/interrupt.h"
#include "common/text.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/wire.h"

namespace fogline::exports {
namespace {

/// Adds messages of type M to the table of their channel.
template <class M>
class Tabulator {
 public:
  /// @throws InputError whose text lacks the log's name; the caller adds the name
  void Add(runtime::Bytes bytes) {
    if (bytes.empty()) return;  // a run in real time may lack a message
    if (!runtime::Decode(bytes, message_)) {
      throw InputError(
          fmt::format("message {} of {} does not decode: was it recorded with other "
                      "message types?",
                      table_.messages, table_.name));
    }
    next_ = 0;
    VisitFields(message_, [this]<class V>(std::string_view name, const V& value) {
      if constexpr (std::is_same_v<V, header_t>) {
        AddValues(fmt::format("{}.run_id", name), false, std::span(&value.run_id, 1));
        AddValues(fmt::format("{}.step", name), false, std::span(&value.step, 1));
        AddValues(fmt::format("{}.utime", name), false, std::span(&value.utime, 1));
      } else if constexpr (requires { value.data(); }) {
        AddValues(std::string(name), true, std::span(value.data(), value.size()));
      } else {
        AddValues(std::string(name), false, std::span(&value, 1));
      }
    });
    ++table_.messages;
  }

  ChannelTable& table() { return table_; }

 private:
  template <class T>
  void AddValues(const std::string& name, bool is_list, std::span<const T> values) {
    if (next_ == table_.fields.size()) {
      table_.fields.push_back(
          {.name = name, .is_list = is_list, .width = values.size(), .values = std::vector<T>()});
    }
    FieldTable& field = table_.fields[next_++];
    if (values.size() != field.width) {
      throw InputError(
          fmt::format("message {} of {} has {} values in {}, but the messages before have {}",
                      table_.messages, table_.name, values.size(), name, field.width));
    }
    auto& column = std::get<std::vector<T>>(field.values);
    column.insert(column.end(), values.begin(), values.end());
  }

  ChannelTable table_{.name = ChannelOf<M>().name};
  M message_{};
  std::size_t next_ = 0;  // index of the message's next field
};

template <class Graph>
struct TabulatorsOf;
template <class... M>
struct TabulatorsOf<const std::tuple<Channel<M>...>> {
  using Type = std::tuple<Tabulator<M>...>;
};

}  // namespace

RunTables ReadRunTables(const std::filesystem::path& log) {
  RunTables tables;
  log::RunLogReader reader(log);
  typename TabulatorsOf<decltype(kGraph)>::Type tabulators;
  try {
    while (const log::StepMessages* messages = reader.Next()) {
      if (WasInterrupted()) throw Interrupted("interrupted; no file was written");
      ForEachStepChannel([&]<class M>(std::size_t channel) {
        std::get<Tabulator<M>>(tabulators).Add((*messages)[channel]);
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
  constexpr int kIndent = 2;
  tables.scenario =
      nlohmann::ordered_json::parse(run.scenario_text).dump(kIndent, ' ', /*ensure_ascii=*/true);
  tables.steps = run.steps;
  tables.complete = run.complete;
  tables.note = run.note;
  return tables;
}

}  // namespace fogline::exports
