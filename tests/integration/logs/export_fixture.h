// A log to export, and every number in it.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "services/log/run_log.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"

namespace fogline::test {

/// Calls visit(name, values, is_list) for every field of a message. Fields of the header have
/// dotted names.
template <class M, class Visit>
void ForEachField(const M& message, const Visit& visit) {
  VisitFields(message, [&]<class V>(std::string_view name, const V& value) {
    if constexpr (std::is_same_v<V, header_t>) {
      VisitFields(value, [&](std::string_view inner, const auto& number) {
        visit(fmt::format("{}.{}", name, inner), std::span(&number, 1), false);
      });
    } else if constexpr (requires { value.data(); }) {
      visit(std::string(name), std::span(value.data(), value.size()), true);
    } else {
      visit(std::string(name), std::span(&value, 1), false);
    }
  });
}

/// Calls visit(message) for every message of a step.
template <class Visit>
void ForEachMessage(const log::StepMessages& messages, const Visit& visit) {
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    M message{};
    ASSERT_TRUE(runtime::Decode(messages[channel], message));
    visit(message);
  });
}

/// The values of one field of a channel in a log. The tests compare MAT-files with these values.
struct LoggedField {
  std::string type;
  std::vector<std::string> rows;  // the bytes of the field in each message
  std::size_t size = 0;           // bytes of one number
  std::size_t columns() const { return rows.front().size() / size; }
  /// The bytes in the order of a MAT-file: column by column.
  std::string ByColumns() const {
    std::string bytes;
    for (std::size_t i = 0; i < columns(); ++i) {
      for (const std::string& row : rows) bytes += row.substr(i * size, size);
    }
    return bytes;
  }
};

/// The fields of every channel, by names such as "TRUTH.header.step".
inline std::map<std::string, LoggedField> FieldsOf(const std::string& log) {
  std::map<std::string, LoggedField> fields;
  log::RunLogReader reader(log);
  while (const log::StepMessages* messages = reader.Next()) {
    ForEachMessage(*messages, [&]<class M>(const M& message) {
      ForEachField(message, [&]<class T>(const std::string& name, std::span<const T> values, bool) {
        LoggedField& field = fields[fmt::format("{}.{}", ChannelOf<M>().name, name)];
        field.size = sizeof(T);
        field.type = std::is_same_v<T, double> ? "double" : fmt::format("int{}", 8 * sizeof(T));
        field.rows.emplace_back(reinterpret_cast<const char*>(values.data()), values.size_bytes());
      });
    });
  }
  return fields;
}

class ExportTest : public testing::Test {
 protected:
  /// A run with fog and two following cars.
  ExportTest() {
    const Outcome run =
        RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                    "--quiet", "--log", log_, "--set", "/steps=230", "--set", "/followers/count=2",
                    "--set", "/title=\"F\u00f6hn\""});
    EXPECT_EQ(run.code, 0) << run.err;
  }

  Outcome Export(const std::vector<std::string>& more) const {
    std::vector<std::string> command{Program("fogline"), "export", log_};
    command.insert(command.end(), more.begin(), more.end());
    return RunCommand(command);
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string out_ = folder_.File("csv");
  const std::string mat_ = folder_.File("run.mat");
};

}  // namespace fogline::test
