// The runner's side of a run: announces the scenario, waits until every role is ready, lets the
// world start, follows everybody's STATUS, tells who joins late how far the run is, and names the
// culprit when a step does not complete.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/graph.h"
#include "services/runtime/bus.h"
#include "services/runtime/clock.h"
#include "services/runtime/deaf_roles.h"
#include "services/runtime/other_build.h"
#include "services/runtime/own_pauses.h"
#include "services/runtime/refusals.h"
#include "services/runtime/scenario_parts.h"
#include "services/runtime/send_trouble.h"
#include "services/runtime/signs_of_life.h"
#include "services/runtime/step_ring.h"
#include "services/runtime/strangers.h"

namespace fogline {

struct ConductorOptions {
  std::int64_t run_id = 0;
  std::string scenario_text;      // the effective scenario
  std::int64_t steps = kMaxStep;  // of it
  std::int64_t progress = -1;     // last step that is known to have begun
  // What it says is newer than this: what another runner of the same run has said.
  std::int64_t sequence = 0;
  double pace = 0;                            // simulated seconds per second; 0: as fast as it goes
  bool realtime = false;                      // at that pace, whoever keeps up
  Duration period{};                          // of a step then, on the wall clock
  Duration join_limit{};                      // for the roles to be ready; 0: no limit
  Duration stall_limit = milliseconds(4000);  // without a completed step of any role
  std::vector<Role> external;                 // roles that somebody else starts, and starts again
  int restarts = 0;                           // how often, at most, each of these
  RoleBuilds builds{};                        // that the roles should be of
  bool same_build = false;                    // whether another one ends the run
};

class Conductor {
 public:
  enum class Phase { kJoining, kRunning, kDone, kFailed };

  Conductor(Bus& bus, ConductorOptions options);

  /// Does what is due. Call it after every Bus::Wait(). @return when to be called again at the
  /// latest
  TimePoint Poll(TimePoint now);

  /// Notes that the runner looks at the clock. Between two looks far apart it was held up itself
  /// (a suspended machine, a disk, Ctrl-Z), which is held against nobody.
  void Attend(TimePoint now) { pauses_.Attend(now); }
  /// Time since then in which something could have been heard.
  Duration HeldAgainst(TimePoint since, TimePoint now) const {
    return pauses_.HeldAgainst(since, now);
  }
  /// How likely it is that a role that has been silent for so long speaks, and the network loses
  /// what it says.
  double ChanceOfLife(Role role, Duration silence) const {
    return signs_of_life_.ChanceOfLife(role, silence);
  }
  /// In real time: what a role does not hear although others publish it, if that has lasted.
  std::optional<Deafness> Deaf(Role role) const { return deaf_.Of(role); }
  /// The longest time that the runner was held up since the last call, 0 if it was not.
  Duration TakeAway() { return pauses_.TakeLongest(); }

  Phase phase() const { return phase_; }
  /// What went wrong, one line. Empty unless phase() is kFailed.
  const std::string& error() const { return error_; }
  /// Last step that the world has begun, -1 before the first.
  std::int64_t step() const { return progress_; }
  /// The same for a message: "at step 217", or "before step 0".
  std::string Where() const;
  /// Names of the roles that have not reported ready.
  std::string NotReady() const;
  /// Roles that others start and that are not there: never heard of, or silent while the run goes
  /// on.
  std::vector<Role> Awaited(TimePoint now) const;
  /// Sum over the roles of a counter of status_t.
  std::int64_t Total(std::int64_t status_t::*counter) const;
  /// Messages that the roles and the runner have refused.
  Refusals Refused() const;
  /// What could not be sent, by the roles and the runner; those that could send all are left out.
  std::vector<SendTrouble> SendTroubles() const;
  /// What is wrong with keys and signatures, "" if nothing is known to be.
  std::string KeyTrouble() const;
  /// Who is of another run and speaks on this network.
  const Strangers& strangers() const { return strangers_; }
  /// The builds that the roles should be of.
  const RoleBuilds& builds() const { return options_.builds; }
  /// Whether the run goes on when this role is gone for good. In real time it does, unless the road
  /// or the log is gone.
  bool GoesOnWithout(Role role) const {
    return options_.realtime && phase_ == Phase::kRunning && role != Role::kWorld &&
           role != Role::kRecorder;
  }
  /// Tells every role to leave; may be repeated.
  void Stop();
  /// Ends the run with an error from outside, such as the death of a process.
  void Fail(std::string error);
  /// The role's process on this machine is dead and will be started again: what is still on its way
  /// from it is ignored, another instance may take its place.
  void Bury(Role role, std::int32_t pid, TimePoint now);
  /// Why the role cannot be started again for now, for the message if that does not change.
  void Hinder(Role role, std::string why);
  /// The role has been started again, as this process on this machine.
  void Launched(Role role, std::int32_t pid, TimePoint now);
  /// Calls `handler` for every STATUS that counts, in the order of its sender.
  void OnEveryStatus(std::function<void(const status_t&)> handler) {
    on_status_ = std::move(handler);
  }
  /// Whether any instance of the role has been heard of.
  bool Met(Role role) const { return member(role).status || !member(role).dead.empty(); }

  /// A role's process as its STATUS tells it.
  struct Member {
    std::optional<status_t> status;  // the last one of the instance that counts
    TimePoint heard{};
    std::vector<status_t> dead;      // the last ones of instances that are dead
    std::vector<std::int32_t> pids;  // of processes on this machine that are dead
    std::optional<status_t> rival;   // another instance that says that it is this role, and when
    TimePoint rival_since{};
    TimePoint rival_heard{};
    std::optional<TimePoint> undead;  // one that is dead speaks, since then; and when last
    std::int64_t undead_instance = 0;
    TimePoint undead_heard{};
    std::string hindrance;  // why it cannot be started again for now
    int replaced = 0;       // times that an external role was started again, and when last
    TimePoint replaced_at{};
  };
  const Member& member(Role role) const { return members_[static_cast<std::size_t>(role)]; }

 private:
  // A role without a STATUS for this long (five heartbeats) counts as silent.
  static constexpr Duration kSilent = milliseconds(1000);

  void Refuse(RefusalCounter kind) { ++(own_.*kind); }
  void OnStatus(const status_t& heard);
  /// The newest step that a role can have computed.
  std::int64_t NewestPossible(TimePoint now) const;
  /// Ends the run when the world is done and, in lockstep, the recorder has told what it has
  /// written of the last step. The log is compared with that.
  void FinishWhenRecorded(TimePoint now);
  /// The last step is over and recorded.
  void OnDone();
  /// The role has failed and said so.
  void OnFailure(Role role, const status_t& status);
  void OnResend(Bytes bytes);
  bool AllReady(TimePoint now) const;
  /// Whether the run cannot begin or go on because this role is not there.
  bool Lacks(Role role, TimePoint now) const;
  bool IsExternal(Role role) const;
  /// Whether the STATUS may speak for its role; false if it comes from a dead or second instance.
  bool Admit(Role role, const status_t& status, TimePoint now);
  /// The same for one that the role's present process has not sent.
  bool AdmitOther(Role role, const status_t& status, TimePoint now);
  /// A process that is believed to be dead speaks.
  void OnUndead(Role role, const status_t& status, TimePoint now);
  void FailForTwo(const status_t& one, const status_t& other);
  bool HasRival(Role role, TimePoint now) const;
  /// Instance of the process that is an external role; 0 while none is.
  std::int64_t HolderOf(Role role, TimePoint now) const;
  void AnnounceWhenDue(TimePoint now);
  void Announce(std::size_t part, std::int64_t answer_to = 0);
  void Announce(std::int8_t phase, std::size_t part, std::int64_t answer_to = 0);
  /// Why the role is not there, to be added to a message; "" if nothing is known.
  std::string HindranceOf(Role role) const;
  /// The one line that says who holds up the run.
  std::string Culprit(TimePoint now) const;

  Bus& bus_;
  ConductorOptions options_;
  std::vector<std::string> parts_;
  std::string hash_;
  std::array<Member, kRoles.size()> members_;
  SignsOfLife signs_of_life_;
  DeafRoles deaf_;
  Strangers strangers_;
  status_t own_{};  // what the runner itself has refused
  std::string host_;
  Phase phase_ = Phase::kJoining;
  TimePoint going_since_{};       // the first GO
  bool ready_ = false;            // every role, when last looked at
  std::int8_t minimal_risk_ = 0;  // cars, as in status_t
  std::function<void(const status_t&)> on_status_;
  std::string error_;
  TimePoint began_;
  OwnPauses pauses_;
  TimePoint announce_at_{};
  TimePoint parts_at_{};
  std::optional<TimePoint> ask_recorder_at_;  // since the world is done
  std::int64_t sequence_;                     // of what it has said
  std::int64_t progress_;
  TimePoint progressed_{};
  std::vector<std::uint8_t> buffer_;
};

}  // namespace fogline
