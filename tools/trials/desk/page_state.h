// The contents of the two pages of a session, and the answers that they may give. The class has no
// sockets.
#pragma once

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

/// The state of a session, as its pages see it. Each state has a number, so that an answer to an
/// earlier state is not taken for one to this state.
class PageState {
 public:
  /// @param number of the first state. It must be larger than those of an earlier session, whose
  ///     pages may still be open, and at most 2^53, so that it is exact in a browser
  explicit PageState(std::int64_t number) : number_(number) {}

  /// @param wait_s the rest of a break, s: the next run cannot begin before its end
  void Wait(const Next& next, double wait_s);
  /// The pages of fogline-web for the run can be opened at these addresses.
  /// @param seat "" if the participant does not drive
  void OpenRun(std::string view, std::string seat);
  void Drive() { Enter(Stage::kDriving); }
  /// The pages for the run are at these addresses now. @param seat "" if it cannot be opened now
  void MoveRun(std::string view, std::string seat);
  /// The run is over or broke off. Its pages are gone, and no marker is taken any more.
  void EndRun();
  /// @param after the run that the questions are about
  void Ask(const Next& after, const QuestionnaireSection& questionnaire);
  void Finish();
  /// Adds a line to what the experimenter sees, the newest last. The oldest lines are dropped.
  void Tell(std::string line);

  /// JSON for the page of the participant. It does not contain the condition, the seed, the
  /// threshold or the address of the view.
  std::string ForParticipant() const;
  /// JSON for the page of the experimenter.
  std::string ForExperimenter() const;

  /// Reads a frame of the participant's page: {"op": "begin", "state": n}, or {"op": "answers",
  /// "state": n, "values": ["5", ...]} with a text for each item.
  /// @param why is set if the frame is refused
  std::optional<PageMessage> FromParticipant(std::string_view frame, std::string& why) const;
  /// Reads a frame of the experimenter's page: {"op": "begin", "state": n}, or {"op": "marker",
  /// "text": "..."}.
  std::optional<PageMessage> FromExperimenter(std::string_view frame, std::string& why) const;

 private:
  void Enter(Stage stage);

  Stage stage_ = Stage::kStarting;
  std::int64_t number_;
  Next next_;
  double wait_s_ = 0;
  QuestionnaireSection questionnaire_;
  std::string view_;
  std::string seat_;
  std::vector<std::string> lines_;
};

}  // namespace fogline::trials
