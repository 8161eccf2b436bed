#include "services/runtime/coordination/deaf_roles.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {
namespace {

// If the network loses the inputs of a role, the role recovers within a second. A role counts as
// deaf after kDeaf, which is twice this time. If kDeafPeriods steps of the run take longer than
// kDeaf, the role counts as deaf only after the time of these steps.
constexpr Duration kDeaf = milliseconds(2000);
constexpr int kDeafPeriods = 5;
// Three times the longest interval between two STATUS messages of a role. If two STATUS messages of
// a role are further apart than this, the time between them is not counted.
constexpr Duration kSteady = milliseconds(600);
// A network that loses 30 % of all messages loses this many in a row with probability 6e-6. So if a
// role lacks this many messages in a row, the network is hardly the cause.
constexpr std::int64_t kSureMessages = 10;
// The step of a producer is estimated from its STATUS and the time since then. A role counts as
// ahead of the producer if it is more than this many steps beyond the estimate. The producer itself
// may be beyond the estimate, because its STATUS takes up to 100 ms to arrive. In 100 ms a run at
// 50 Hz makes five steps.
constexpr std::int64_t kAhead = 5;

}  // namespace

std::string Text(const Deafness& deaf) {
  const ChannelInfo& channel = kChannels[deaf.channel];
  return fmt::format("has heard no {} for {:.1f} s, although the {} has published it", channel.name,
                     Seconds(deaf.missed), NameOf(channel.from));
}

DeafRoles::DeafRoles(Duration period)
    : period_(period), limit_(std::max(kDeaf, kDeafPeriods * period)) {}

void DeafRoles::Heard(Role role, const status_t& status, TimePoint now) {
  if (period_ == Duration::zero()) return;
  Speaker& speaker = speakers_[static_cast<std::size_t>(role)];
  const bool first = speaker.heard == TimePoint{};
  const Duration since = now - speaker.heard;
  for (std::size_t i = 0; i < status.input.size(); ++i) {
    const std::size_t channel = ChannelNamed(status.input[i]);
    if (channel == kNumChannels || kChannels[channel].pace != Pace::kStep) continue;
    Ear& ear = speaker.ears[channel];
    const Duration age =
        std::chrono::microseconds(std::clamp<std::int64_t>(status.input_age_us[i], 0, kMaxStep));
    // `silent` is the time without a message since the role's previous STATUS. The role measures
    // the age of an input on its own clock. The age grows until a message comes, and does not
    // depend on the time at which the STATUS is read. An input that has not received a message yet
    // (INPUT_AWAITED) has no age. In this case, `silent` is the whole time since the previous
    // STATUS.
    const bool awaited = status.input_state[i] == status_t::INPUT_AWAITED;
    const Duration silent = awaited ? since : std::max(Duration::zero(), age - ear.age);
    const Role from = kChannels[channel].from;
    // Late messages show that the role receives the channel. But if the role is ahead of the
    // producer, all messages come late and the role can use none of them. In this case late
    // messages do not count.
    const bool late = status.input_late[i] > ear.late && !IsAheadOf(from, status.header.step, now);
    const Speaker& producer = speakers_[static_cast<std::size_t>(from)];
    const bool came = !awaited && (age < since || age < ear.age);
    if (first || late || came || producer.ticks < ear.published) {
      ear.published.reset();
    } else if (!ear.published && producer.heard > speaker.heard) {
      ear.published = producer.ticks;
    }
    if (late) {
      ear.missed = ear.unsure = {};
    } else if (!Computes(from, now)) {
      ear.unsure = {};
    } else {
      if (silent <= kSteady && !first) ear.unsure += silent;
      // The silence counts as missed only when the producer has reported a further step. Without a
      // further step, the producer has published no message that could be missing.
      if (producer.advanced > speaker.heard) ear.missed += std::exchange(ear.unsure, {});
    }
    // If a message has come, only the time since this message counts as missed.
    if (!awaited) {
      ear.missed = std::min(ear.missed, age);
      ear.unsure = std::min(ear.unsure, age - ear.missed);
    }
    ear.age = age;
    ear.late = status.input_late[i];
  }
  if (status.header.step > speaker.step) {
    speaker.step = status.header.step;
    speaker.advanced = now;
  }
  speaker.ticks = status.ticks;
  speaker.heard = now;
}

bool DeafRoles::Computes(Role role, TimePoint now) const {
  const Speaker& speaker = speakers_[static_cast<std::size_t>(role)];
  return now - speaker.heard <= kSteady && now - speaker.advanced <= kSteady + 2 * period_;
}

bool DeafRoles::IsAheadOf(Role role, std::int64_t step, TimePoint now) const {
  const Speaker& speaker = speakers_[static_cast<std::size_t>(role)];
  return step > speaker.step + (now - speaker.advanced) / period_ + kAhead;
}

bool DeafRoles::IsSure(const Ear& ear, Role from) const {
  if (!ear.published) return false;
  const std::int64_t published = speakers_[static_cast<std::size_t>(from)].ticks - *ear.published;
  return published >= std::min<std::int64_t>(kSureMessages, ear.missed / period_ / 2);
}

std::optional<Deafness> DeafRoles::Missing(Role role, Duration limit) const {
  if (period_ == Duration::zero()) return std::nullopt;
  const auto& ears = speakers_[static_cast<std::size_t>(role)].ears;
  std::optional<Deafness> worst;
  for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
    const Ear& ear = ears[channel];
    if (ear.missed < limit || !IsSure(ear, kChannels[channel].from)) continue;
    if (!worst || ear.missed > worst->missed) worst = {.channel = channel, .missed = ear.missed};
  }
  return worst;
}

}  // namespace fogline::runtime
