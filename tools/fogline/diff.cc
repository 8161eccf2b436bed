// fogline diff: the first step and field in which two runs differ.
#include <memory>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "services/recorder/run_log.h"
#include "tools/fogline/arguments.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

/// A field of a message as "name[index]" and its value in the shortest exact form.
struct Field {
  std::string name;
  std::string value;
};

template <class M>
std::vector<Field> FieldsOf(const M& message) {
  std::vector<Field> fields;
  VisitFields(message, [&fields]<class V>(std::string_view name, const V& value) {
    if constexpr (std::is_same_v<V, header_t>) {
      fields.push_back({"header.step", std::to_string(value.step)});
      fields.push_back({"header.utime", std::to_string(value.utime)});
    } else if constexpr (requires {
                           value.size();
                           value[0];
                         } &&
                         !std::is_same_v<V, std::string>) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        fields.push_back({fmt::format("{}[{}]", name, i), fmt::format("{}", value[i])});
      }
    } else if constexpr (std::is_same_v<V, std::int8_t>) {
      fields.push_back({std::string(name), std::to_string(value)});
    } else {
      fields.push_back({std::string(name), fmt::format("{}", value)});
    }
  });
  return fields;
}

struct Difference {
  std::int64_t step = 0;
  std::string channel;
  std::string field;
  std::string a;
  std::string b;
};

/// Bytes of a message without the run id: what the digest looks at. In real time there may be none.
bool SameRunAside(Bytes a, Bytes b) {
  if (a.empty() || b.empty()) return a.empty() == b.empty();
  return std::ranges::equal(a.first(kRunIdOffset), b.first(kRunIdOffset)) &&
         std::ranges::equal(a.subspan(kStepOffset), b.subspan(kStepOffset));
}

template <class M>
Difference FirstField(std::int64_t step, Bytes a, Bytes b) {
  Difference difference{.step = step, .channel = std::string(ChannelOf<M>().name)};
  if (a.empty() || b.empty()) {
    difference.field = "(message)";
    difference.a = a.empty() ? "none" : "there";
    difference.b = b.empty() ? "none" : "there";
    return difference;
  }
  M message_a{};
  M message_b{};
  if (!Decode(a, message_a) || !Decode(b, message_b)) {
    return difference.field = "(does not decode)", difference;
  }
  const std::vector<Field> fields_a = FieldsOf(message_a);
  const std::vector<Field> fields_b = FieldsOf(message_b);
  for (std::size_t i = 0; i < std::min(fields_a.size(), fields_b.size()); ++i) {
    if (fields_a[i].name == fields_b[i].name && fields_a[i].value == fields_b[i].value) continue;
    difference.field = fields_a[i].name;
    difference.a = fields_a[i].value;
    difference.b = fields_b[i].value;
    return difference;
  }
  return difference.field = "(number of values)", difference;
}

std::optional<Difference> FirstDifference(std::int64_t step, const StepMessages& a,
                                          const StepMessages& b) {
  std::optional<Difference> first;
  ForEachStepChannel([&]<class M>(std::size_t i) {
    if (!first && !SameRunAside(a[i], b[i])) first = FirstField<M>(step, a[i], b[i]);
  });
  return first;
}

struct DiffArguments {
  std::filesystem::path a;
  std::filesystem::path b;
  bool json = false;
};

int RunDiff(const DiffArguments& arguments) {
  RunLogReader reader_a(arguments.a);
  RunLogReader reader_b(arguments.b);
  std::optional<Difference> difference;
  std::int64_t step = 0;
  while (true) {
    const StepMessages* a = reader_a.Next();
    const StepMessages* b = reader_b.Next();
    if (a == nullptr && b == nullptr) break;
    if (a == nullptr || b == nullptr) {
      difference = {.step = step,
                    .channel = "(run)",
                    .field = "(step)",
                    .a = a == nullptr ? "none" : "there",
                    .b = b == nullptr ? "none" : "there"};
      break;
    }
    if ((difference = FirstDifference(step, *a, *b))) break;
    ++step;
  }
  if (arguments.json) {
    nlohmann::ordered_json json{{"equal", !difference}};
    if (difference) {
      json["step"] = difference->step;
      json["channel"] = difference->channel;
      json["field"] = difference->field;
      json["a"] = difference->a;
      json["b"] = difference->b;
    } else {
      json["steps"] = step;
    }
    PrintJson(json.dump(2));
  } else if (difference) {
    fmt::print("step {}: {} {}: {} in {}, {} in {}\n", difference->step, difference->channel,
               difference->field, difference->a, arguments.a.string(), difference->b,
               arguments.b.string());
  } else {
    fmt::print("equal: {} steps\n", step);
  }
  for (const RunLogReader* reader : {&reader_a, &reader_b}) {
    if (!difference && !reader->run().note.empty()) {
      fmt::print(stderr, "{}: {}\n", (reader == &reader_a ? arguments.a : arguments.b).string(),
                 reader->run().note);
    }
  }
  const bool complete = difference || (reader_a.run().complete && reader_b.run().complete);
  return difference || !complete ? kCheckFailed : kDone;
}

}  // namespace

void AddDiff(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("diff", "Name the first step and field in which two logs differ");
  const auto arguments = std::make_shared<DiffArguments>();
  verb->add_option("A", arguments->a, "Event log")->required();
  verb->add_option("B", arguments->b, "Event log")->required();
  verb->add_flag("--json", arguments->json, "Print as JSON");
  verb->footer(
      "Exit code 0 when the runs are equal, 1 when they differ or are not complete.\n\n"
      "Example:\n  fogline diff logs/paper-1.lcm logs/paper-2.lcm");
  verb->callback([&action, arguments] { action = [arguments] { return RunDiff(*arguments); }; });
}

}  // namespace fogline
