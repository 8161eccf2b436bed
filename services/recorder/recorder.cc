#include "services/recorder/recorder.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/log/about/log_graph.h"
#include "services/recorder/record_rule.h"
#include "services/runtime/lockstep/lockstep_rule.h"
#include "services/runtime/transport/lcm_url.h"

namespace fogline::recorder {
namespace {

// Number of steps between two acknowledgements: a quarter of the world's kMaxAhead.
constexpr std::int64_t kAcknowledgeEvery = runtime::kMaxAhead / 4;
// The largest number of messages that the recorder sends again, per second and in one burst. At the
// limit per second the answers take about a fifth of one processor's time. A role that starts again
// asks for its inputs of 63 steps at a time. With six inputs these are 378 messages, an eighth of a
// burst.
constexpr double kAnswersPerSecond = 30'000;
constexpr double kAnswersAtOnce = 3'000;
constexpr double kNoLimit = 1e9;
// All roles receive each answer. So a request within this time after an answer gets no second
// answer: the role that asks has received the first one, or asks again.
constexpr Duration kAnswerHolds = milliseconds(2);
// The last STATUS is sent this number of times, because a recorder that has left the run cannot
// answer a request for its STATUS. If a third of all messages is lost, all six messages are lost in
// only one of 700 cases.
constexpr int kLastWords = 6;
// The largest number of old steps that are sent between two reads of new messages.
constexpr int kStepsAtOnce = 4;
// In this time the rate limiter allows another 30 answers.
constexpr Duration kLimiterRetry = milliseconds(1);

}  // namespace

Recorder::Recorder(runtime::Bus& bus, std::optional<std::int64_t> run_id,
                   const std::filesystem::path& file, Existing existing, WallClock wall_clock)
    : node_(bus, Role::kRecorder, run_id, *this),
      file_(file),
      existing_(existing),
      wall_clock_(wall_clock == WallClock::kYes) {
  // On a bus in memory, no other process can send a flood of requests. So the number of answers has
  // no limit.
  const double at_most = runtime::IsInMemory(bus.url()) ? kNoLimit : 1;
  node_.outputs().limiter() =
      runtime::RateLimiter(at_most * kAnswersPerSecond, at_most * kAnswersAtOnce);
  parts_.inputs.Of(IndexOf<truth_t>()).keep = [this](std::int64_t step, runtime::Arrival& arrival) {
    const truth_t& truth = *arrival.As<truth_t>();
    if (truth.last) final_ = step;
    if (wall_clock_) NoteWallClock(truth);
  };
  if (existing_ == Existing::kReplace && run_id) log_.emplace(file);
}

std::unique_ptr<runtime::FireRule> Recorder::Join(const Scenario& scenario) {
  wall_clock_ = wall_clock_ || parts_.run.realtime;
  newest_clock_ = parts_.run.progress + 1;  // the TRUTH of an earlier step may be sent again
  if (existing_ == Existing::kReplace || !Resume()) WriteScenario();
  step_us_ = std::llround(scenario.step_s * 1e6);
  if (!parts_.run.realtime) return std::make_unique<runtime::LockstepRule>(parts_);
  auto rule = std::make_unique<RecordRule>(parts_, scenario);
  recording_ = rule.get();
  return rule;
}

bool Recorder::Resume() {
  std::error_code missing;
  const bool is_there = std::filesystem::file_size(file_, missing) > 0 && !missing;
  const log::LogFront front = is_there ? log::ReadFront(file_) : log::LogFront();
  const std::int64_t run_id = *parts_.run.id;
  if (!front.parts.empty() && front.run_id != run_id) {
    throw InputError(fmt::format("{}: the log is of run {}, not of run {}", file_.string(),
                                 front.run_id, run_id));
  }
  if (!front.parts.empty() && front.parts.hash() != parts_.run.parts.hash()) {
    throw InputError(fmt::format("{}: the log is of another scenario", file_.string()));
  }
  const log::Remains remains = ReadOwnRemains(front);
  if (!front.parts.Complete()) return false;
  // In lockstep, either all steps of a log have a wall clock, or none has one. So if the log
  // already has steps, these steps decide whether the new steps have a wall clock.
  if (!parts_.run.realtime && remains.steps > 0) wall_clock_ = front.wall_clock;
  log_.emplace(file_, remains.head);
  log::LogFront continued = front;
  continued.wall_clock = wall_clock_;
  history_.emplace(file_, continued, remains);
  if (remains.final) final_ = remains.steps - 1;
  parts_.steps.StartAt(remains.steps);
  if (!parts_.run.realtime) RememberLastSteps();
  return true;
}

log::Remains Recorder::ReadOwnRemains(const log::LogFront& front) {
  const auto say_so_far = [this](std::int64_t steps) {
    parts_.own.message().header.step = steps - 1;
    parts_.own.Publish();
  };
  log::Remains remains;
  if (front.parts.Complete()) remains = log::ReadRemains(file_, front, say_so_far);
  // In lockstep, the world begins a step only when the step that is kMaxAhead steps earlier is on
  // disk. So all steps up to `progress - kMaxAhead` were on disk. A log that lacks one of them is
  // refused. In real time the world does not wait, and a missing step is a gap in the log.
  const std::int64_t written = parts_.run.progress - runtime::kMaxAhead + 1;
  if (!parts_.run.realtime && remains.steps < written) {
    throw InputError(fmt::format("{}: the log has {} steps, but the recorder had written {}",
                                 file_.string(), remains.steps, written));
  }
  return remains;
}

void Recorder::RememberLastSteps() {
  const std::int64_t steps = history_->steps();
  for (std::int64_t step = std::max<std::int64_t>(0, steps - runtime::kRingSteps); step < steps;
       ++step) {
    std::size_t input = 0;  // the inputs are in the same order as the messages in the log
    history_->ForEachMessage(step, [&](std::string_view /*channel*/, runtime::Bytes bytes) {
      parts_.inputs.Remember(input++, step, bytes);
    });
  }
}

void Recorder::WriteScenario() {
  if (!log_) log_.emplace(file_);
  const runtime::RunNews& news = parts_.run;
  const std::vector<std::string>& texts = news.parts.parts();
  std::vector<std::uint8_t> buffer;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    run_t run = runtime::MakeRunPart(*news.id, run_t::PREPARE, 0, news.parts.hash(), texts, i);
    if (news.realtime) {
      run.realtime = 1;
      run.pace = news.pace;
    }
    runtime::Encode(run, buffer);
    log_->Write(ChannelOf<run_t>().name, 0, buffer);
  }
  log::WriteLogGraph(*log_, *news.id);
  log_->Flush();
  const log::LogHead head = log_->head();
  history_.emplace(file_,
                   log::LogFront{.run_id = *news.id,
                                 .parts = {},
                                 .realtime = news.realtime,
                                 .head = head,
                                 .wall_clock = wall_clock_},
                   log::Remains{.head = head, .last = head.bytes});
}

void Recorder::Write(std::int64_t step) {
  for (const runtime::Input& input : parts_.inputs.all()) {
    if (!input.ring.Has(step)) continue;
    const runtime::Bytes bytes = input.ring.Get(step);
    constexpr std::size_t kTimeOffset = runtime::kStepOffset + 8;
    log_->Write(kChannels[input.channel].name, runtime::ReadInt64(bytes, kTimeOffset), bytes);
  }
  if (wall_clock_) WriteWallClock(step);
}

void Recorder::NoteWallClock(const truth_t& truth) {
  wall_clock_t clock = log::ReadWallClock();
  clock.header = truth.header;
  clock.late = truth.header.step < newest_clock_;
  newest_clock_ = std::max(newest_clock_, truth.header.step);
  clocks_[runtime::RingSlot(truth.header.step)] = clock;
}

void Recorder::WriteWallClock(std::int64_t step) {
  const wall_clock_t& clock = clocks_[runtime::RingSlot(step)];
  const bool is_known = clock.header.run_id == *parts_.run.id && clock.header.step == step;
  if (!is_known) return;
  std::vector<std::uint8_t> bytes;
  runtime::Encode(clock, bytes);
  log_->Write(log::kWallClockChannel, clock.header.utime, bytes);
}

void Recorder::WriteEvents(std::int64_t step) {
  recording_->TakeEvents(step, [&](std::string_view channel, runtime::Bytes bytes) {
    log_->Write(channel, step * step_us_, bytes);
  });
}

void Recorder::Compute(std::int64_t step) {
  Write(step);
  if (recording_ != nullptr) WriteEvents(step);
  history_->Add(log_->size());
  // In real time, the recorder flushes each step, because a restarted recorder can ask the roles
  // for only the newest 32 steps. The time between two steps is long enough to flush.
  if (recording_ != nullptr) log_->Flush();
  const bool last = step == final_;
  if (last || (step + 1) % kAcknowledgeEvery == 0) {
    parts_.own.message().header.step = step;
    parts_.own.Publish();
  }
}

TimePoint Recorder::Poll(TimePoint now) {
  return recording_ != nullptr ? TimePoint::max() : AnswerSome(now);
}

void Recorder::OnStatusAsked(std::int64_t step) {
  const std::int64_t next = parts_.steps.next();
  node_.rule().Expect(std::min(step, next + runtime::kRingSteps - 1));
  if (next > step) parts_.own.Publish();
}

void Recorder::OnAsked(std::string_view channel, runtime::StepRange steps, TimePoint now) {
  if (recording_ != nullptr) return AnswerRecent(channel, steps, now);
  // The recorder answers only for steps that are at least kMaxAhead steps old. These steps are
  // acknowledged, so they can be read from the file. The roles that published newer steps still
  // have these steps in their rings, and answer themselves.
  static_assert(kAcknowledgeEvery <= runtime::kMaxAhead);
  steps.count = std::min(steps.count, parts_.steps.next() - runtime::kMaxAhead - steps.first);
  const std::size_t place = ChannelNamed(channel);
  if (place == kNumChannels || kChannels[place].pace != Pace::kStep) return;
  for (std::int64_t k = steps.first; k < steps.first + steps.count; ++k) {
    // All roles receive each answer, so one answer is enough.
    const Answered& last = answered_[place][runtime::RingSlot(k)];
    if (last.step == k && now - last.at < kAnswerHolds) continue;
    asked_.Add(k, AskedSteps::Channels{1} << place);
  }
}

TimePoint Recorder::AnswerSome(TimePoint now) {
  if (asked_.empty()) return TimePoint::max();
  // New messages are read first. Roles repeat their requests while the recorder sends other
  // answers. If these repetitions were not read together, each of them would get its own answer.
  parts_.bus.Drain();
  runtime::RateLimiter& limiter = node_.outputs().limiter();
  for (int i = 0; i < kStepsAtOnce && limiter.Has(now); ++i) {
    const auto asked = asked_.Take();
    if (!asked) return TimePoint::max();
    AnswerStep(*asked, now);
  }
  // The function returns, so that new messages are read. The next call is due when the rate limiter
  // allows it.
  return asked_.empty() ? TimePoint::max() : limiter.Has(now) ? now : now + kLimiterRetry;
}

void Recorder::AnswerStep(const AskedSteps::Asked& asked, TimePoint now) {
  history_->ForEachMessage(asked.step, [&](std::string_view name, runtime::Bytes bytes) {
    const std::size_t channel = ChannelNamed(name);
    const AskedSteps::Channels bit = AskedSteps::Channels{1} << channel;
    if ((asked.channels & bit) == 0) return;
    if (!node_.outputs().limiter().Has(now)) return asked_.Add(asked.step, bit);
    answered_[channel][runtime::RingSlot(asked.step)] = {.step = asked.step, .at = now};
    Answer(name, bytes, now);
  });
}

// In real time no role computes old steps again. Only a restarted world needs an old message: the
// TRUTH with the positions of the cars. The process that published this TRUTH has ended, so the
// recorder sends this message.
void Recorder::AnswerRecent(std::string_view channel, runtime::StepRange steps, TimePoint now) {
  if (channel != ChannelOf<truth_t>().name || !node_.outputs().limiter().Has(now)) return;
  const runtime::StepRing& truths = parts_.inputs.Of(IndexOf<truth_t>()).ring;
  bool answered = false;
  for (std::int64_t step = steps.first; step < steps.first + steps.count; ++step) {
    if (!truths.Has(step)) continue;
    Answer(channel, truths.Get(step), now);
    answered = true;
  }
  // If the recorder itself was restarted, its ring is empty. The answer then comes from the file.
  if (answered || history_->steps() == 0) return;
  log_->Flush();
  AnswerStep(
      {.step = history_->steps() - 1, .channels = AskedSteps::Channels{1} << IndexOf<truth_t>()},
      now);
}

void Recorder::Answer(std::string_view channel, runtime::Bytes bytes, TimePoint now) {
  if (!node_.outputs().limiter().Take(now)) return;
  parts_.bus.Publish(channel, bytes);
  ++parts_.own.message().repairs_served;
}

void Recorder::BeforeStatus() {
  // STATUS acknowledges every step up to header.step. So these steps must be handed to the
  // operating system first.
  if (!log_ || parts_.own.message().state == status_t::FAILED) return;
  try {
    log_->Flush();
  } catch (const std::exception& error) {
    parts_.own.Fail(error.what());
  }
  TellWritten();
}

void Recorder::TellWritten() {
  if (!log_) return;  // the recorder has failed and left
  status_t& status = parts_.own.message();
  status.log_begin = log_->written().begin;
  status.log_bytes = log_->written().bytes;
  status.log_checksum = log_->written().checksum;
}

void Recorder::OnLeave() {
  // A run that ends early leaves incomplete steps. The messages that have come are written.
  if (!log_) return;
  std::int64_t newest = -1;
  for (const runtime::Input& input : parts_.inputs.all()) {
    newest = std::max(newest, input.ring.newest());
  }
  const std::int64_t next = parts_.steps.next();
  try {
    for (std::int64_t step = next; step <= newest; ++step) Write(step);
    if (recording_ != nullptr) WriteEvents(std::max(newest, next - 1));
    log_->Flush();
  } catch (const std::runtime_error&) {
    // The disk has no room for the incomplete steps. The log is valid without them. If the disk had
    // no room for complete steps, an earlier write has reported this.
  }
  TellWritten();
  log_.reset();
  for (int i = 0; i < kLastWords; ++i) parts_.own.Publish();
}

}  // namespace fogline::recorder
