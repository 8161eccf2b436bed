// A desk: the interface between a session and its participant and experimenter, in a terminal or in
// pages of a browser.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/interrupt.h"
#include "scenario/sections/plans/experiment.h"
#include "tools/trials/questionnaires.h"
#include "tools/trials/schedule.h"
#include "tools/trials/speaker.h"

namespace fogline::trials {

/// The facts about the next run. The participant may know all of them except `for_experimenter`.
struct Next {
  Trial trial;
  std::int64_t of = 1;           // number of trials, or of practice runs
  double not_before_s = 0;       // in a break: least time until the run begins
  bool seat = false;             // whether the participant drives, at the seat in the browser
  std::string for_experimenter;  // the condition and its seed; never shown to the participant
};

/// @throws Interrupted after a signal that asks this process to end
inline void ThrowIfInterrupted() {
  if (WasInterrupted()) throw Interrupted("interrupted; the same command continues from here");
}

class Desk {
 public:
  virtual ~Desk() = default;

  /// Returns when the run may begin.
  /// @throws Interrupted; std::runtime_error if the desk can receive no further answer
  virtual void WaitForBegin(const Next& next) = 0;
  /// Called when the run has a network, before the roles start. Returns when the roles may start.
  /// If the participant drives at the seat of the page, the roles may start when the participant is
  /// ready there.
  /// @throws as WaitForBegin()
  virtual void RunOpens(std::int64_t run_id, const std::string& url) = 0;
  /// Called when the run begins. The experimenter's markers can be given to `speaker`
  /// (Speaker::Mark()) until RunEnded().
  virtual void RunBegins(Speaker& speaker) = 0;
  /// Called repeatedly during the run, from the first step of the log on.
  virtual void RunGoesOn() = 0;
  /// Called when the run has ended, also if it broke off.
  virtual void RunEnded() = 0;
  /// Asks the questions of a questionnaire.
  /// @param after the run that the questions are about
  /// @return the answers to all items, in the order of the items
  /// @throws as WaitForBegin()
  virtual std::vector<Answer> Ask(const Next& after, const QuestionnaireSection& questionnaire) = 0;
  /// Called when the participant has made all trials.
  virtual void Finish() = 0;
};

}  // namespace fogline::trials
