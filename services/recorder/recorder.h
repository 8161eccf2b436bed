// The recorder: writes every per-step message of a run, and its scenario, into an LCM event log. It
// takes part in the lockstep: the world runs only a few steps ahead of what is on disk, so nothing
// is lost however fast the run is. Events stand in the order of step and graph table, whatever the
// order of arrival, so equal runs have equal logs but for the run id. What it has written it also
// hands out again, to roles that have been started again. When it is killed itself, another one
// goes on where the log ends.
#pragma once

#include <filesystem>

#include "services/recorder/asked_steps.h"
#include "services/recorder/event_log.h"
#include "services/recorder/history.h"
#include "services/runtime/node.h"

namespace fogline {

class RecordRule;

class Recorder final : public Node {
 public:
  /// What becomes of a file that exists.
  enum class Existing { kReplace, kResume };

  /// With a run id an existing file is replaced at once, without one when a run has been found.
  /// @throws InputError if the file cannot be written
  Recorder(Bus& bus, std::optional<std::int64_t> run_id, const std::filesystem::path& file,
           Existing existing = Existing::kReplace);

 private:
  class AnsweringRule;

  void Configure(const Scenario& scenario) override;
  std::unique_ptr<FireRule> MakeRule(const Scenario& scenario) override;
  RefusalCounter Wrong(std::size_t input, Arrival& arrival) override;
  RefusalCounter Accept(std::size_t input, std::int64_t step, Arrival& arrival) override;
  void Compute(std::int64_t step) override;
  void OnStatusAsked(std::int64_t step, TimePoint now) override;
  void OnAsked(std::string_view channel, StepRange steps, TimePoint now) override;
  std::string Contradiction(std::int64_t step, const ChannelInfo& channel) const override;
  void BeforeStatus() override;
  void OnLeave() override;

  /// Goes on with what is in the file; false if that is nothing.
  bool Resume();
  /// What the file has of this run. @throws InputError if that is less than what was acknowledged
  Remains ReadOwnRemains(const LogFront& front);
  /// Has the last steps of the log come in again: who computes them again must come to the same.
  void RememberLastSteps();
  void WriteScenario();
  void Write(std::int64_t step);
  void WriteStatus(std::int64_t step);
  /// Puts into STATUS how much of the log the operating system has, and its checksum.
  void TellWritten();
  void AnswerRecent(std::string_view channel, StepRange steps, TimePoint now);
  /// Hands out some of what was asked for. @return when to go on with it
  TimePoint AnswerSome(TimePoint now);
  void AnswerStep(const AskedSteps::Asked& asked, TimePoint now);

  const std::filesystem::path file_;
  const Existing existing_;
  std::optional<EventLogWriter> log_;
  std::optional<History> history_;
  std::int64_t first_ = 0;   // step that it records first; those before it were in the log
  std::int64_t final_ = -1;  // step after which the run ends, once known
  std::int64_t step_us_ = 0;
  AskedSteps asked_;
  RecordRule* recording_ = nullptr;  // the rule, in real time
  struct Answered {
    std::int64_t step = -1;
    TimePoint at{};
  };
  std::array<std::array<Answered, kRingSteps>, kChannels.size()> answered_{};
};

}  // namespace fogline
