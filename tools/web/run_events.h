// The events of a run, found in its messages: fog, transfers, requests, alarms, manoeuvres,
// emergency braking, collisions. A live run and its log give the same events. If messages are
// missing, the two may differ only in the steps that the text of an event names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fogline/truth_t.hpp"
#include "scenario/sections/person.h"
#include "services/decision/take_over/take_over_log.h"

namespace fogline::web {

struct RunEvent {
  std::size_t number = 0;  // index among the events of the run
  std::int64_t step = 0;
  double time_s = 0;
  std::string_view
      kind;  // "fog", "transfer", "request", "input", "alarm", "manoeuvre", "braking", "collision"
  std::string text;
};

/// Finds the events. Takes the messages of a run in the order of their steps. Messages may be
/// missing. A message that comes again, or too late, is ignored. The first message may be of a step
/// after step 0, for example if a live view starts during the run. The fog, alarm or collision in
/// this message is then no event, because it may have begun before. If messages before an event are
/// missing, the text of the event names the steps in which the event may have happened.
class RunEvents {
 public:
  /// Limit for the stored events. A Degree of Conflict (DoC) that moves around its threshold causes
  /// many alarms.
  static constexpr std::size_t kMost = 5000;

  /// Sets whether a step may have no command although no message is lost, as in real time. If so,
  /// an event that a command shows counts as an event of the step of this command, even if the
  /// steps before have no command. The setting applies to commands that are added afterwards.
  void set_may_lack_commands(bool may_lack) { may_lack_commands_ = may_lack; }
  /// Sets the section of the run's scenario that says whether a person drives. The texts of earlier
  /// events change, too, because a viewer may get the scenario after the first steps.
  void set_person(const PersonSection& person);
  void Add(const truth_t& truth);
  /// @param human_mps2 the driver's offer in this step; nullopt if the offer is unknown
  void Add(const arbitration_t& command, std::optional<double> human_mps2);

  const std::vector<RunEvent>& events() const { return events_; }
  /// Number of events beyond kMost, which are not stored.
  std::size_t left_out() const { return left_out_; }
  const take_over::TakeOverLog& take_over() const { return take_over_; }

 private:
  /// An event of the take-over log. Its text depends on the section of the scenario about the
  /// person.
  struct Change {
    std::size_t place;  // of the event in events_
    take_over::TakeOverEntry entry;
    std::int64_t earliest;  // as in Note()
  };

  /// @param earliest the first step in which the event may have happened
  template <class Message>
  void Note(const Message& message, std::int64_t earliest, std::string_view kind, std::string text);
  void NoteChange(const take_over::TakeOverEntry& entry);
  void NoteCollision(const truth_t& truth, std::int64_t earliest);
  void NoteAlarm(const arbitration_t& command, std::int64_t earliest);

  take_over::TakeOverLog take_over_;
  PersonSection person_;
  std::int64_t truth_step_ = -1;
  std::int64_t command_step_ = -1;
  bool may_lack_commands_ = false;
  bool fog_ = false;
  bool alarm_ = false;
  std::int8_t collision_ = truth_t::COLLISION_NONE;
  std::vector<RunEvent> events_;
  std::vector<Change> changes_;
  std::size_t left_out_ = 0;
};

}  // namespace fogline::web
