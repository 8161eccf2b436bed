// The recorder: writes every per-step message of a run, and its scenario, into an LCM event log.
// The recorder takes part in the lockstep: the world is at most kMaxAhead steps ahead of the log on
// disk. So a fast run loses no message. The log has the events in the order of the steps, and
// within a step in the order of the graph table (services/graph.h). The order of arrival does not
// matter. So the logs of equal runs differ only in the run id. A role that has been started again
// needs the messages of recorded steps. The recorder answers its requests for these messages. If
// the recorder itself is killed, another recorder continues its log.
#pragma once

#include <filesystem>

#include "services/log/event_log.h"
#include "services/log/wall_clock.h"
#include "services/recorder/asked_steps.h"
#include "services/recorder/history.h"
#include "services/runtime/node/node.h"

namespace fogline::recorder {

class RecordRule;

class Recorder final : public runtime::Work {
 public:
  /// Treatment of an existing file.
  enum class Existing { kReplace, kResume };
  /// Whether the log has the wall clock of each step. In real time the log always has the wall
  /// clock.
  enum class WallClock { kNo, kYes };

  /// With kReplace and a run id, the constructor replaces an existing file. With kReplace and no
  /// run id, the recorder replaces the file as soon as it has found a run.
  /// @throws InputError if the file cannot be written
  Recorder(runtime::Bus& bus, std::optional<std::int64_t> run_id, const std::filesystem::path& file,
           Existing existing = Existing::kReplace, WallClock wall_clock = WallClock::kNo);

  runtime::Node& node() override { return node_; }

 private:
  std::unique_ptr<runtime::FireRule> Join(const Scenario& scenario) override;
  void Compute(std::int64_t step) override;
  TimePoint Poll(TimePoint now) override;
  void OnStatusAsked(std::int64_t step) override;
  void OnAsked(std::string_view channel, runtime::StepRange steps, TimePoint now) override;
  void BeforeStatus() override;
  void OnLeave() override;

  /// Continues the log in the file. @return false if the file has no complete scenario
  bool Resume();
  /// The steps of this run in the file.
  /// @throws InputError if the run is in lockstep, and the file lacks a step that the recorder had
  ///     written (the progress of the run shows this)
  log::Remains ReadOwnRemains(const log::LogFront& front);
  /// Stores the last steps of the log as inputs. If a role computes these steps again and publishes
  /// other bytes, the recorder fails (Inputs::Keep).
  void RememberLastSteps();
  void WriteScenario();
  void Write(std::int64_t step);
  /// Notes the wall clock at which the TRUTH of a step has come.
  void NoteWallClock(const truth_t& truth);
  void WriteWallClock(std::int64_t step);
  /// Writes the STATUS, DRIVER_INPUT and TRIAL messages that came in this step or before
  /// (RecordRule::TakeEvents).
  void WriteEvents(std::int64_t step);
  /// Writes into STATUS how many bytes of the log the operating system has, and the checksum of the
  /// bytes from log_begin on.
  void TellWritten();
  void AnswerRecent(std::string_view channel, runtime::StepRange steps, TimePoint now);
  /// Answers some of the requests. @return the time of the next call
  TimePoint AnswerSome(TimePoint now);
  void AnswerStep(const AskedSteps::Asked& asked, TimePoint now);
  /// Publishes a requested message again, if the rate limiter allows it.
  void Answer(std::string_view channel, runtime::Bytes bytes, TimePoint now);

  runtime::Node node_;
  runtime::Parts& parts_ = node_.parts();
  const std::filesystem::path file_;
  const Existing existing_;
  std::optional<log::EventLogWriter> log_;
  std::optional<History> history_;
  std::int64_t final_ = -1;  // last step of the run; -1 until it is known
  std::int64_t step_us_ = 0;
  bool wall_clock_;
  std::array<wall_clock_t, runtime::kRingSteps> clocks_{};  // by slot
  std::int64_t newest_clock_ = -1;                          // the newest step that has a clock
  AskedSteps asked_;
  RecordRule* recording_ = nullptr;  // the rule in real time, otherwise nullptr
  struct Answered {
    std::int64_t step = -1;
    TimePoint at{};
  };
  std::array<std::array<Answered, runtime::kRingSteps>, kChannels.size()> answered_{};
};

}  // namespace fogline::recorder
