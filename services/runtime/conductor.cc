#include "services/runtime/conductor.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/core.h>

namespace fogline {
namespace {

constexpr Duration kAnnounceEvery = milliseconds(50);
// While the run goes on: a sign of life, which roles that were started elsewhere wait for.
constexpr Duration kRepeatEvery = milliseconds(1000);
// Requests for the whole scenario that come together are answered together.
constexpr Duration kPartsEvery = milliseconds(10);
// A role without a STATUS for this long (five heartbeats) counts as silent.
constexpr Duration kSilent = milliseconds(1000);

double Seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

std::optional<Role> RoleNamed(std::string_view name) {
  for (const RoleInfo& info : kRoles) {
    if (info.name == name) return info.role;
  }
  return std::nullopt;
}

const ChannelInfo* ChannelNamed(std::string_view name) {
  const auto found = std::ranges::find(kChannels, name, &ChannelInfo::name);
  return found == kChannels.end() ? nullptr : &*found;
}

}  // namespace

Conductor::Conductor(Bus& bus, ConductorOptions options)
    : bus_(bus),
      options_(std::move(options)),
      parts_(SplitScenario(options_.scenario_text)),
      hash_(HashOf(options_.scenario_text)),
      began_(Clock::now()) {
  bus_.Subscribe(ChannelOf<status_t>().name, [this](Arrival& arrival) {
    if (const auto* status = arrival.As<status_t>()) OnStatus(*status);
  });
  bus_.Subscribe(ChannelOf<resend_t>().name, [this](Bytes bytes) { OnResend(bytes); });
}

TimePoint Conductor::Poll(TimePoint now) {
  if (phase_ == Phase::kJoining && AllReady()) {
    phase_ = Phase::kRunning;
    progressed_ = now;
    announce_at_ = now;
  }
  if (phase_ == Phase::kJoining && options_.join_limit > Duration::zero() &&
      now - began_ > options_.join_limit) {
    Fail(fmt::format("not ready after {:.1f} s: {}", Seconds(options_.join_limit), NotReady()));
  }
  if (phase_ == Phase::kRunning && now - progressed_ > options_.stall_limit) Fail(Culprit(now));
  const bool begun = phase_ != Phase::kRunning || step() >= 0;
  if (now >= announce_at_ && phase_ == Phase::kJoining) {
    Announce(run_t::PREPARE, 0);
    announce_at_ = now + kAnnounceEvery;
  } else if (now >= announce_at_ && phase_ == Phase::kRunning) {
    Announce(run_t::GO, 0);
    announce_at_ = now + (begun ? kRepeatEvery : kAnnounceEvery);
  }
  return std::min(announce_at_, now + kAnnounceEvery);
}

std::int64_t Conductor::step() const {
  const Member& world = member(Role::kWorld);
  return world.status ? world.status->header.step : -1;
}

bool Conductor::AllReady() const {
  return std::ranges::all_of(members_, [](const Member& member) {
    return member.status && member.status->state != status_t::WAITING;
  });
}

std::string Conductor::NotReady() const {
  std::string names;
  for (const RoleInfo& info : kRoles) {
    const auto& status = member(info.role).status;
    if (status && status->state != status_t::WAITING) continue;
    names +=
        fmt::format("{}{}{}", names.empty() ? "" : ", ", info.name, status ? "" : " (never heard)");
  }
  return names;
}

std::int64_t Conductor::Total(std::int64_t status_t::*counter) const {
  std::int64_t total = 0;
  for (const Member& member : members_) total += member.status ? (*member.status).*counter : 0;
  return total;
}

Refusals Conductor::Refused() const {
  Refusals refused{};
  std::ranges::transform(kRefusals, refused.begin(),
                         [this](const RefusalKind& kind) { return Total(kind.counter); });
  return refused;
}

void Conductor::Stop() { Announce(run_t::STOP, 0); }

void Conductor::Fail(std::string error) {
  if (phase_ == Phase::kFailed || phase_ == Phase::kDone) return;
  phase_ = Phase::kFailed;
  error_ = std::move(error);
}

void Conductor::OnStatus(const status_t& status) {
  if (status.header.run_id != options_.run_id) return strangers_.Hear(status);
  const auto role = RoleNamed(status.role);
  if (!role || (phase_ != Phase::kJoining && phase_ != Phase::kRunning)) return;
  const TimePoint now = Clock::now();
  Member& member = members_[static_cast<std::size_t>(*role)];
  if (member.status && member.status->instance != status.instance) {
    return Fail(fmt::format("two processes are the {}: pid {} on {} and pid {} on {}", status.role,
                            member.status->pid, member.status->host, status.pid, status.host));
  }
  if (member.status && status.sequence <= member.status->sequence) return;  // overtaken on its way
  const bool joined = status.state == status_t::READY || status.state == status_t::RUNNING;
  if (joined && status.scenario_hash != hash_) {
    return Fail(fmt::format("{} (pid {} on {}) has another scenario", status.role, status.pid,
                            status.host));
  }
  if (joined && status.type_fingerprint != TypeFingerprint()) {
    return Fail(fmt::format("{} (pid {} on {}) was built with other message types", status.role,
                            status.pid, status.host));
  }
  member.status = status;
  member.heard = now;
  if (member.status->state == status_t::FAILED) {
    return Fail(fmt::format("{}: {}", member.status->role, member.status->error));
  }
  if (*role != Role::kWorld) return;
  if (member.status->header.step > progress_) {
    progress_ = member.status->header.step;
    progressed_ = now;
  }
  if (member.status->state == status_t::DONE) phase_ = Phase::kDone;
}

void Conductor::OnResend(Bytes bytes) {
  resend_t resend{};
  if (!Decode(bytes, resend) || resend.header.run_id != options_.run_id) return;
  if (resend.channel != ChannelOf<run_t>().name) return;
  // Who misses one part usually misses most of them: everything from there on is sent.
  const TimePoint now = Clock::now();
  if (now < parts_at_ || resend.header.step < 0) return;
  parts_at_ = now + kPartsEvery;
  for (auto i = static_cast<std::size_t>(resend.header.step); i < parts_.size(); ++i) {
    Announce(run_t::PREPARE, i);
  }
}

void Conductor::Announce(std::int8_t phase, std::size_t part) {
  run_t run = MakeRunPart(options_.run_id, phase, options_.pace, hash_, parts_, part);
  run.progress = progress_;
  Encode(run, buffer_);
  bus_.Publish(ChannelOf<run_t>().name, buffer_);
}

std::string Conductor::Culprit(TimePoint now) const {
  // From the world up along what each role waits for, to the first that does not say why. The step
  // is the one that the role in question works on: the world is a step ahead of the others.
  std::int64_t stuck = step() + 1;
  Role waiting = Role::kWorld;
  for (std::size_t hops = 0; hops < kRoles.size(); ++hops) {
    const Member& consumer = member(waiting);
    if (!consumer.status || now - consumer.heard > kSilent) {
      return fmt::format("step {}: {} is silent (last heard: step {}, {:.1f} s ago)", stuck,
                         NameOf(waiting), consumer.status ? consumer.status->header.step : -1,
                         Seconds(now - consumer.heard));
    }
    stuck = consumer.status->header.step + 1;
    const ChannelInfo* channel = ChannelNamed(consumer.status->waiting_for);
    const Role producer = channel != nullptr ? channel->from : Role::kRecorder;
    const Member& source = member(producer);
    const bool passes_on = source.status && now - source.heard <= kSilent &&
                           !source.status->waiting_for.empty() && producer != waiting;
    if (passes_on) {
      waiting = producer;
      continue;
    }
    // The consumer knows about the channel; about the log we know ourselves.
    using Known = std::tuple<std::string_view, std::int64_t, Duration>;
    const auto [what, last, age] =
        channel != nullptr
            ? Known(channel->name, consumer.status->last_heard_step,
                    now - consumer.heard + milliseconds(consumer.status->last_heard_ms))
            : Known("the log", source.status ? source.status->header.step : -1, now - source.heard);
    return fmt::format("step {}: {} waits for {} from {} (last heard: step {}, {:.1f} s ago)",
                       stuck, NameOf(waiting), what, NameOf(producer), last, Seconds(age));
  }
  return fmt::format("step {}: every role waits for another", stuck);
}

}  // namespace fogline
