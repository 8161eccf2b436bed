#include "services/log/run_log.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/loader.h"
#include "services/log/about/log_graph.h"
#include "services/log/about/log_note.h"
#include "services/log/about/log_priority.h"
#include "services/log/about/log_version.h"
#include "services/log/step_order.h"
#include "services/runtime/wire/digest.h"
#include "services/runtime/wire/message_signer.h"
#include "services/runtime/wire/scenario_parts.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::log {

/// Combines the events of a log into steps.
class RunLogReader::Assembler {
 public:
  Assembler(const std::filesystem::path& file, const ReadOptions& options)
      : file_(file), reader_(file), options_(options), has_run_(options.run_id.has_value()) {
    run_.run_id = options.run_id.value_or(0);
    run_.channels = OwnStepChannels();
  }

  const StepMessages* Next() {
    if (over_) return nullptr;
    over_ = true;  // stays true if an exception leaves this function
    const StepMessages* const step = ReadStep();
    over_ = step == nullptr;
    return step;
  }

  const RunLog& run() const { return run_; }
  std::int64_t step() const { return next_ - 1; }
  bool InTail() const { return tail_ && step() >= *tail_; }
  /// Whether the reader accepts gaps (steps that lack messages). In real time the result is false,
  /// because realtime_ counts the missing messages.
  bool ReadsGaps() const { return options_.gaps && !realtime_; }

 private:
  // In real time, a message may come in the log after messages of later steps. The later steps are
  // at most this many steps ahead.
  static constexpr std::int64_t kLongestOverdue = 64;
  // If gaps are read, at most this many steps wait for their missing messages. The number is large,
  // because a logger may miss a message and receive its repetition only after messages of much
  // later steps.
  static constexpr std::size_t kMostOpen = 4096;
  // A message whose step is more than this number of steps ahead of the next step does not belong
  // to the run.
  static constexpr std::int64_t kLongestGap = 1'000'000;

  struct Pending {
    StepMessages messages{};
    runtime::ChannelSet there;
  };

  /// The next step; nullptr at the end of the log.
  const StepMessages* ReadStep() {
    while (!Ready()) {
      const auto event = ended_ ? std::nullopt : reader_.Next();
      if (!event) {
        if (!std::exchange(ended_, true) && ReadsGaps()) tail_ = Tail();
        if (Ready()) break;
        Finish();
        return nullptr;
      }
      Take(*event);
    }
    current_ = TakeStep();
    Count(current_);
    if (runtime::Decode(current_[IndexOf<truth_t>()], truth_)) last_ = truth_.last != 0;
    return &current_;
  }

  /// Whether the next step is complete, or no further message of this step is expected.
  bool Ready() {
    if (pending_.empty()) return false;
    const auto& [step, next] = *pending_.begin();
    if (step == next_ && next.there == run_.channels) return true;
    if (realtime_) return ended_ || pending_.rbegin()->first > next_ + kLongestOverdue;
    if (!options_.gaps || !(ended_ || pending_.size() > kMostOpen)) return false;
    if (step >= kMostRunSteps || (begun_ && step > next_ + kLongestGap)) {
      astray_ += std::ssize(pending_);
      pending_.clear();
      return false;
    }
    if (!begun_) next_ = run_.gaps.first = step;
    return true;
  }

  /// Takes the messages of the next step; a step may have no messages.
  StepMessages TakeStep() {
    begun_ = true;
    const auto next = pending_.begin();
    StepMessages messages{};
    if (next->first == next_) {
      messages = next->second.messages;
      pending_.erase(next);
    }
    ++next_;
    return messages;
  }

  /// Counts a step and its gaps, and adds the step to the digest.
  void Count(const StepMessages& messages) {
    const runtime::ChannelSet lacks = run_.channels & ~ChannelsIn(messages);
    if (realtime_) realtime_->AddStep(~lacks);
    if (lacks == run_.channels && step() == first_heard_) ++first_heard_;
    if (ReadsGaps() && lacks.any()) {
      if (!InTail()) run_.gaps.Add(step(), lacks);
      if (step() == tail_) tail_lacks_ = lacks;
      return;
    }
    ++run_.steps;
    if (run_.gaps.Any()) return;
    ++first_steps_;
    for (const runtime::Bytes message : messages) {
      if (!message.empty()) digest_.Add(message);
    }
  }

  /// The first of the incomplete steps that a run leaves when it ends early; nullopt if it leaves
  /// none. There are at most kMaxAhead such steps, because the world is at most this number of
  /// steps ahead of the log.
  std::optional<std::int64_t> Tail() const {
    if (pending_.empty()) return std::nullopt;
    const auto& [newest, messages] = *pending_.rbegin();
    // If the TRUTH of the newest step has `last`, the run did not end early. So the missing
    // messages of this step are gaps.
    truth_t truth{};
    if (runtime::Decode(messages.messages[IndexOf<truth_t>()], truth) && truth.last) return {};
    auto step = pending_.rbegin();
    while (step != pending_.rend() && step->second.there != run_.channels) ++step;
    if (step == pending_.rbegin()) return {};  // all messages of the newest step are there
    const std::int64_t first = step == pending_.rend() ? next_ : step->first + 1;
    return newest < first + runtime::kMaxAhead ? std::optional(first) : std::nullopt;
  }

  void Take(const Event& event) {
    const std::size_t channel = Find(event.channel);
    if (channel == kNumChannels) return TakeAbout(event);
    if (event.data.size() < runtime::kHeaderEnd) return;
    if (channel == IndexOf<run_t>()) return TakeRun(event.data);
    if (channel == IndexOf<status_t>()) return TakeStatus(event.data);
    if (kChannels[channel].pace != Pace::kStep) return;
    if (!parts_.empty() && !run_.channels[channel]) return;
    const std::int64_t run_id = runtime::ReadInt64(event.data, runtime::kRunIdOffset);
    if (options_.gaps && parts_.empty()) ChooseRun(event.data, channel, run_id);
    const runtime::Bytes data = Payload(event.data);
    const std::int64_t step = runtime::ReadInt64(event.data, runtime::kStepOffset);
    if ((parts_.empty() && !options_.gaps) || data.empty() || run_id != run_.run_id) {
      ++foreign_;
      if (run_id != run_.run_id) others_.Add(run_id, step < 0 ? std::nullopt : std::optional(step));
      return;
    }
    if (runtime::ReadInt64(data, 0) != runtime::FingerprintOf(channel) &&
        (other_types_ || VersionOf(file_).other_types)) {
      RefuseVersion(file_);
    }
    if (step < next_ || (realtime_ && step >= steps_)) return;  // repeated, or not of the run
    Pending& pending = pending_[step];
    if (!pending.messages[channel].empty()) {
      if (conflict_.empty() && !std::ranges::equal(pending.messages[channel], data)) {
        conflict_ = fmt::format("step {} has two different {}", step, event.channel);
      }
      return;
    }
    pending.messages[channel] = data;
    pending.there.set(channel);
  }

  void Finish() {
    if (realtime_) run_.realtime = realtime_->Result();  // also if the log is refused below
    if (reader_.empty()) Refuse("the log is empty: no run has begun to write it");
    FinishScenario();
    run_.digest = run_.gaps.Any() || first_steps_ == 0 ? "" : digest_.Hex();
    const RunInLog early = others_.Forget(run_.run_id);  // the messages before RUN
    foreign_ -= early.messages;
    run_.other_runs = others_.all();
    run_.events = reader_.head();
    const std::string alteration = Alteration();
    run_.altered = !alteration.empty();
    const bool has_all = options_.has_all || (run_.seal && run_.seal->whole && !run_.altered);
    if (realtime_) run_.realtime = realtime_->Result(has_all);
    // In real time, the TRUTH message that has `last` may be missing. Then the number of steps
    // shows that the run has ended.
    if (realtime_ && (run_.steps == steps_ || run_.steps == end_)) last_ = true;
    const bool whole = pending_.empty() && !run_.gaps.Any() && !tail_;
    const bool has_end = last_ && whole && run_.has_scenario && conflict_.empty() && !run_.altered;
    run_.ended = has_end && reader_.torn().empty();
    run_.ends_torn = has_end && !reader_.torn().empty();
    run_.complete = run_.ended && (!run_.realtime || (run_.realtime->has_status &&
                                                      run_.realtime->unlogged_messages == 0 &&
                                                      run_.realtime->unlogged_channels.none()));
    LogRemarks remarks{.torn = reader_.torn(),
                       .alteration = alteration,
                       .first = realtime_ ? first_heard_ : run_.gaps.first,
                       .before_run = early.first_step,
                       .has_last = last_,
                       .next = tail_.value_or(next_),
                       .tail = tail_,
                       .tail_lacks = tail_lacks_,
                       .astray = astray_,
                       .unchecked = parts_.empty() && status_hash_.empty() && run_.has_scenario,
                       .conflict = conflict_,
                       .foreign = foreign_};
    if (!pending_.empty()) remarks.unread = Unread();
    run_.note = NoteOf(run_, remarks);
  }

  UnreadSteps Unread() const {
    const auto& [first, pending] = *pending_.begin();
    return {.first = first, .lacks = run_.channels & ~pending.there, .are_end = Tail() == next_};
  }

  /// Sets the scenario of the run. @throws InputError
  void FinishScenario() {
    if (has_run_ && options_.run_id && parts_.empty() && !begun_) RefuseRun();
    const std::string& given = options_.scenario_text;
    if (!parts_.Complete() && given.empty()) {
      run_.has_scenario = false;
      if (!options_.needs_scenario && begun_) return;
      if (VersionOf(file_).other_types) RefuseVersion(file_);
      Refuse(fmt::format("the log has no complete scenario of a run{}",
                         options_.gaps && begun_ ? "; --scenario FILE gives it" : ""));
    }
    if (parts_.Complete() && !parts_.HashHolds()) {
      Refuse("the scenario in the log does not match its hash");
    }
    const std::string known = parts_.empty() ? status_hash_ : parts_.hash();
    if (!given.empty() && !known.empty() && known != runtime::HashOf(given)) {
      Refuse(fmt::format(
          "--scenario: the log is of another scenario: its hash is {}, that of the file is {}; "
          "`fogline check --print` with the seed and the --set of the run prints it",
          EscapeControls(known), runtime::HashOf(given)));
    }
    run_.scenario_text = parts_.Complete() ? parts_.Text() : given;
    run_.scenario_hash = parts_.Complete() ? parts_.hash() : runtime::HashOf(given);
    run_.scenario = ParseLoggedScenario(run_.scenario_text, file_);
  }

  [[noreturn]] void RefuseRun() const {
    const std::string ids = others_.all().empty() ? "" : "; it has " + IdsOf(others_.all());
    Refuse(fmt::format("the log has no run {}{}", run_.run_id, ids));
  }

  [[noreturn]] void Refuse(const std::string& why) const {
    throw InputError(fmt::format("{}: error: {}", PathText(file_), why));
  }

  /// How the log differs from its seal; "" if it does not differ or has no seal.
  std::string Alteration() const {
    if (!run_.seal) return "";
    std::string why = WhyNotSealedRun(*run_.seal, digest_.Hex(), first_steps_, run_.scenario_hash);
    if (!why.empty() || (options_.compared == Compared::kRun && !run_.realtime)) return why;
    return WhyNotSealedFile(*run_.seal, reader_);
  }

  std::size_t Find(std::string_view name) {
    // The recorder writes channels in the order of the table, so the channel after the last found
    // channel is the best guess.
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      const std::size_t guess = (guess_ + i) % kNumChannels;
      if (kChannels[guess].name != name) continue;
      guess_ = guess + 1;
      return guess;
    }
    return kNumChannels;
  }

  void TakeRun(runtime::Bytes data) {
    run_t run{};
    const bool is_signed =
        runtime::LooksSigned(data) && runtime::Decode(runtime::WithoutSignature(data), run);
    if (!is_signed && !runtime::Decode(data, run)) return;
    const bool was_chosen = std::exchange(has_run_, true) && (options_.gaps || options_.run_id);
    if (!was_chosen && parts_.empty()) run_.run_id = run.header.run_id;
    if (run.header.run_id != run_.run_id) return others_.Add(run.header.run_id);
    if (parts_.empty()) is_signed_ = is_signed;
    if (parts_.empty()) other_types_ = run.type_fingerprint != TypeFingerprint();
    if (parts_.empty()) run_.channels = StepChannelsOf(run.type_fingerprint);
    const bool known = parts_.Complete();
    if (!parts_.Add(run)) ++foreign_;
    if (!known && parts_.Complete() && run.realtime != 0) ExpectRealtime(run);
  }

  /// Chooses the run of the first message, if no run is chosen. @param data of a message of a step
  void ChooseRun(runtime::Bytes data, std::size_t channel, std::int64_t run_id) {
    if (runtime::ReadInt64(data, 0) != runtime::FingerprintOf(channel)) return;
    if (!std::exchange(has_run_, true)) run_.run_id = run_id;
    if (run_id == run_.run_id && !begun_ && pending_.empty()) {
      is_signed_ = runtime::LooksSigned(data);
    }
  }

  /// Takes an event about the log itself: its seal, its graph, or the priority of the roles. Such
  /// an event is written into the file, and no process sends it as a message. A log of signed
  /// messages has no such event except the seal.
  void TakeAbout(const Event& event) {
    if (IsLogSeal(event)) return TakeSeal(event);
    if (is_signed_) return;
    if (event.channel == kLogGraphChannel) return TakeGraph(event);
    if (event.channel != kLogPriorityChannel || !realtime_) return;
    if (const auto priority = ReadPriority(event, run_.run_id)) realtime_->Add(*priority);
  }

  /// Takes the graph. The recorder writes the graph before all steps.
  void TakeGraph(const Event& event) {
    if (parts_.empty() || run_.steps > 0 || !pending_.empty()) return;
    try {
      const runtime::ChannelSet channels = ReadLogGraph(event, run_.run_id);
      if (channels.any()) run_.channels = channels;
    } catch (const InputError& error) {
      Refuse(error.what());
    }
  }

  void TakeSeal(const Event& event) {
    LogHead before = reader_.head();
    before.bytes -= static_cast<std::int64_t>(SizeInFile(event));
    --before.events;
    LogSeal seal = ReadLogSeal(event, before);
    const bool others = seal.whole && seal.says.header.run_id != run_.run_id;
    if (others) ++foreign_;
    if (!others && !run_.seal) run_.seal = std::move(seal);
  }

  void ExpectRealtime(const run_t& run) {
    const Scenario scenario = ParseLoggedScenario(parts_.Text(), file_);
    steps_ = scenario.steps;
    // A message that came before the scenario can have any step number. Steps that the scenario
    // does not have are removed.
    pending_.erase(pending_.lower_bound(steps_), pending_.end());
    realtime_.emplace(run.pace, std::llround(scenario.step_s * 1e6), scenario.steps);
  }

  void TakeStatus(runtime::Bytes event) {
    const runtime::Bytes data = Payload(event);
    status_t status{};
    const bool wanted = realtime_ || (options_.gaps && status_hash_.empty());
    if (!wanted || !runtime::Decode(data, status) || status.header.run_id != run_.run_id) return;
    if (status_hash_.empty()) status_hash_ = status.scenario_hash;
    if (!realtime_) return;
    realtime_->Add(status);
    const bool is_done = status.role == NameOf(Role::kWorld) && status.state == status_t::DONE;
    if (is_done) end_ = status.header.step + 1;
  }

  /// The payload of a message, without the signature that lcm-logger also writes. This reader
  /// cannot verify signatures. In a signed run, the result for a message without a signature is
  /// empty.
  runtime::Bytes Payload(runtime::Bytes data) const {
    if (!is_signed_) return data;
    return runtime::LooksSigned(data) &&
                   data.size() >= runtime::kHeaderEnd + runtime::kSignatureBytes
               ? runtime::WithoutSignature(data)
               : runtime::Bytes();
  }

  std::filesystem::path file_;
  EventLogReader reader_;
  const ReadOptions options_;
  runtime::Digest digest_;
  RunLog run_;
  runtime::ScenarioParts parts_;
  std::map<std::int64_t, Pending> pending_;
  StepMessages current_{};
  std::int64_t next_ = 0;             // the step after current_
  bool begun_ = false;                // whether Next() has returned a step
  std::int64_t first_heard_ = 0;      // in real time: the first step with a message
  std::int64_t first_steps_ = 0;      // complete steps before the first gap, in the digest
  std::optional<std::int64_t> tail_;  // the first step of the tail, if there is one
  runtime::ChannelSet tail_lacks_;    // the channels that this step lacks
  std::size_t guess_ = 0;
  std::int64_t foreign_ = 0;
  std::int64_t astray_ = 0;  // steps that are too far from the other steps
  OtherRuns others_;
  bool has_run_;              // whether run_.run_id is known
  std::string status_hash_;   // the scenario's hash in a role's STATUS; "" if not known
  bool is_signed_ = false;    // whether the run's messages are signed
  bool other_types_ = false;  // whether the writer's message types differ from those of this build
  std::string conflict_;      // names the first step with two different messages of one channel
  truth_t truth_{};
  bool last_ = false;
  bool over_ = false;   // no further step follows: the log has ended, or an error was thrown
  bool ended_ = false;  // the log has no further event
  std::optional<RealtimeAccumulator> realtime_;
  std::int64_t steps_ = 0;  // in real time: number of steps of the scenario
  std::int64_t end_ = -1;   // in real time: number of steps when the world was done; -1: unknown
};

RunLogReader::RunLogReader(const std::filesystem::path& file, const ReadOptions& options)
    : assembler_(std::make_unique<Assembler>(file, options)) {}
RunLogReader::~RunLogReader() = default;
const StepMessages* RunLogReader::Next() { return assembler_->Next(); }
std::int64_t RunLogReader::step() const { return assembler_->step(); }
bool RunLogReader::InTail() const { return assembler_->InTail(); }
bool RunLogReader::ReadsGaps() const { return assembler_->ReadsGaps(); }
const RunLog& RunLogReader::run() const { return assembler_->run(); }

}  // namespace fogline::log
