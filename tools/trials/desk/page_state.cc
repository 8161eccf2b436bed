#include "tools/trials/desk/page_state.h"

#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/text.h"
#include "services/runtime/wire/trial.h"

namespace fogline::trials {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNoRun = "no run is under way";
constexpr const char* kNotNow = "the session does not wait for this now";
// The least remaining time of a break that a page gets, s. The session ends the break. Until then
// the remaining time stays above 0, because at 0 the page lets the participant begin.
constexpr double kLeastWait_s = 0.1;
// Largest number of lines on the experimenter's page.
constexpr std::size_t kMostLines = 200;

std::string_view WordOf(Stage stage) {
  switch (stage) {
    case Stage::kStarting:
      return "starting";
    case Stage::kWaiting:
      return "waiting";
    case Stage::kSeating:
      return "seating";
    case Stage::kDriving:
      return "driving";
    case Stage::kEnded:
      return "ended";
    case Stage::kAsking:
      return "asking";
    case Stage::kFinished:
      return "finished";
  }
  return "";
}

Json JsonOf(const ItemSection& item) {
  return {{"name", item.name},
          {"text", item.text},
          {"kind", item.kind == ItemKind::kText ? "text" : "scale"},
          {"min", item.min},
          {"max", item.max},
          {"step", item.step},
          {"low", item.low},
          {"high", item.high}};
}

/// A frame as JSON; null if it is not an object.
Json Parse(std::string_view frame) {
  Json json = Json::parse(frame, nullptr, false);
  return json.is_object() ? json : Json();
}

/// The text in a member of an object. "" if the member is missing or is not a text.
std::string Text(const Json& json, const char* name) {
  const auto member = json.find(name);
  return member != json.end() && member->is_string() ? member->get<std::string>() : "";
}

}  // namespace

void PageState::Enter(Stage stage) {
  stage_ = stage;
  ++number_;
}

void PageState::Wait(const Next& next, double wait_s) {
  next_ = next;
  breaks_ = wait_s > 0;
  break_end_ =
      Clock::now() + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(wait_s));
  Enter(Stage::kWaiting);
}

double PageState::Wait_s(TimePoint now) const {
  if (stage_ != Stage::kWaiting || !breaks_) return 0;
  return std::max(kLeastWait_s, Seconds(break_end_ - now));
}

void PageState::OpenRun(std::string view, std::string seat) {
  view_ = std::move(view);
  seat_ = std::move(seat);
  if (next_.seat) Enter(Stage::kSeating);
}

void PageState::MoveRun(std::string view, std::string seat) {
  view_ = std::move(view);
  seat_ = std::move(seat);
  if (next_.seat) ++number_;
}

void PageState::EndRun() {
  view_.clear();
  seat_.clear();
  Enter(Stage::kEnded);
}

void PageState::Ask(const Next& after, const QuestionnaireSection& questionnaire) {
  next_ = after;
  questionnaire_ = questionnaire;
  Enter(Stage::kAsking);
}

void PageState::Finish() { Enter(Stage::kFinished); }

void PageState::Tell(std::string line, std::chrono::system_clock::time_point at) {
  using std::chrono::milliseconds;
  if (lines_.size() == kMostLines) lines_.erase(lines_.begin());
  const auto at_ms = std::chrono::floor<milliseconds>(at.time_since_epoch()).count();
  lines_.push_back({at_ms, std::move(line)});
}

std::string PageState::ForParticipant(TimePoint now) const {
  Json json{
      {"state", number_},          {"stage", WordOf(stage_)}, {"practice", next_.trial.practice},
      {"run", next_.trial.number}, {"of", next_.of},          {"drives", next_.seat}};
  const bool is_run = stage_ == Stage::kSeating || stage_ == Stage::kDriving;
  if (next_.seat && is_run) json["seat"] = seat_;
  if (stage_ == Stage::kWaiting) json["wait_s"] = Wait_s(now);
  if (stage_ == Stage::kAsking) {
    json["items"] = Json::array();
    for (const ItemSection& item : questionnaire_.items) json["items"].push_back(JsonOf(item));
  }
  return json.dump();
}

std::string PageState::ForExperimenter(TimePoint now) const {
  Json lines = Json::array();
  for (const Line& line : lines_) lines.push_back({{"at_ms", line.at_ms}, {"text", line.text}});
  return Json{{"state", number_},
              {"stage", WordOf(stage_)},
              {"participant", next_.trial.participant},
              {"drives", next_.seat},
              {"practice", next_.trial.practice},
              {"run", next_.trial.number},
              {"of", next_.of},
              {"wait_s", Wait_s(now)},
              {"condition", next_.for_experimenter},
              {"questionnaire", stage_ == Stage::kAsking ? questionnaire_.name : ""},
              {"view", view_},
              {"lines", std::move(lines)}}
      .dump();
}

std::optional<PageMessage> PageState::FromParticipant(std::string_view frame,
                                                      std::string& why) const {
  const Json json = Parse(frame);
  const std::string op = Text(json, "op");
  const auto state = json.find("state");
  if (state == json.end() || *state != number_) {
    why = "it answers another state";
    return std::nullopt;
  }
  if (op == "begin" && stage_ == Stage::kWaiting && breaks_) {
    why = "the break is not over";
    return std::nullopt;
  }
  if (op == "begin" && stage_ == Stage::kWaiting) {
    return PageMessage{.kind = PageMessage::Kind::kBegin, .answers = {}, .text = ""};
  }
  const auto values = json.find("values");
  if (op != "answers" || stage_ != Stage::kAsking) {
    why = kNotNow;
    return std::nullopt;
  }
  const std::size_t wanted = questionnaire_.items.size();
  if (values == json.end() || !values->is_array() || values->size() != wanted) {
    why = fmt::format("the number of answers is not {}", wanted);
    return std::nullopt;
  }
  PageMessage message{.kind = PageMessage::Kind::kAnswers, .answers = {}, .text = ""};
  for (std::size_t i = 0; i < values->size(); ++i) {
    const ItemSection& item = questionnaire_.items[i];
    const Json& value = (*values)[i];
    std::string allowed;
    const auto answer =
        value.is_string() ? ReadAnswer(item, value.get<std::string>(), allowed) : std::nullopt;
    if (!answer) {
      why = fmt::format("{} needs {}", item.name, allowed.empty() ? "a text" : allowed);
      return std::nullopt;
    }
    message.answers.push_back(*answer);
  }
  return message;
}

std::optional<PageMessage> PageState::FromExperimenter(std::string_view frame,
                                                       std::string& why) const {
  const Json json = Parse(frame);
  const std::string op = Text(json, "op");
  const auto state = json.find("state");
  const bool can_begin = stage_ == Stage::kWaiting && !breaks_;
  if (op == "begin" && can_begin && state != json.end() && *state == number_) {
    return PageMessage{.kind = PageMessage::Kind::kBegin, .answers = {}, .text = ""};
  }
  const std::string text = Text(json, "text");
  if (op != "marker") {
    why = kNotNow;
  } else if (stage_ != Stage::kDriving) {
    why = kNoRun;
  } else if (text.empty() || HasControlCharacter(text) ||
             text.size() > runtime::kMostTrialTextBytes) {
    why = fmt::format("a marker needs a text of 1 to {} bytes without control characters",
                      runtime::kMostTrialTextBytes);
  } else {
    return PageMessage{.kind = PageMessage::Kind::kMarker, .answers = {}, .text = text};
  }
  return std::nullopt;
}

}  // namespace fogline::trials
