#include "tools/cli/run_outcome.h"

#include <stdexcept>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/exit_code.h"
#include "common/process/console.h"
#include "common/text.h"
#include "services/runtime/wire/step_ring.h"
#include "tools/cli/arguments.h"
#include "tools/cli/measures/run_text.h"
#include "tools/cli/measures/take_over_text.h"
#include "tools/report/metric_text.h"

namespace fogline::cli {
namespace {

nlohmann::ordered_json VerificationJson(const replay::Verification& verification) {
  nlohmann::ordered_json json{{"same", nullptr},
                              {"roles", nlohmann::ordered_json::array()},
                              {"left_out", nlohmann::ordered_json::array()},
                              {"trouble", nullptr}};
  if (!verification.roles.empty()) json["same"] = verification.Holds();
  for (const Role role : verification.roles) json["roles"].push_back(NameOf(role));
  for (const replay::Verification::LeftOut& one : verification.left_out) {
    json["left_out"].push_back({{"role", NameOf(one.role)}, {"why", one.why}});
  }
  if (verification.Holds()) return json;
  json["trouble"] = verification.Trouble();
  if (!verification.failure) return json;
  const replay::Difference& first = verification.failure->first;
  json["first"] = {{"role", NameOf(verification.failure->role)},
                   {"step", first.step},
                   {"channel", first.channel},
                   {"field", first.field},
                   {"log", first.a},
                   {"replay", first.b}};
  return json;
}

/// The roles that were computed again, and the roles that were not computed again.
std::string VerificationText(const replay::Verification& verification) {
  std::string text;
  for (const Role role : verification.roles) text += fmt::format(" {}", NameOf(role));
  text = fmt::format("verified:{}\n", text.empty() ? " nothing" : text);
  for (const replay::Verification::LeftOut& one : verification.left_out) {
    text += fmt::format("not verified: {} ({})\n", NameOf(one.role), one.why);
  }
  return text;
}

/// Lines about deviations of a run and about parts that were not checked; "" if there are none.
std::string RemarksText(const RunOutcome& outcome) {
  const runner::RunResult& result = outcome.result;
  std::string text;
  for (const runtime::OtherBuild& other : result.other_builds) {
    text += fmt::format("another build: {}\n", other.Text());
  }
  if (result.verification) text += VerificationText(*result.verification);
  if (outcome.computed && !result.checked) {
    text += "the end of the log is not checked, because the recorder's last report was lost\n";
  }
  return text;
}

}  // namespace

int EndOf(const runner::RunResult& result, std::string_view verb) {
  if (result.realtime && result.realtime->unlogged_messages > 0) {
    throw std::runtime_error(fmt::format(
        "the log is not complete: it lacks at least {} messages that were published; the recorder "
        "heard nothing for longer than the {} steps that it can ask for again",
        result.realtime->unlogged_messages, runtime::kMaxAhead));
  }
  if (!result.verification || result.verification->Holds()) return kDone;
  Complain(fmt::format("fogline {}: error: {}", verb, result.verification->Trouble()));
  return kCheckFailed;
}

nlohmann::ordered_json ToJson(const RunOutcome& outcome) {
  const runner::RunResult& result = outcome.result;
  nlohmann::ordered_json json;
  json["scenario"] = outcome.file.string();
  json["seed"] = result.seed;
  json["transport"] = nullptr;
  if (outcome.computed) json["transport"] = result.transport;
  json["steps"] = result.steps;
  json["resumed_steps"] = nullptr;
  if (outcome.resumed) json["resumed_steps"] = *outcome.resumed;
  json["digest"] = result.digest;
  json["wall_s"] = result.wall_s;
  json["log"] = nullptr;
  if (!result.log.empty()) json["log"] = result.log.string();
  json["repairs"] = result.repairs;
  for (std::size_t i = 0; i < runtime::kRefusals.size(); ++i) {
    json["refused"][std::string(runtime::kRefusals[i].key)] = result.refused[i];
  }
  json["failed_sends"] = nlohmann::ordered_json::array();
  for (const runtime::SendTrouble& one : result.send_troubles) {
    json["failed_sends"].push_back(
        {{"role", one.role}, {"count", one.count}, {"error", one.error}});
  }
  json["strangers"] = nlohmann::ordered_json::array();
  for (const runtime::ForeignPeer& peer : result.foreign_peers) {
    json["strangers"].push_back(
        {{"role", peer.role}, {"pid", peer.pid}, {"host", peer.host}, {"run_id", peer.run_id}});
  }
  json["restarts"] = nlohmann::ordered_json::array();
  for (const runner::Restarts& role : result.restarts) {
    json["restarts"].push_back({{"role", role.role}, {"count", role.count}, {"last", role.last}});
  }
  json["log_checked"] = result.checked;
  json["other_builds"] = nlohmann::ordered_json::array();
  for (const runtime::OtherBuild& other : result.other_builds) {
    json["other_builds"].push_back({{"role", NameOf(other.role)},
                                    {"pid", other.pid},
                                    {"host", other.host},
                                    {"build", BuildJson(other.build)},
                                    {"expected", BuildJson(other.ours)}});
  }
  json["verified"] = nullptr;
  if (result.verification) json["verified"] = VerificationJson(*result.verification);
  if (result.realtime) json["realtime"] = RealtimeJson(*result.realtime);
  AddTakeOvers(result, json);
  json["metrics"] = nlohmann::ordered_json::parse(MetricsJson(result));
  return json;
}

std::string ToText(const RunOutcome& outcome) {
  const runner::RunResult& result = outcome.result;
  std::string text =
      fmt::format("{}: {}{} steps", PathText(outcome.file), result.steps,
                  result.steps < outcome.steps ? fmt::format(" of {}", outcome.steps) : "");
  if (outcome.resumed) text += fmt::format(", {} of them from the log", *outcome.resumed);
  if (outcome.computed) {
    text += fmt::format(" in {:.2f} s over {}, {} repairs", result.wall_s, result.transport,
                        result.repairs);
  }
  const std::string collision = report::CollisionText(result.measures);
  if (!collision.empty()) text += ": " + collision;
  text += '\n';
  std::string refused;
  for (std::size_t i = 0; i < runtime::kRefusals.size(); ++i) {
    if (result.refused[i] == 0) continue;
    refused += fmt::format("{}{} {}", refused.empty() ? "" : ", ", result.refused[i],
                           runtime::kRefusals[i].what);
  }
  if (!refused.empty()) text += fmt::format("refused messages: {}\n", refused);
  if (!result.send_troubles.empty()) {
    text += fmt::format("messages that could not be sent: {}\n", Text(result.send_troubles));
  }
  for (const runner::Restarts& role : result.restarts) {
    text += fmt::format("{} was started again {}: {}\n", role.role,
                        role.count == 1 ? "once" : fmt::format("{} times", role.count), role.last);
  }
  text += RemarksText(outcome);
  if (result.realtime) text += RealtimeText(*result.realtime);
  text += fmt::format("digest {}\n", result.digest);
  if (!result.log.empty()) text += fmt::format("log    {}\n", PathText(result.log));
  return text + MetricsText(result) + TakeOversText(result);
}

int PrintOutcome(const RunOutcome& outcome, bool json, std::string_view verb) {
  if (json) {
    PrintJson(ToJson(outcome));
  } else {
    fmt::print("{}", ToText(outcome));
  }
  return EndOf(outcome.result, verb);
}

}  // namespace fogline::cli
