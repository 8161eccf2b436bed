#include "services/runtime/lockstep/node.h"

#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/process/this_process.h"
#include "scenario/io/loader.h"
#include "services/runtime/lockstep/lockstep_rule.h"
#include "services/runtime/wire/build_id.h"

namespace fogline::runtime {
namespace {

// Every node receives an answer. A node that asks for the same step within this time has the
// answer, or will ask again.
constexpr Duration kAnswerHolds = milliseconds(1);
// A run waits for its newest steps. Requests for this many of them are always answered.
constexpr std::int64_t kNewest = 2;
// A missing part of the scenario is asked for at this interval.
constexpr Duration kPartRetry = milliseconds(20);
// The longest error text: it must fit into a STATUS with everything else.
constexpr std::size_t kMaxErrorBytes = 700;
// Repeated announcements are answered at most at this interval.
constexpr Duration kAnnouncedRetry = milliseconds(20);
// A failed send is reported within this time after the last STATUS, because a run may be over
// before the next heartbeat.
constexpr Duration kTellSends = milliseconds(20);
// A node that has not received the whole scenario yet leaves a run after this long a silence of its
// runner, and looks for another run.
constexpr Duration kAnnouncerSilence = milliseconds(5'000);

/// The requests that a role can answer: those for its own channels. The recorder can answer
/// requests for all channels.
Contents RequestsTo(Role role) {
  Contents requests{.offset = kHeaderEnd, .texts = {}};
  if (role == Role::kRecorder) return requests;
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace == Pace::kStep && channel.from == role) {
      requests.texts.push_back(EncodedText(channel.name));
    }
  }
  return requests;
}

}  // namespace

Node::Node(Bus& bus, Role role, std::optional<std::int64_t> run_id)
    : bus_(bus),
      role_(role),
      chosen_(run_id.has_value()),
      run_id_(run_id),
      bound_(chosen_),
      fresh_(!bus.secured()),
      ends_with_runner_(chosen_ && EndsWithItsParent()) {
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    const ChannelInfo& channel = kChannels[i];
    if (channel.pace != Pace::kStep) continue;
    if (channel.to.Has(role) || role == Role::kRecorder) Read(i, false);
    if (channel.from == role) {
      outputs_.push_back({.channel = i, .topic = bus_.TopicOf(channel.name), .ring = {}});
    }
  }
  bus_.Subscribe(ChannelOf<run_t>().name, [this](Bytes bytes) { OnRun(bytes); });
  bus_.Subscribe(
      ChannelOf<resend_t>().name, [this](Bytes bytes) { OnResend(bytes); }, RequestsTo(role));
  status_.role = NameOf(role);
  status_.host = HostName();
  status_.pid = getpid();
  randombytes_buf(&status_.instance, sizeof(status_.instance));
  status_.version = FOGLINE_VERSION;
  status_.build_id = OwnBuildId();
  status_.type_fingerprint = TypeFingerprint();
  status_.header.step = -1;
  status_.last_heard_step = -1;
}

Node::~Node() = default;

void Node::Read(std::size_t channel, bool on_demand) {
  const ChannelInfo& info = kChannels[channel];
  inputs_.push_back({.channel = channel,
                     .fingerprint = FingerprintOf(channel),
                     .lag = LagOf(info.from, role_),
                     .on_demand = on_demand,
                     .ring = {}});
  const std::size_t index = inputs_.size() - 1;
  bus_.Subscribe(info.name, [this, index](Arrival& arrival) { OnInput(index, arrival); });
}

std::string Node::Contradiction(std::int64_t step, const ChannelInfo& channel) const {
  return fmt::format("step {}: {} came twice with different contents: is there a second {}?", step,
                     channel.name, NameOf(channel.from));
}

std::unique_ptr<FireRule> Node::MakeRule(const Scenario& /*scenario*/) {
  return std::make_unique<LockstepRule>(*this);
}

TimePoint Node::Poll(TimePoint now) {
  if (left_ || released()) return now + kHeartbeat;
  runner_.Attend(now);
  if (Waits() && runner_.Silence(now) > kAnnouncerSilence && !chosen_) Unbind();
  if (!Waits() && runner_.Gone(now) && !ends_with_runner_) {
    Fail(fmt::format("the runner has been silent for {:.0f} s", Seconds(runner_.Silence(now))));
  }
  CheckSends(now);
  if (left_) return now + kHeartbeat;
  TimePoint next = now + kHeartbeat;
  if (Running()) {
    next = std::min(next, rule_->Poll(now));
  } else if (status_.state == status_t::WAITING && bound_) {
    if (now >= part_at_) {
      Ask(ChannelOf<run_t>().name, {.first = parts_.FirstMissing(), .count = 1});
      part_at_ = now + kPartRetry;
    }
    next = std::min(next, part_at_);
  }
  if (now >= status_at_) PublishStatus();
  return std::min(next, status_at_);
}

void Node::CheckSends(TimePoint now) {
  const Bus::FailedSends& failed = bus_.failed_sends();
  if (failed.count == status_.sends_failed) return;
  status_at_ = std::min(status_at_, said_at_ + kTellSends);
  // In real time the other roles go on without it, and the runner judges how long it may be silent.
  if (left_ || realtime_ || !failed.since || !runner_.Stalled(*failed.since, now)) return;
  Fail(fmt::format("nothing could be sent for {:.1f} s: {}", Seconds(now - *failed.since),
                   failed.error));
}

void Node::Release(const std::string& why) {
  status_.error = why.substr(0, kMaxErrorBytes);
  SetState(status_t::LEFT);
}

void Node::Leave() {
  if (left_) return;
  left_ = true;
  OnLeave();
  PublishStatus();
}

void Node::Fail(const std::string& error) {
  if (status_.state == status_t::FAILED) return;
  status_.error = error.substr(0, kMaxErrorBytes);
  SetState(status_t::FAILED);
  left_ = true;
  OnLeave();
}

void Node::SetState(std::int8_t state) {
  status_.state = state;
  PublishStatus();
}

void Node::PublishStatus() {
  const TimePoint now = Clock::now();
  said_at_ = now;
  status_at_ = now + kHeartbeat;
  if (!bound_) return;  // no run has been announced yet
  BeforeStatus();
  status_.header.run_id = *run_id_;
  status_.scenario_hash = parts_.hash();
  status_.waiting_for.clear();
  if (rule_) rule_->WriteStatus(now);
  ++status_.sequence;
  const Bus::Unverified unverified = bus_.TakeUnverified();
  status_.not_signed += unverified.not_signed;
  status_.badly_signed += unverified.badly_signed;
  if (now >= use_at_) {  // a question to the kernel costs more than some steps
    use_at_ = now + kHeartbeat;
    const ProcessUse use = MeasureThisProcess();
    status_.cpu_ms = use.cpu_ms;
    status_.rss_bytes = use.rss_bytes;
  }
  status_.sends_failed = bus_.failed_sends().count;
  status_.send_error = bus_.failed_sends().error;
  Encode(status_, buffer_);
  bus_.Publish(ChannelOf<status_t>().name, buffer_);
}

void Node::Ask(std::int64_t run_id, std::string_view channel, StepRange steps) {
  resend_t resend{};
  resend.header = {.run_id = run_id, .step = steps.first, .utime = 0};
  resend.channel = channel;
  resend.count = static_cast<std::int32_t>(steps.count);
  resend.requester = NameOf(role_);
  resend.instance = status_.instance;
  Encode(resend, buffer_);
  bus_.Publish(ChannelOf<resend_t>().name, buffer_);
}

void Node::Emit(std::size_t channel, std::int64_t step, Bytes bytes) {
  const std::string_view name = kChannels[channel].name;
  if (bytes.size() > kMaxMessageBytes) {
    throw std::runtime_error(fmt::format("step {}: {} takes {} bytes, at most {} fit", step, name,
                                         bytes.size(), kMaxMessageBytes));
  }
  for (Output& output : outputs_) {
    if (output.channel != channel) continue;
    output.ring.Store(step, bytes);
    output.answered[RingSlot(step)] = {};
    // A step that is so old that it is on disk is not published: the recorder answers for it. In
    // real time every output is published.
    if (realtime_ || step > progress_ - 2 * kMaxAhead) bus_.Publish(output.topic, bytes);
  }
}

void Node::Answer(std::string_view channel, Bytes bytes, TimePoint now) {
  if (!limiter_.Take(now)) return;
  bus_.Publish(channel, bytes);
  ++status_.repairs_served;
}

void Node::OnRun(Bytes bytes) {
  if (left_ || released()) return;  // the node has left, and its files are closed
  run_t run{};
  if (const RefusalCounter wrong = Examine(bytes, run)) return Refuse(wrong);
  const TimePoint now = Clock::now();
  if (bound_ ? run.header.run_id != *run_id_ : run.phase == run_t::STOP) {
    OnOtherRun(run, now);
    return Refuse(&status_t::foreign);
  }
  if (!bound_ && SeatIn(run, status_.role, status_.instance) != Seat::kFree) return;
  if (run.progress > steps_) return Refuse(&status_t::out_of_window);
  if (run.realtime && !IsSpeed(run.pace)) return Refuse(&status_t::malformed);
  if (!IsFresh(run, now)) return;
  if (status_.state == status_t::WAITING && run.phase != run_t::STOP && !parts_.Add(run)) {
    return Refuse(&status_t::malformed);
  }
  run_id_ = run.header.run_id;
  bound_ = true;
  const bool news = TakeNews(run, now);
  if (!left_ && status_.state == status_t::WAITING && parts_.Complete()) Join(run);
  if (news && run.phase == run_t::GO && Running()) rule_->OnGo(run, now);
}

void Node::OnOtherRun(const run_t& run, TimePoint now) {
  now = runner_.Attend(now);
  const bool may_go = bound_ && !chosen_ && runner_.Silent(now) && run.phase != run_t::STOP;
  if (!may_go || SeatIn(run, status_.role, status_.instance) != Seat::kFree) return;
  // A signed RUN may be the repetition of an old one, so it must answer a request of this process.
  if (bus_.secured() && run.answer_to != status_.instance) return AskWhetherThere(run, now);
  Release(fmt::format("the runner of run {} has been silent for {:.1f} s; run {} waits for the {}",
                      *run_id_, Seconds(runner_.Silence(now)), run.header.run_id, status_.role));
}

bool Node::IsFresh(const run_t& run, TimePoint now) {
  if (fresh_) return true;
  fresh_ = run.answer_to == status_.instance;
  if (!fresh_) AskWhetherThere(run, now);
  return fresh_;
}

void Node::AskWhetherThere(const run_t& run, TimePoint now) {
  if (!questions_.Take(now)) return;
  Ask(run.header.run_id, ChannelOf<run_t>().name, {.first = 0, .count = 1});
}

bool Node::TakeNews(const run_t& run, TimePoint now) {
  if (run.sequence <= sequence_) {
    ++status_.duplicates;
    return false;
  }
  sequence_ = run.sequence;
  runner_.Heard(run, now);
  progress_ = std::max(progress_, run.progress);
  minimal_risk_ = run.minimal_risk;
  if (rule_) rule_->OnProgress();
  if (run.phase == run_t::STOP) {
    Leave();
  } else if (!chosen_ && SeatIn(run, status_.role, status_.instance) == Seat::kTaken) {
    Release(fmt::format("another process is the {} of run {}", status_.role, run.header.run_id));
  } else if (status_.state != status_t::WAITING && run.phase == run_t::PREPARE &&
             run.header.step == 0 && now >= announced_at_ + kAnnouncedRetry) {
    announced_at_ = now;
    PublishStatus();  // the announcement is repeated: the runner may not have heard this node
  }
  return true;
}

void Node::Unbind() {
  parts_ = {};
  run_id_.reset();
  bound_ = false;
  fresh_ = !bus_.secured();
  sequence_ = 0;
  progress_ = -1;
  runner_.Forget();
}

void Node::Join(const run_t& run) {
  if (!parts_.HashHolds()) {
    return Fail("the scenario that arrived does not match its hash");
  }
  realtime_ = run.realtime;
  pace_ = run.pace;
  try {
    const Scenario scenario = ParseScenario(parts_.Text());
    steps_ = scenario.steps;
    progress_ = std::min(progress_, steps_);
    Configure(scenario);
    rule_ = MakeRule(scenario);
  } catch (const std::exception& error) {
    return Fail(fmt::format("cannot take part: {}", error.what()));
  }
  SetState(status_t::READY);
}

void Node::StartAt(std::int64_t step) {
  next_ = step;
  status_.header.step = step - 1;
}

void Node::OnInput(std::size_t index, Arrival& arrival) {
  if (!Running()) return;
  const Bytes bytes = arrival.bytes();
  if (bytes.size() < kHeaderEnd) return Refuse(&status_t::malformed);
  if (ReadInt64(bytes, 0) != inputs_[index].fingerprint) return Refuse(&status_t::wrong_type);
  if (ReadInt64(bytes, kRunIdOffset) != *run_id_) return Refuse(&status_t::foreign);
  const std::int64_t step = ReadInt64(bytes, kStepOffset);
  if (step < 0 || step >= steps_) return Refuse(&status_t::out_of_window);
  switch (rule_->Classify(index, step, bytes)) {
    case StepRing::Verdict::kDuplicate:
      ++status_.duplicates;
      return;
    case StepRing::Verdict::kOutOfWindow:
      return Refuse(&status_t::out_of_window);
    case StepRing::Verdict::kElsewhere:
    case StepRing::Verdict::kLate:
      return;
    case StepRing::Verdict::kConflict: {
      if (const RefusalCounter wrong = Wrong(index, arrival)) return Refuse(wrong);
      return Fail(Contradiction(step, kChannels[inputs_[index].channel]));
    }
    case StepRing::Verdict::kNew:
      return TakeInput(index, step, arrival);
  }
}

void Node::TakeInput(std::size_t index, std::int64_t step, Arrival& arrival) {
  if (const RefusalCounter wrong = Accept(index, step, arrival)) return Refuse(wrong);
  Input& input = inputs_[index];
  input.ring.Store(step, arrival.bytes());
  input.heard = arrival.time();
  rule_->OnInput(index, step, arrival.time());
}

void Node::OnResend(Bytes bytes) {
  const TimePoint now = Clock::now();
  if (const auto share = requests_.Count(now))
    bus_.SetSampleRate(ChannelOf<resend_t>().name, *share);
  resend_t resend{};
  if (const RefusalCounter wrong = Examine(bytes, resend)) return Refuse(wrong);
  if (bound_ && resend.header.run_id != *run_id_) return Refuse(&status_t::foreign);
  const std::int64_t step = resend.header.step;
  if (step < 0 || step > kMaxStep) return Refuse(&status_t::out_of_window);
  if (!Running()) return;
  if (resend.channel == ChannelOf<status_t>().name) {
    if (limiter_.Take(now)) OnStatusAsked(step, now);
    return;
  }
  const StepRange steps{.first = step,
                        .count = std::clamp<std::int64_t>(resend.count, 1, kRingSteps)};
  for (Output& output : outputs_) {
    if (kChannels[output.channel].name != resend.channel) continue;
    AnswerFrom(output, steps, now);
    if (step >= next_) rule_->OnAskedAhead(step, now);
  }
  OnAsked(resend.channel, steps, now);
}

void Node::AnswerFrom(Output& output, StepRange steps, TimePoint now) {
  for (std::int64_t step = steps.first; step < steps.first + steps.count; ++step) {
    TimePoint& answered = output.answered[RingSlot(step)];
    if (!output.ring.Has(step) || now - answered < kAnswerHolds) continue;
    if (step < next_ - kNewest && !limiter_.Take(now)) continue;
    answered = now;
    bus_.Publish(output.topic, output.ring.Get(step));
    ++status_.repairs_served;
  }
}

bool Node::ComputeNow(std::int64_t step) {
  try {
    Compute(step);
  } catch (const std::exception& error) {
    Fail(error.what());
    return false;
  }
  status_.header.step = step;
  next_ = step + 1;
  if (status_.state == status_t::READY) SetState(status_t::RUNNING);
  return true;
}

}  // namespace fogline::runtime
