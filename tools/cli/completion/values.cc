#include "tools/cli/completion/values.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "services/graph.h"

namespace fogline::cli {
namespace {

/// The kind of the values of an option or argument. kKinds gives it by the name. For an option
/// or argument that is not in kKinds, NamesIn() finds the values in its check or description.
enum class Kind {
  kAssignment,  // a field of the scenario and its value, /fog/bias_m=0.3
  kPointer,     // a field or section of the scenario
  kRole,
  kPlace,  // a role and the machine where it runs, fusion=lab2
  kTransport,
  kVerb,
  kJson,
  kLog,
};

struct KindOfName {
  std::string_view name;
  Kind kind;
};

// Names of options and arguments. Each name has the same meaning in all verbs that have it.
constexpr std::array kKinds{
    KindOfName{"--set", Kind::kAssignment},
    KindOfName{"--grid", Kind::kAssignment},
    KindOfName{"--free", Kind::kAssignment},
    KindOfName{"--explain", Kind::kPointer},
    KindOfName{"--role", Kind::kRole},
    KindOfName{"--external", Kind::kRole},
    KindOfName{"--on", Kind::kPlace},
    KindOfName{"--lab", Kind::kJson},
    KindOfName{"--transport", Kind::kTransport},
    KindOfName{"VERB", Kind::kVerb},
    KindOfName{"SCENARIO", Kind::kJson},
    KindOfName{"LOG", Kind::kLog},
    KindOfName{"A", Kind::kLog},
    KindOfName{"B", Kind::kLog},
};

// The transports that have a short name.
constexpr std::array kTransports{
    std::pair{"direct", "one process, no messages"},
    std::pair{"memq", "one process, LCM in memory"},
    std::pair{"udpm", "one process for each role, multicast"},
    std::pair{"tcpq", "one process for each role, TCP"},
};

void Add(std::string_view word, std::string_view meaning, std::string_view begun,
         Completion& completion) {
  if (word.starts_with(begun))
    completion.words.push_back({std::string(word), std::string(meaning)});
}

/// The words of a list that is separated by commas or blanks, such as "world, radar".
std::vector<std::string> WordsOf(std::string text) {
  std::ranges::replace(text, ',', ' ');
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

/// The names that an option's check allows, or that its description lists; empty if neither of them
/// has names. CLI11 shows the check CLI::IsMember as "TEXT:{world,radar}".
std::vector<std::string> NamesIn(const CLI::Option& option) {
  constexpr std::string_view kList = "One of ";
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}');
  if (open < close && close != std::string::npos) {
    return WordsOf(type.substr(open + 1, close - open - 1));
  }
  const std::string& description = option.get_description();
  return description.starts_with(kList) ? WordsOf(description.substr(kList.size()))
                                        : std::vector<std::string>();
}

/// The pointer of a field as a user may type it. In the catalogue, `*` stands for all items of a
/// list. Index 0 replaces each `*`.
std::string Typed(std::string pointer) {
  std::ranges::replace(pointer, '*', '0');
  return pointer;
}

/// Adds the fields whose pointers begin with `begun` and have no "/" after this beginning. The
/// pointer of a section or of a list ends with "/": "/arb" is completed to "/arbitrator/".
/// @param end the text after the pointer of a complete field, such as "="
void AddPointers(const std::string& begun, std::string_view end, Completion& completion) {
  for (const Field& field : Catalogue()) {
    const std::string pointer = Typed(field.pointer);
    if (!pointer.starts_with(begun) ||
        pointer.find('/', std::max<std::size_t>(begun.size(), 1)) != std::string::npos) {
      continue;
    }
    const bool has_more = field.As<SectionField>() != nullptr || field.As<ListField>() != nullptr;
    completion.words.push_back(
        {pointer + (has_more ? "/" : std::string(end)), std::string(field.doc)});
  }
}

/// Adds the named values of a field. @param begun "/pointer=" and the text typed so far, which may
/// have several values, separated by commas
void AddFieldValues(const std::string& begun, Completion& completion) {
  const std::size_t equals = begun.find('=');
  const Field* field = FindField(begun.substr(0, equals));
  if (field == nullptr) return;
  const std::string before = begun.substr(0, begun.find_last_of("=,") + 1);
  const auto add = [&](std::string_view value, std::string_view meaning) {
    Add(before + std::string(value), meaning, begun, completion);
  };
  if (const auto* choice = field->As<ChoiceField>(); choice != nullptr) {
    for (std::size_t i = 0; i < choice->names.size(); ++i) {
      add(choice->names[i], i < choice->docs.size() ? choice->docs[i] : "");
    }
  } else if (field->As<bool*>() != nullptr) {
    add("true", "");
    add("false", "");
  }
}

void AddOfKind(Kind kind, const CLI::App& app, const std::string& begun, Completion& completion) {
  switch (kind) {
    case Kind::kAssignment:
      if (begun.find('=') != std::string::npos) return AddFieldValues(begun, completion);
      return AddPointers(begun, "=", completion);
    case Kind::kPointer:
      return AddPointers(begun, "", completion);
    case Kind::kRole:
      for (const RoleInfo& info : kRoles) Add(info.name, info.purpose, begun, completion);
      return;
    case Kind::kPlace:
      for (const RoleInfo& info : kRoles) {
        // The recorder always runs on the machine where the run was started.
        if (info.role == Role::kRecorder) continue;
        Add(std::string(info.name) + "=", info.purpose, begun, completion);
      }
      return;
    case Kind::kTransport:
      for (const auto& [name, meaning] : kTransports) Add(name, meaning, begun, completion);
      return;
    case Kind::kVerb:
      return AddVerbs(app, begun, completion);
    case Kind::kJson:
      completion.files = "*.json";
      return;
    case Kind::kLog:
      completion.files = "*.lcm";
      return;
  }
}

}  // namespace

Completion ValuesOf(const CLI::App& app, const CLI::Option& option, const std::string& begun) {
  Completion completion;
  const std::string name = option.get_name();
  const auto* known = std::ranges::find(kKinds, name, &KindOfName::name);
  if (known != kKinds.end()) {
    AddOfKind(known->kind, app, begun, completion);
    return completion;
  }
  const std::vector<std::string> names = NamesIn(option);
  for (const std::string& word : names) Add(word, "", begun, completion);
  if (names.empty() && option.get_type_name().starts_with("TEXT")) completion.files = "*";
  return completion;
}

void AddVerbs(const CLI::App& command, const std::string& begun, Completion& completion) {
  for (const CLI::App* verb : command.get_subcommands({})) {
    if (verb->get_group().empty()) continue;
    Add(verb->get_name(), verb->get_description(), begun, completion);
  }
}

}  // namespace fogline::cli
