// A desk: a session talks to the people there, in a terminal or in pages of a browser.
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

/// A run, as the participant may know it: without condition and threshold.
struct Next {
  Trial trial;
  std::int64_t of = 1;           // number of trials, or of practice runs
  double not_before_s = 0;       // a break: least time until the run begins
  bool seat = false;             // the participant drives, at the seat of the page
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
  /// @throws Interrupted; std::runtime_error if no answer can come any more
  virtual void WaitForBegin(const Next& next) = 0;
  /// The run has a network, and no role yet. Returns when the roles may begin: if the participant
  /// drives at the seat of the page, when they are ready there.
  /// @throws as WaitForBegin()
  virtual void RunOpens(std::int64_t run_id, const std::string& url) = 0;
  /// The run begins. The speaker takes markers until RunEnded().
  virtual void RunBegins(Speaker& speaker) = 0;
  /// Called again and again from the first step of the log on.
  virtual void RunGoesOn() = 0;
  /// Also called if the run breaks off.
  virtual void RunEnded() = 0;
  /// The answers to all items, in their order. @param after the run that they are about
  /// @throws as WaitForBegin()
  virtual std::vector<Answer> Ask(const Next& after, const QuestionnaireSection& questionnaire) = 0;
  /// The participant has made all trials.
  virtual void Finish() = 0;
};

}  // namespace fogline::trials
