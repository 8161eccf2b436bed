#include "services/runtime/realtime/fallback_log.h"

#include <algorithm>

#include <fmt/core.h>

#include "common/text.h"

namespace fogline::runtime {
namespace {

std::size_t PlaceOf(std::string_view role) {
  return static_cast<std::size_t>(std::ranges::find(kRoles, role, &RoleInfo::name) -
                                  kRoles.begin());
}

// A role counts as silent if it has sent no STATUS for this time on the wall clock. A living
// process publishes a STATUS five times a second.
constexpr double kSilent_us = 600e3;

void Append(std::string& list, std::string_view separator, std::string_view text) {
  if (text.empty()) return;
  if (!list.empty()) list += separator;
  list += text;
}

}  // namespace

std::string Fallback::Text() const {
  std::string text = fmt::format("step {}: {}: {}", step, role, inputs);
  if (!culprit.empty()) {
    text += fmt::format("{}(culprit: {}, last heard {:.2f} s ago)", inputs.empty() ? "" : " ",
                        culprit, age_s);
  }
  if (!does.empty()) text += (inputs.empty() && culprit.empty() ? "" : ": ") + does;
  return text;
}

FallbackLog::FallbackLog(std::int64_t step_us, double speed, std::int64_t steps)
    : step_us_(step_us), steps_(steps), silent_us_(kSilent_us * speed) {}

const Fallback* FallbackLog::Add(const status_t& status) {
  const std::size_t role = PlaceOf(status.role);
  // The recorder's STATUS adds nothing, because each of its inputs is also an input of another
  // role.
  if (role == kRoles.size() || kRoles[role].role == Role::kRecorder) return nullptr;
  if (status.header.utime / step_us_ >= steps_ - 1) return nullptr;
  Known& known = roles_[role];
  known.lost.reset();  // forgets what the role's earlier STATUS reported
  known.utime = status.header.utime;
  std::string lost;
  std::string back;
  std::string stale;  // stale inputs, reported only if the role reacts to them
  for (std::size_t i = 0; i < status.input.size(); ++i) {
    const std::size_t channel = ChannelNamed(status.input[i]);
    if (channel == kNumChannels) continue;
    const std::string_view name = kChannels[channel].name;
    InputState& known_state = known.inputs[channel];
    const auto state = static_cast<InputState>(status.input_state[i]);
    if (state == InputState::kLost) known.lost.set(channel);
    if (state == InputState::kStale) Append(stale, ", ", name);
    if (state == InputState::kLost && known_state != InputState::kLost) Append(lost, ", ", name);
    if (state == InputState::kOk && known_state == InputState::kLost) Append(back, ", ", name);
    // A restarted process does not know yet that an input was lost before. So its state "awaited"
    // changes nothing.
    if (state == InputState::kLost || state == InputState::kOk) known_state = state;
  }
  // A restarted process that has not computed a step yet, or has failed, does not know the fallback
  // of its predecessor.
  const bool computes = status.state == status_t::RUNNING || status.state == status_t::DONE;
  std::string does;
  if (computes && status.fallback != known.does) {
    does = status.fallback.empty() ? "as usual again" : EscapeControls(status.fallback);
    known.does = status.fallback;
  }
  std::string inputs;
  if (!lost.empty()) Append(inputs, ", ", lost + " lost");
  if (!back.empty()) Append(inputs, ", ", back + " ok again");
  if (inputs.empty() && does.empty()) return nullptr;
  if (inputs.empty() && !status.fallback.empty() && !stale.empty()) inputs = stale + " stale";
  newest_ = {};
  newest_.step = status.header.utime / step_us_;
  newest_.role = status.role;
  newest_.inputs = inputs;
  newest_.does = does;
  newest_.what = inputs;
  Append(newest_.what, ": ", does);
  if (!lost.empty() || !status.fallback.empty()) newest_.culprit = Culprit(status);
  newest_.age_s = static_cast<double>(status.last_heard_ms) * 1e-3;
  if (all_.size() < kMaxKept) {
    all_.push_back(newest_);
  } else {
    ++left_out_;
  }
  return &newest_;
}

bool FallbackLog::IsSilent(const Known& known, std::int64_t utime) const {
  return static_cast<double>(utime) - static_cast<double>(known.utime) > silent_us_;
}

// Returns the name of the role that stopped publishing; "" if no input is lost or stale. `status`
// names the first lost input of its role, or the first stale input if no input is lost. The search
// begins with this input. The last STATUS of each other role says which lost inputs prevent that
// role from publishing. The world always publishes, even if inputs are lost. The arbitrator stops
// publishing only if an input from the world is lost.
std::string FallbackLog::Culprit(const status_t& status) const {
  const std::size_t channel = ChannelNamed(status.waiting_for);
  if (channel == kNumChannels) return "";
  ChannelSet missing;
  missing.set(channel);
  LostByRole reported;
  for (std::size_t role = 0; role < kRoles.size(); ++role) {
    const Known& known = roles_[role];
    if (kRoles[role].role == Role::kWorld || IsSilent(known, status.header.utime)) continue;
    for (std::size_t i = 0; i < kNumChannels; ++i) {
      if (kRoles[role].role == Role::kArbitrator && kChannels[i].from != Role::kWorld) continue;
      if (known.lost[i]) reported[role].set(i);
    }
  }
  const auto culprit = FindCulprit(missing, reported);
  return culprit ? std::string(NameOf(culprit->role)) : "";
}

}  // namespace fogline::runtime
