#include "tools/trials/session.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/process/console.h"
#include "common/text.h"
#include "services/log/log_guard.h"
#include "tools/drive/seat.h"

namespace fogline::trials {
namespace {

class Session {
 public:
  Session(const PlanFile& plan, const Results& results, SessionOptions options, Desk& desk)
      : plan_(plan),
        results_(results),
        options_(std::move(options)),
        desk_(desk),
        key_(runtime::KeyOf(options_.run.traffic)) {}

  SessionOutcome Run() {
    const std::vector<Trial> schedule = ScheduleOf(plan_.plan, options_.participant);
    double pause_s = 0;
    for (const Trial& trial : schedule) {
      TrialRecord record = results_.Read(trial);
      if (record.NeedsRun()) {
        Drive(trial, record, pause_s);
      } else if (record.story.state == TrialState::kToAsk) {
        ++outcome_.asked;
      }
      if (record.story.state != TrialState::kDone) AskAfter(record);
      pause_s = options_.breaks ? BreakAfter(plan_.plan, trial) : 0;
    }
    desk_.Finish();
    return outcome_;
  }

 private:
  /// The values that all facts of a trial share.
  trial_t BaseOf(const Trial& trial, std::int64_t attempt, std::int64_t seed) const {
    trial_t base{};
    base.experiment = plan_.plan.title;
    base.experiment_hash = plan_.hash;
    base.participant = static_cast<std::int32_t>(trial.participant);
    base.trial = static_cast<std::int32_t>(trial.number);
    base.practice = trial.practice ? 1 : 0;
    base.attempt = static_cast<std::int32_t>(attempt);
    base.condition = ConditionOf(plan_.plan, trial).name;
    base.seed = seed;
    return base;
  }

  /// The facts that the desk shows about a trial.
  Next NextOf(const Trial& trial, std::int64_t seed) const {
    const auto& all = trial.practice ? plan_.plan.practice : plan_.plan.conditions;
    return {
        .trial = trial,
        .of = std::ssize(all),
        .for_experimenter = fmt::format("{}, seed {}", ConditionOf(plan_.plan, trial).name, seed)};
  }

  /// Makes a run of the trial, and reads its log into the record.
  void Drive(const Trial& trial, TrialRecord& record, double pause_s) {
    const ConditionSection& condition = ConditionOf(plan_.plan, trial);
    std::vector<std::string> overrides = options_.overrides;
    if (trial.seed >= 0) overrides.push_back(fmt::format("/seed={}", trial.seed));
    const Scenario scenario = LoadCondition(plan_, condition, overrides);
    Next next = NextOf(trial, scenario.seed);
    next.not_before_s = pause_s;
    next.seat = scenario.person.drives && !options_.pedals;
    desk_.WaitForBegin(next);
    const std::int64_t attempt = record.attempts + 1;
    const std::filesystem::path path = results_.LogOf(trial, attempt);
    auto pedals = options_.pedals ? options_.pedals(scenario.person) : nullptr;
    std::vector<trial_t> facts =
        RunLogged(scenario, path, BaseOf(trial, attempt, scenario.seed), std::move(pedals));
    ++outcome_.runs;
    record = {.trial = trial, .attempts = attempt, .log = path, .story = ReadComplete(path)};
    // The network may have lost facts of the run. AddFacts() adds the facts that the log lacks.
    AddFacts(path, record.story, facts, key());
    record.story = ReadComplete(path);
  }

  /// @throws std::runtime_error if the log has no complete run
  static TrialStory ReadComplete(const std::filesystem::path& log) {
    TrialStory story = ReadStory(log);
    if (story.state != TrialState::kBroken) return story;
    throw std::runtime_error(FaultText(log, story));
  }

  std::vector<trial_t> RunLogged(const Scenario& scenario, const std::filesystem::path& path,
                                 const trial_t& base, std::unique_ptr<drive::PedalSource> pedals) {
    log::LogGuard log(path);
    std::optional<Speaker> speaker;
    std::optional<drive::Seat> seat;
    runner::RunOptions run = options_.run;
    run.log = log.path();
    run.realtime = true;
    run.pace = options_.speed;
    run.on_network = [&](std::int64_t run_id, const std::string& url) {
      desk_.RunOpens(run_id, url);
    };
    run.on_run = [&](std::int64_t run_id, const std::string& url) {
      speaker.emplace(url, run_id, run.traffic, base);
      if (pedals) seat.emplace(url, run_id, run.traffic, std::move(pedals));
      desk_.RunBegins(*speaker);
    };
    run.on_logged_step = [&] {
      log.RemoveOlder();
      desk_.RunGoesOn();
    };
    try {
      runner::RunScenario(scenario, run);
    } catch (...) {
      desk_.RunEnded();
      throw;
    }
    desk_.RunEnded();
    return speaker ? speaker->End() : std::vector<trial_t>();
  }

  /// Asks the questions that have no answer yet, and ends the trial.
  void AskAfter(TrialRecord& record) {
    const std::int64_t seed = record.story.scenario.value().seed;
    trial_t base = BaseOf(record.trial, record.attempts, seed);
    base.header = {.run_id = record.story.run_id,
                   .step = record.story.steps - 1,
                   .utime = record.story.last_utime};
    for (const QuestionnaireSection& questionnaire : QuestionsAfter(plan_.plan, record.trial)) {
      if (IsAnswered(record.story, questionnaire)) continue;
      const std::vector<Answer> answers = desk_.Ask(NextOf(record.trial, seed), questionnaire);
      std::vector<trial_t> facts;
      for (std::size_t i = 0; i < answers.size(); ++i) {
        trial_t fact = base;
        fact.kind = trial_t::ANSWER;
        fact.questionnaire = questionnaire.name;
        fact.item = questionnaire.items[i].name;
        fact.unit = questionnaire.items[i].unit;
        fact.value = answers[i].value;
        fact.text = answers[i].text;
        facts.push_back(std::move(fact));
      }
      Add(record, std::move(facts));
    }
    base.kind = trial_t::END;
    Add(record, {base});
  }

  static bool IsAnswered(const TrialStory& story, const QuestionnaireSection& questionnaire) {
    return std::ranges::any_of(story.facts, [&](const trial_t& fact) {
      return fact.kind == trial_t::ANSWER && fact.questionnaire == questionnaire.name;
    });
  }

  /// Adds facts after the last fact of the log. Even after a crash, the log has all of these facts
  /// or none of them.
  void Add(TrialRecord& record, std::vector<trial_t> facts) const {
    const auto& known = record.story.facts;
    std::int64_t next = known.empty() ? 0 : known.back().sequence + 1;
    for (trial_t& fact : facts) {
      fact.sequence = next++;
      fact.unix_us = UnixMicros();
    }
    AddFacts(record.log, record.story, facts, key());
    record.story = ReadComplete(record.log);
  }

  const runtime::SigningKey* key() const { return key_ ? &*key_ : nullptr; }

  const PlanFile& plan_;
  const Results& results_;
  SessionOptions options_;
  Desk& desk_;
  std::optional<runtime::SigningKey> key_;
  SessionOutcome outcome_;
};

}  // namespace

SessionOutcome RunSession(const PlanFile& plan, const Results& results, SessionOptions options,
                          Desk& desk) {
  return Session(plan, results, std::move(options), desk).Run();
}

}  // namespace fogline::trials
