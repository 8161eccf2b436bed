#include "tools/watch/health_text.h"

#include <algorithm>

#include <fmt/core.h>

#include "common/text.h"
#include "services/host_modes.h"

namespace fogline::watch {
namespace {

constexpr double kSecondsPerMs = 1e-3;
constexpr double kSecondsPerUs = 1e-6;

void AddIfAny(std::int64_t count, std::string_view what, std::vector<std::string>& remarks) {
  if (count != 0) remarks.push_back(fmt::format("{} {}", count, what));
}

/// The inputs in this state, such as "RADAR 1.2 s, LIDAR 0.3 s".
std::string InputsIn(std::int8_t state, const status_t& status) {
  std::string inputs;
  for (std::size_t i = 0; i < status.input.size(); ++i) {
    if (status.input_state[i] != state) continue;
    inputs += fmt::format("{}{} {:.1f} s", inputs.empty() ? "" : ", ", Printable(status.input[i]),
                          kSecondsPerUs * static_cast<double>(status.input_age_us[i]));
  }
  return inputs;
}

/// Adds remarks on a role in real time, from its STATUS.
void AddRealtime(const status_t& status, std::vector<std::string>& remarks) {
  if (!status.fallback.empty()) remarks.push_back(Printable(status.fallback));
  if ((status.minimal_risk & status_t::HOST) != 0) remarks.emplace_back("host stops");
  if ((status.minimal_risk & status_t::FOLLOWER) != 0) remarks.emplace_back("follower stops");
  const std::string lost = InputsIn(status_t::INPUT_LOST, status);
  if (!lost.empty()) remarks.push_back("LOST " + lost);
  const std::string stale = InputsIn(status_t::INPUT_STALE, status);
  if (!stale.empty()) remarks.push_back("stale " + stale);
  AddIfAny(status.ticks_late, "late steps", remarks);
  AddIfAny(status.ticks_missed, "missed ticks", remarks);
  AddIfAny(status.deadline_misses, "missed deadlines", remarks);
  std::int64_t late = 0;
  for (const std::int64_t count : status.input_late) late += count;
  AddIfAny(late, "late inputs", remarks);
}

}  // namespace

std::vector<std::string> RemarksOn(const RoleView& role, bool realtime) {
  const status_t& status = role.status;
  std::vector<std::string> remarks;
  if (role.silent) remarks.push_back(fmt::format("silent for {:.1f} s", role.age_s));
  if (!status.error.empty()) remarks.push_back(Printable(status.error));
  if (realtime) AddRealtime(status, remarks);
  if (!realtime && !status.waiting_for.empty()) {
    remarks.push_back(fmt::format("waits for {} for {:.1f} s", Printable(status.waiting_for),
                                  kSecondsPerMs * static_cast<double>(status.waiting_ms)));
  }
  for (const runtime::RefusalKind& kind : runtime::kRefusals) {
    const std::int64_t count = status.*kind.counter;
    if (count != 0) remarks.push_back(fmt::format("refused {} {}", count, kind.what));
  }
  if (status.sends_failed != 0) {
    remarks.push_back(
        fmt::format("could not send {} ({})", status.sends_failed, Printable(status.send_error)));
  }
  AddIfAny(status.repairs_asked, "repairs asked", remarks);
  return remarks;
}

std::string RemarksText(const RoleView& role, bool realtime) {
  std::string text;
  for (const std::string& remark : RemarksOn(role, realtime)) {
    text += (text.empty() ? "" : "; ") + remark;
  }
  return text;
}

std::string SpeedText(const RunView& run) {
  if (run.realtime) return fmt::format("real time x{:g}", run.pace);
  return run.pace > 0 ? fmt::format("pace {:g}", run.pace) : "full speed";
}

bool IsUnwell(const RoleView& role) {
  const status_t& status = role.status;
  return role.silent || status.state == status_t::FAILED || !status.fallback.empty() ||
         std::ranges::find(status.input_state, status_t::INPUT_LOST) != status.input_state.end();
}

std::string WhoDrives(const RunView& run) {
  const auto host =
      std::ranges::find(run.channels, ChannelOf<arbitration_t>().name, &ChannelView::channel);
  arbitration_t command{};
  if (host == run.channels.end() || !runtime::Decode(host->newest, command)) return "";
  if (InMinimalRisk(command.mode)) return "a minimal risk manoeuvre";
  const bool human = HumanDrives(command.lambda_human);
  const std::string_view driver = human ? "the human drives" : "the automation drives";
  if (command.mode == arbitration_t::EMERGENCY_BRAKING) {
    return fmt::format("{}, emergency braking", driver);
  }
  if (command.mode == arbitration_t::COLLISION_WARNING) {
    return fmt::format("{}, collision warning", driver);
  }
  const bool asked =
      command.mode >= arbitration_t::REQUEST && command.mode <= arbitration_t::HANDOVER;
  return fmt::format("{}{}", driver, asked ? ", the human is asked" : "");
}

}  // namespace fogline::watch
