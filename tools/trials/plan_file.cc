#include "tools/trials/plan_file.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/file.h"
#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "scenario/io/reader.h"
#include "services/runtime/wire/digest.h"
#include "services/runtime/wire/trial.h"
#include "tools/runner/scenario_run.h"

namespace fogline::trials {
namespace {

constexpr std::string_view kAllowed = "fogline experiment check --schema";
// Largest length of a name. Names become parts of the names of files and columns. The value is our
// choice; file systems allow 255 bytes. Each character of a name is one byte.
constexpr std::size_t kMostNameCharacters = 40;
static_assert(kMostNameCharacters <= runtime::kMostTrialNameBytes);

/// Checks the rules that the checks of single fields do not cover.
class PlanCheck {
 public:
  PlanCheck(const JsonValue& root, DiagnosticList& mistakes) : root_(root), mistakes_(mistakes) {}

  void Check(const ExperimentPlan& plan) {
    CheckFitsLog("/title", plan.title);
    CheckConditions("/conditions", plan.conditions);
    CheckConditions("/practice", plan.practice);
    if (plan.conditions.empty()) Add("/conditions", "needed", "an experiment needs a condition");
    CheckBreaks(plan);
    std::set<std::string> names;
    for (std::size_t i = 0; i < plan.questionnaires.size(); ++i) {
      const std::string pointer = fmt::format("/questionnaires/{}", i);
      CheckName(pointer + "/name", plan.questionnaires[i].name, names);
      CheckItems(pointer, plan.questionnaires[i]);
    }
  }

 private:
  void Add(const std::string& pointer, std::string_view rule, std::string message) {
    mistakes_.Add(FindPlace(root_, pointer), pointer, rule, std::move(message));
  }

  /// Checks the length of a text that is in every TRIAL message (trial_t) of a trial, or in every
  /// TRIAL message with an answer. Names have a smaller limit (CheckName()).
  void CheckFitsLog(const std::string& pointer, const std::string& text) {
    if (text.size() <= runtime::kMostTrialNameBytes) return;
    Add(pointer, "text",
        fmt::format("{} has {} bytes; at most {} are allowed, because it is in the log of each "
                    "trial",
                    QuoteShort(text), text.size(), runtime::kMostTrialNameBytes));
  }

  void CheckName(const std::string& pointer, const std::string& name,
                 std::set<std::string>& others) {
    constexpr std::string_view kNameCharacters = "abcdefghijklmnopqrstuvwxyz0123456789-_";
    if (name.empty()) {
      Add(pointer, "needed", "a name is needed");
    } else if (name.find_first_not_of(kNameCharacters) != std::string::npos ||
               name.size() > kMostNameCharacters) {
      Add(pointer, "text",
          fmt::format("{} is no name: allowed are a to z, 0 to 9, - and _, and {} "
                      "characters at most",
                      QuoteShort(name), kMostNameCharacters));
    } else if (!others.insert(name).second) {
      Add(pointer, "duplicate", fmt::format("two entries have the name {}", QuoteShort(name)));
    }
  }

  void CheckConditions(const std::string& list, const std::vector<ConditionSection>& conditions) {
    std::set<std::string> names;
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const std::string pointer = fmt::format("{}/{}", list, i);
      CheckName(pointer + "/name", conditions[i].name, names);
      if (conditions[i].scenario.empty()) {
        Add(pointer + "/scenario", "needed", "a scenario file is needed");
      }
    }
  }

  void CheckBreaks(const ExperimentPlan& plan) {
    const auto trials = static_cast<std::int64_t>(plan.conditions.size());
    std::set<std::int64_t> others;
    for (std::size_t i = 0; i < plan.breaks.size(); ++i) {
      const std::string pointer = fmt::format("/breaks/{}/after_trial", i);
      const std::int64_t trial = plan.breaks[i].after_trial;
      if (trial >= trials) {
        Add(pointer, "range",
            fmt::format("no trial comes after trial {}: there are {} conditions", trial, trials));
      } else if (!others.insert(trial).second) {
        Add(pointer, "duplicate", fmt::format("two breaks come after trial {}", trial));
      }
    }
  }

  void CheckItems(const std::string& pointer, const QuestionnaireSection& questionnaire) {
    const bool is_own = questionnaire.kind == QuestionnaireKind::kOwn;
    if (is_own && questionnaire.items.empty()) {
      Add(pointer + "/items", "needed", "kind \"own\" needs items");
    }
    if (!is_own && !questionnaire.items.empty()) {
      Add(pointer + "/items", "needed", "only kind \"own\" has items");
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < questionnaire.items.size(); ++i) {
      const std::string at = fmt::format("{}/items/{}", pointer, i);
      const ItemSection& item = questionnaire.items[i];
      CheckName(at + "/name", item.name, names);
      if (item.text.empty()) Add(at + "/text", "needed", "a question is needed");
      CheckFitsLog(at + "/unit", item.unit);
      if (item.kind == ItemKind::kScale) CheckScale(at, item);
    }
  }

  void CheckScale(const std::string& at, const ItemSection& item) {
    if (item.min >= item.max) {
      return Add(
          at + "/max", "range",
          fmt::format("{} is not above min, {}", NumberText(item.max), NumberText(item.min)));
    }
    const double steps = (item.max - item.min) / item.step;
    constexpr double kMostSteps = 1000;  // our choice: a screen cannot show more steps separately
    constexpr double kRounding = 1e-9;   // share of kMostSteps, because 0.1 is not exact in binary
    if (steps > kMostSteps || std::abs(steps - std::round(steps)) > kRounding * kMostSteps) {
      Add(at + "/step", "range",
          fmt::format("{} does not divide the scale from {} to {} into 1 to {} equal steps",
                      NumberText(item.step), NumberText(item.min), NumberText(item.max),
                      kMostSteps));
    }
  }

  const JsonValue& root_;
  DiagnosticList& mistakes_;
};

/// The scenario of a condition, with the changes of the condition and then the changes in `more`.
/// @throws ScenarioError
Scenario LoadChanged(const PlanFile& file, const ConditionSection& condition,
                     const std::vector<std::string>& more) {
  std::vector<std::string> overrides = condition.set;
  overrides.insert(overrides.end(), more.begin(), more.end());
  const std::filesystem::path path = file.file.parent_path() / condition.scenario;
  Scenario scenario = LoadScenario(path, overrides);
  runner::CheckPossible(scenario, path);
  return scenario;
}

/// Checks the scenarios of all conditions. A mistake is reported at the change that causes it, or
/// else at the name of the scenario's file. If several conditions have this file, the mistake is
/// reported at the first of them.
class ScenarioCheck {
 public:
  ScenarioCheck(const PlanFile& file, const JsonValue& root, DiagnosticList& mistakes)
      : file_(file), root_(root), mistakes_(mistakes) {}

  void Check(const std::string& list, const std::vector<ConditionSection>& conditions) {
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      try {
        const Scenario scenario = LoadChanged(file_, conditions[i], {});
        CheckSpeed(conditions[i].name, scenario);
      } catch (const ScenarioError& error) {
        for (const Diagnostic& mistake : error.diagnostics()) {
          Add(fmt::format("{}/{}", list, i), mistake);
        }
      }
    }
  }

  /// The command that prints the allowed content for the place of the first mistake.
  const std::string& allowed() const { return allowed_; }

 private:
  void CheckSpeed(const std::string& condition, const Scenario& scenario) {
    const double speed = file_.plan.speed;
    const std::string why = WhyNotAt(speed, scenario);
    if (why.empty()) return;
    Keep("/speed", "range",
         fmt::format("{}: in condition {}: {}", NumberText(speed), Quote(condition), why),
         std::string(kAllowed));
  }

  void Add(const std::string& condition, const Diagnostic& mistake) {
    const bool is_change = mistake.override_number > 0;
    std::string what = is_change ? "" : PathText(mistake.file) + ": ";
    if (mistake.line > 0)
      what = fmt::format("{}:{}:{}: ", PathText(mistake.file), mistake.line, mistake.column);
    if (!mistake.pointer.empty()) what += Shown(mistake.pointer) + ": ";
    const std::string pointer =
        is_change ? fmt::format("{}/set/{}", condition, mistake.override_number - 1)
                  : condition + "/scenario";
    what += mistake.message;
    // A mistake in the scenario file itself does not depend on the changes of a condition, so it is
    // reported only once. A mistake of the rule "impossible" depends on these changes, too, so it
    // is reported for each condition.
    const bool is_of_file = !is_change && mistake.rule != "impossible";
    if (is_of_file && !in_files_.insert(what).second) return;
    Keep(pointer, mistake.rule, std::move(what),
         mistake.pointer.empty()
             ? std::string(kAllowed)
             : "fogline check --explain " + NearestKnownPointer(mistake.pointer));
  }

  /// @param allowed the command that prints the allowed content for the place of this mistake
  void Keep(const std::string& pointer, std::string_view rule, std::string what,
            std::string allowed) {
    const Place place = FindPlace(root_, pointer);
    if (place.offset < first_) {
      first_ = place.offset;
      allowed_ = std::move(allowed);
    }
    mistakes_.Add(place, pointer, rule, std::move(what));
  }

  const PlanFile& file_;
  const JsonValue& root_;
  DiagnosticList& mistakes_;
  std::set<std::string> in_files_;  // the mistakes of scenario files, each with its place
  std::uint32_t first_ = std::numeric_limits<std::uint32_t>::max();  // place of the first mistake
  std::string allowed_{kAllowed};
};

/// @throws ScenarioError if a condition has no scenario that can run
void CheckScenarios(const PlanFile& file) {
  DiagnosticList mistakes;
  const JsonValue root = ParseJson(file.text, 0, mistakes).value();
  ScenarioCheck check(file, root, mistakes);
  check.Check("/conditions", file.plan.conditions);
  check.Check("/practice", file.plan.practice);
  if (!mistakes.empty()) {
    mistakes.Throw({{.name = file.file.string(), .text = file.text}}, check.allowed());
  }
}

}  // namespace

std::string WhyNotAt(double speed, const Scenario& scenario) {
  if (scenario.person.drives && speed != 1) return "a person drives at speed 1";
  return runner::WhyTooFast(scenario, speed);
}

ExperimentPlan ParsePlan(std::string_view text, std::string_view name) {
  const std::vector<Source> sources{{.name = std::string(name), .text = text}};
  DiagnosticList mistakes;
  const std::optional<JsonValue> root = ParseJson(text, 0, mistakes);
  if (!root) mistakes.Throw(sources, kAllowed);
  ExperimentPlan plan = ReadExperiment(*root, mistakes);
  if (mistakes.empty()) PlanCheck(*root, mistakes).Check(plan);
  if (!mistakes.empty()) mistakes.Throw(sources, kAllowed);
  return plan;
}

PlanFile LoadPlan(const std::filesystem::path& file) {
  FileText read = ReadFile(file, kMaxFileBytes, ".json");
  if (!read.error.empty()) ThrowUnreadable(file.string(), read.error);
  PlanFile loaded{.file = file, .text = std::move(read.text), .hash = "", .plan = {}};
  loaded.hash = runtime::HashOf(loaded.text);
  loaded.plan = ParsePlan(loaded.text, file.string());
  CheckScenarios(loaded);
  return loaded;
}

Scenario LoadCondition(const PlanFile& file, const ConditionSection& condition,
                       const std::vector<std::string>& more) {
  try {
    return LoadChanged(file, condition, more);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: error: condition {}: {}", PathText(file.file),
                                 Quote(condition.name), error.what()));
  }
}

}  // namespace fogline::trials
