#include "tools/trials/tables.h"

#include <array>
#include <ctime>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/csv.h"
#include "common/errors.h"
#include "common/text.h"
#include "services/log/input_latency.h"
#include "services/metrics/gaps/gap_rules.h"
#include "services/metrics/take_over/take_over_measures.h"
#include "tools/runner/scenario_run.h"
#include "tools/trials/questionnaires.h"

namespace fogline::trials {
namespace {

constexpr std::string_view kTrialColumns =
    "participant,trial,practice,condition,order,seed,attempt,speed,state,complete,begun,markers,"
    "log";
constexpr std::string_view kValueColumns =
    "participant,trial,practice,condition,kind,item,value,unit,time_s";

std::string NumberCell(std::int64_t value) { return std::to_string(value); }
std::string NumberCell(const std::optional<double>& value) {
  return value ? NumberText(*value) : "";
}

/// A value of a trial, for both tables.
struct Value {
  std::string_view kind;  // answer, metric, marker
  std::string item;
  std::string value;
  std::string unit;
  std::string time_s;
};

/// The items of all questionnaires as QUESTIONNAIRE.ITEM: the columns for answers.
std::vector<std::string> ItemColumns(const ExperimentPlan& plan) {
  std::vector<std::string> columns;
  for (const QuestionnaireSection& each : plan.questionnaires) {
    for (const ItemSection& item : WithItems(each).items) {
      columns.push_back(each.name + "." + item.name);
    }
  }
  return columns;
}

Value MetricValue(std::string name, std::string value, std::string_view unit) {
  return {.kind = "metric",
          .item = std::move(name),
          .value = std::move(value),
          .unit = std::string(unit),
          .time_s = ""};
}

/// Adds the number of requests to take over, and the measures of the first request.
void AddFirstRequest(const runner::LoggedRun& run, std::vector<Value>& values) {
  const auto& requests = run.result.take_overs;
  const bool are_known = run.scenario.arbitrator.take_over.mode != TakeOverMode::kRequested ||
                         metrics::AreAllTakeOversKnown(run.result.lack);
  const bool has_first = are_known && !requests.empty();
  const metrics::TakeOverMeasures first =
      has_first ? requests.front() : metrics::TakeOverMeasures{};
  const auto add = [&](std::string_view name, std::string value, std::string_view unit) {
    values.push_back(MetricValue(fmt::format("first_request_{}", name),
                                 has_first ? std::move(value) : "", unit));
  };
  values.push_back(MetricValue("requests", are_known ? NumberCell(std::ssize(requests)) : "", ""));
  add("outcome", std::string(metrics::NameOf(first.outcome)), "");
  metrics::VisitTakeOver(
      first, [&](std::string_view name, const std::optional<double>& value, std::string_view unit,
                 std::string_view) { add(name, NumberCell(value), unit); });
}

/// Adds the latency of the inputs of a person who drove.
void AddInputLatency(const std::optional<log::InputLatency>& latency, std::vector<Value>& values) {
  log::VisitLatency(
      latency.value_or(log::InputLatency{}),
      [&](std::string_view name, std::int64_t value, std::string_view unit, std::string_view) {
        values.push_back(MetricValue(fmt::format("input_latency_{}", name),
                                     latency ? NumberCell(value) : "", unit));
      });
}

bool HasBegin(const TrialStory& story) {
  return !story.facts.empty() && story.facts.front().kind == trial_t::BEGIN;
}

/// The measures of a run. A measure that is unknown, because messages are missing, has no value.
std::vector<Value> MetricsOf(const runner::LoggedRun& run) {
  std::vector<Value> values;
  metrics::VisitMetrics(run.result.measures, [&](std::string_view name, const auto& value,
                                                 std::string_view unit, std::string_view) {
    const bool is_known = metrics::IsKnown(name, value, run.result.lack);
    values.push_back(MetricValue(std::string(name), is_known ? NumberCell(value) : "", unit));
  });
  AddFirstRequest(run, values);
  AddInputLatency(run.result.input_latency, values);
  return values;
}

std::vector<Value> AnswersOf(const ExperimentPlan& plan, const TrialStory& story) {
  std::vector<Value> values;
  for (const QuestionnaireSection& each : plan.questionnaires) {
    for (const ItemSection& item : WithItems(each).items) {
      Value value{.kind = "answer",
                  .item = each.name + "." + item.name,
                  .value = "",
                  .unit = item.unit,
                  .time_s = ""};
      for (const trial_t& fact : story.facts) {
        if (fact.kind != trial_t::ANSWER || fact.questionnaire != each.name ||
            fact.item != item.name) {
          continue;
        }
        value.value = item.kind == ItemKind::kText ? fact.text : NumberText(fact.value);
      }
      values.push_back(std::move(value));
    }
  }
  return values;
}

std::vector<Value> MarkersOf(const TrialStory& story) {
  std::vector<Value> values;
  for (const trial_t& fact : story.facts) {
    if (fact.kind != trial_t::MARKER) continue;
    values.push_back(
        {.kind = "marker",
         .item = "marker",
         .value = fact.text,
         .unit = "",
         .time_s = NumberText(static_cast<double>(fact.header.utime) / kMicrosPerSecond)});
  }
  return values;
}

class TableMaker {
 public:
  TableMaker(const PlanFile& plan, const Results& results) : plan_(plan), results_(results) {
    tables_.trials = kTrialColumns;
    for (const std::string& column : ItemColumns(plan.plan)) tables_.trials += "," + column;
    for (const Value& value : MetricsOf({})) tables_.trials += "," + value.item;
    tables_.trials += "\n";
    tables_.values = fmt::format("{}\n", kValueColumns);
  }

  Tables Make() {
    for (std::int64_t participant = 1; participant <= plan_.plan.participants; ++participant) {
      const std::string order = OrderText(plan_.plan, participant);
      for (const TrialRecord& record : results_.ReadAll(participant)) {
        if (record.story.state != TrialState::kDone) ++tables_.missing;
        if (record.attempts > 0) Add(record, order);
        if (record.story.state == TrialState::kBroken) {
          tables_.faults.push_back(FaultText(record.log, record.story));
        }
      }
    }
    return std::move(tables_);
  }

 private:
  void Add(const TrialRecord& record, const std::string& order) {
    ++tables_.rows;
    const TrialStory& story = record.story;
    const std::vector<Value> answers = AnswersOf(plan_.plan, story);
    const std::vector<Value> markers = MarkersOf(story);
    const bool has_run = story.state == TrialState::kToAsk || story.state == TrialState::kDone;
    // A run that broke off has no measures, because they would describe only a part of the run.
    std::vector<Value> measures = MetricsOf({});
    for (Value& value : measures) value.value = "";
    std::string seed;
    std::string complete;
    if (has_run) {
      const runner::LoggedRun run = runner::ReadLoggedRun(record.log);
      measures = MetricsOf(run);
      seed = std::to_string(run.scenario.seed);
      complete = run.complete ? "1" : "0";
    } else if (!story.facts.empty()) {
      seed = std::to_string(story.facts.front().seed);
    }
    const std::string head =
        fmt::format("{},{},{},{}", record.trial.participant, record.trial.number,
                    record.trial.practice ? 1 : 0, ConditionOf(plan_.plan, record.trial).name);
    tables_.trials +=
        fmt::format("{},{},{},{},{},{},{},{},{},{}{}\n", head, order, seed, record.attempts,
                    has_run ? NumberText(story.speed) : "", NameOf(story.state), complete,
                    HasBegin(story) ? UtcText(story.facts.front().unix_us) : "", markers.size(),
                    CsvCell(record.log.lexically_relative(results_.folder()).string()),
                    Cells(answers, measures));
    for (const std::vector<Value>* values :
         std::initializer_list<const std::vector<Value>*>{&answers, &measures, &markers}) {
      for (const Value& value : *values) {
        if (value.value.empty() && value.kind != "marker") continue;
        tables_.values += fmt::format("{},{},{},{},{},{}\n", head, value.kind, value.item,
                                      CsvCell(value.value), CsvCell(value.unit), value.time_s);
      }
    }
  }

  /// The cells with a comma before each.
  static std::string Cells(const std::vector<Value>& answers, const std::vector<Value>& measures) {
    std::string cells;
    for (const auto* values : {&answers, &measures}) {
      for (const Value& value : *values) {
        cells += "," + CsvCell(value.value);
      }
    }
    return cells;
  }

  const PlanFile& plan_;
  const Results& results_;
  Tables tables_;
};

}  // namespace

Tables MakeTables(const PlanFile& plan, const Results& results) {
  return TableMaker(plan, results).Make();
}

bool IsTrialTable(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string first;
  std::getline(in, first);
  return first.starts_with("participant,trial,practice,condition,");
}

std::string UtcText(std::int64_t unix_us) {
  const auto seconds = static_cast<std::time_t>(unix_us / 1'000'000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), size};
}

}  // namespace fogline::trials
