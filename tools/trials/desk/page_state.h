// The contents of the two pages of a session, and the check of the pages' messages. The class has
// no sockets.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/trials/desk/desk.h"

namespace fogline::trials {

/// The phase of a session. At kSeating the participant goes to the seat, and the run waits. kEnded
/// is the moment between a run and its questions.
enum class Stage { kStarting, kWaiting, kSeating, kDriving, kEnded, kAsking, kFinished };

/// A message of a page, after its check.
struct PageMessage {
  enum class Kind { kBegin, kAnswers, kMarker };
  Kind kind;
  std::vector<Answer> answers;  // kAnswers
  std::string text;             // kMarker
};

/// The state of a session, as its pages see it. Each state has a number. A page sends this number
/// with its answer. So PageState recognises an answer to an earlier state.
class PageState {
 public:
  /// @param number of the first state. It must be larger than the numbers of earlier sessions,
  ///     because their pages may still be open. It must be at most 2^53, so that it is exact in a
  ///     browser
  explicit PageState(std::int64_t number) : number_(number) {}

  /// @param wait_s remaining time of a break, s. The next run cannot begin before the end of this
  /// time
  void Wait(const Next& next, double wait_s);
  /// Shows the addresses at which the pages of fogline-web for the run can be opened.
  /// @param seat "" if the participant does not drive
  void OpenRun(std::string view, std::string seat);
  void Drive() { Enter(Stage::kDriving); }
  /// Shows the new addresses of the pages for the run.
  /// @param seat "" if the seat cannot be opened at present
  void MoveRun(std::string view, std::string seat);
  /// Ends the run, which is complete or broke off. Removes the addresses of its pages. From now on,
  /// markers are refused.
  void EndRun();
  /// @param after the run that the questions are about
  void Ask(const Next& after, const QuestionnaireSection& questionnaire);
  void Finish();
  /// Adds a line at the end of the lines that the experimenter sees. If there are too many lines,
  /// the oldest ones are removed.
  /// @param at the time that the experimenter sees beside the line
  void Tell(std::string line,
            std::chrono::system_clock::time_point at = std::chrono::system_clock::now());

  /// JSON for the page of the participant. It does not contain the condition, the seed, the
  /// threshold or the address of the view.
  /// @param now the time at which a page begins to count a break down
  std::string ForParticipant(TimePoint now = Clock::now()) const;
  /// JSON for the page of the experimenter.
  std::string ForExperimenter(TimePoint now = Clock::now()) const;

  /// Reads a frame of the participant's page: {"op": "begin", "state": n}, or {"op": "answers",
  /// "state": n, "values": ["5", ...]} with a text for each item.
  /// @param why is set if the frame is refused
  std::optional<PageMessage> FromParticipant(std::string_view frame, std::string& why) const;
  /// Reads a frame of the experimenter's page: {"op": "begin", "state": n}, or {"op": "marker",
  /// "text": "..."}.
  std::optional<PageMessage> FromExperimenter(std::string_view frame, std::string& why) const;

 private:
  /// A line that the experimenter sees.
  struct Line {
    std::int64_t at_ms;  // since 1970
    std::string text;
  };

  void Enter(Stage stage);
  /// In kWaiting: the remaining time of the break, s; 0 only if the next run can begin. In
  /// the other stages: 0.
  double Wait_s(TimePoint now) const;

  Stage stage_ = Stage::kStarting;
  std::int64_t number_;
  Next next_;
  bool breaks_ = false;  // whether a break delays the next run
  TimePoint break_end_;
  QuestionnaireSection questionnaire_;
  std::string view_;
  std::string seat_;
  std::vector<Line> lines_;
};

}  // namespace fogline::trials
