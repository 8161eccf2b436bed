// A session of `fogline experiment` whose pages the test opens.
#pragma once

#include <chrono>
#include <csignal>
#include <cstdint>
#include <optional>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/children.h"
#include "tests/support/command.h"
#include "tests/support/web_client.h"

namespace fogline::test {

class PageSession {
 public:
  /// Starts `command`, which is a `fogline experiment run`, and opens both pages.
  explicit PageSession(const std::vector<std::string>& command) : session_(command) {
    if (!session_.WaitForOut("experimenter: http://127.0.0.1:")) {
      throw std::runtime_error(session_.Err());
    }
    static const std::regex lines(
        "participant: http://127.0.0.1:(\\d+)/#token=([0-9a-f]{32})\n"
        "experimenter: http://127.0.0.1:(\\d+)/#token=([0-9a-f]{32})\n");
    std::smatch parts;
    const std::string out = session_.Out();
    if (!std::regex_search(out, parts, lines)) throw std::runtime_error(out);
    participant_port_ = static_cast<std::uint16_t>(std::stoi(parts[1]));
    participant_token_ = parts[2];
    experimenter_port_ = static_cast<std::uint16_t>(std::stoi(parts[3]));
    experimenter_token_ = parts[4];
    participant_.emplace(
        participant_port_,
        WebClient::Options{.target = SocketTarget(participant_token_), .protocol = ""});
    experimenter_.emplace(
        experimenter_port_,
        WebClient::Options{.target = SocketTarget(experimenter_token_), .protocol = ""});
  }

  /// The target of a WebSocket with a token.
  static std::string SocketTarget(const std::string& token) { return "/ws?token=" + token; }

  /// Waits for a state of the participant's page whose number is not `known`. @return this state
  nlohmann::json NextState(std::int64_t known) {
    for (;;) {
      auto state = nlohmann::json::parse(participant_->Receive().bytes);
      if (state["state"] != known) return state;
    }
  }

  void Begin(const nlohmann::json& state) {
    participant_->Send(nlohmann::json{{"op", "begin"}, {"state", state["state"]}}.dump());
  }
  /// Answers item i with `least` + i, or with five times this value if the items are the scales of
  /// workload.
  void Answer(const nlohmann::json& state, int least) {
    nlohmann::json values = nlohmann::json::array();
    const bool is_tlx = state["items"].size() == 6;
    for (std::size_t i = 0; i < state["items"].size(); ++i) {
      const int value = least + static_cast<int>(i);
      values.push_back(std::to_string(is_tlx ? 5 * value : value));
    }
    participant_->Send(
        nlohmann::json{{"op", "answers"}, {"state", state["state"]}, {"values", values}}.dump());
  }

  /// Kills the fogline-web of this session.
  void KillView() const {
    for (const pid_t child : ChildrenOf(session_.pid())) {
      const std::string name = Content("/proc/" + std::to_string(child) + "/comm");
      if (name == "fogline-web\n") SignalOne(child, SIGKILL);
    }
  }

  /// Waits until the experimenter's page shows this line. @throws std::runtime_error after
  /// kPatience
  void WaitForLine(const std::string& line) {
    for (const auto end = std::chrono::steady_clock::now() + kPatience;
         std::chrono::steady_clock::now() < end;) {
      const auto state = nlohmann::json::parse(experimenter_->Receive().bytes);
      for (const auto& shown : state["lines"]) {
        if (shown["text"] == line) return;
      }
    }
    throw std::runtime_error("no line \"" + line + "\" comes");
  }

  Background& process() { return session_; }
  WebClient& experimenter() { return *experimenter_; }
  std::uint16_t participant_port() const { return participant_port_; }
  const std::string& participant_token() const { return participant_token_; }
  const std::string& experimenter_token() const { return experimenter_token_; }
  std::uint16_t experimenter_port() const { return experimenter_port_; }

 private:
  Background session_;
  std::uint16_t participant_port_ = 0;
  std::uint16_t experimenter_port_ = 0;
  std::string participant_token_;
  std::string experimenter_token_;
  std::optional<WebClient> participant_;
  std::optional<WebClient> experimenter_;
};

}  // namespace fogline::test
