// The coordinator of a run, a part of the runner. It announces the scenario, waits until every role
// is ready, and lets the world start. It reads the STATUS of every role, and tells a late role the
// step that the run has reached. If a step does not complete, the coordinator names the role that
// is to blame.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "common/own_pauses.h"
#include "services/graph.h"
#include "services/runtime/coordination/deaf_roles.h"
#include "services/runtime/coordination/foreign_peers.h"
#include "services/runtime/coordination/send_trouble.h"
#include "services/runtime/coordination/signs_of_life.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/other_build.h"
#include "services/runtime/wire/refusals.h"
#include "services/runtime/wire/scenario_parts.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

struct RunCoordinatorOptions {
  std::int64_t run_id = 0;
  std::string scenario_text;      // the effective scenario
  std::int64_t steps = kMaxStep;  // number of steps of the scenario
  std::int64_t progress = -1;     // last step that is known to have begun
  // The sequence numbers of this runner's RUN messages begin above this number. An earlier runner
  // of the same run has not used higher numbers.
  std::int64_t sequence = 0;
  double pace = 0;        // simulated seconds per second; 0: no limit
  bool realtime = false;  // whether this is a run in real time
  Duration period{};      // duration of a step in real time, on the wall clock
  // Longest wait until all roles are ready; 0: no limit. The time counts from the latest of three
  // moments: the beginning, the last progress, and the last moment at which an external role was
  // awaited.
  Duration join_limit{};
  Duration prepare_limit{};                   // replaces join_limit while AllPrepare() is true
  Duration stall_limit = milliseconds(4000);  // longest time in which no role completes a step
  std::vector<Role> external;                 // roles that are started elsewhere
  int restarts = 0;                           // largest number of restarts of each external role
  RoleBuilds builds{};                        // expected builds of the roles
  bool same_build = false;                    // whether a role of another build ends the run
};

class RunCoordinator {
 public:
  enum class Phase { kJoining, kRunning, kDone, kFailed };

  RunCoordinator(Bus& bus, RunCoordinatorOptions options);

  /// Does the work that is due. Call this function after every Bus::Wait(). @return the latest time
  /// for the next call
  TimePoint Poll(TimePoint now);

  /// Notes that the runner reads the clock. If two readings are far apart, the runner itself was
  /// paused, for example by a slow disk or Ctrl-Z. The time between these readings does not count
  /// against any role.
  void Attend(TimePoint now) { pauses_.Attend(now); }
  /// The time since `since` in which this process could have received a message.
  Duration HeldAgainst(TimePoint since, TimePoint now) const {
    return pauses_.HeldAgainst(since, now);
  }
  /// The probability that the network loses all messages that a living role sends in the time
  /// `silence`. If the probability is very small, the silent role is probably dead.
  double ChanceOfLife(Role role, Duration silence) const {
    return signs_of_life_.ChanceOfLife(role, silence);
  }
  /// The channel on which the role is deaf: the role receives no message, although the producer
  /// sends messages. nullopt if the role is not deaf, or the run is not in real time.
  std::optional<Deafness> Deaf(Role role) const { return deaf_.Of(role); }
  /// The longest pause of the runner since the last call; 0 if there was no pause.
  Duration TakeLongestPause() { return pauses_.TakeLongest(); }

  Phase phase() const { return phase_; }
  /// The error that ended the run; "" if phase() is not kFailed. The first line names the error.
  /// More lines may follow: the last lines that a dead process printed, roles that two processes
  /// claim, what is wrong with keys and signatures, and the messages that could not be sent.
  const std::string& error() const { return error_; }
  /// Last step that is known to have begun; -1: none.
  std::int64_t step() const { return progress_; }
  /// step() as text for a message: "at step 217", or "before step 0".
  std::string Where() const;
  /// Names of the roles that have not reported ready.
  std::string NotReady() const;
  /// A text such as "while waiting for fusion" if the run has not begun and roles have not reported
  /// ready; otherwise the text of Where().
  std::string WhereOrWaiting() const;
  /// External roles that the run waits for: roles that are not ready, and roles that send nothing
  /// while the run goes on.
  std::vector<Role> Awaited(TimePoint now) const;
  /// The sum of a counter of status_t over the processes of all roles, including dead processes.
  std::int64_t Total(std::int64_t status_t::*counter) const;
  /// Messages that the roles and the runner have refused.
  Refusals Refused() const;
  /// The messages that could not be sent, for each role and the runner. Processes that could send
  /// all their messages are left out.
  std::vector<SendTrouble> SendTroubles() const;
  /// What is wrong with keys and signatures; "" if no trouble is known.
  std::string KeyTrouble() const;
  /// The processes that send on this network but are not part of the run.
  const ForeignPeers& foreign_peers() const { return foreign_peers_; }
  /// The expected builds of the roles.
  const RoleBuilds& builds() const { return options_.builds; }
  /// Whether the run goes on if this role has ended and is not started again. A run in lockstep
  /// needs every role. A run in real time needs only the world, which moves the cars, and the
  /// recorder, which writes the log.
  bool GoesOnWithout(Role role) const {
    return options_.realtime && phase_ == Phase::kRunning && role != Role::kWorld &&
           role != Role::kRecorder;
  }
  /// Tells every role to leave; may be repeated.
  void Stop();
  /// Ends the run with an error from outside, such as the death of a process.
  void Fail(std::string error);
  /// Notes that a process that the runner has started is dead. From now on, late messages of that
  /// process are ignored. The role is free for the next process that the runner starts
  /// (Launched()).
  /// @param host the machine of the process, as STATUS names it; "": this machine
  void MarkDead(Role role, std::int32_t pid, TimePoint now, const std::string& host = "");
  /// Stores the reason why the role cannot be started again or watched at present. Error messages
  /// about a stall, or about roles that are not ready, contain this reason.
  /// @param why the reason; "" if there is none
  void Hinder(Role role, std::string why);
  /// Notes that the runner has started this process for the role, for the first time or again.
  /// @param launch kTriedAgain if the previous process has ended before its first STATUS. The
  ///     launch then does not count as progress of the run, and the role keeps its hindrance
  ///     (Hinder()).
  enum class Launch { kUsual, kTriedAgain };
  void Launched(Role role, std::int32_t pid, TimePoint now, const std::string& host = "",
                Launch launch = Launch::kUsual);
  /// Calls `handler` for every STATUS that is accepted. A STATUS that comes after a newer STATUS of
  /// the same process is not accepted.
  void OnEveryStatus(std::function<void(const status_t&)> handler) {
    on_status_ = std::move(handler);
  }
  /// Whether a STATUS of any process of the role has been accepted.
  bool Met(Role role) const { return member(role).status || !member(role).dead.empty(); }

  /// A process: its machine and its pid.
  struct Process {
    std::string host;
    std::int32_t pid = 0;
    bool operator==(const Process&) const = default;
  };
  /// The coordinator's information about the processes of a role. Most of it comes from their
  /// STATUS.
  struct Member {
    std::optional<status_t> status;  // last STATUS of the accepted instance
    TimePoint heard{};
    std::vector<status_t> dead;     // last STATUS of each dead instance
    std::vector<Process> ended;     // dead processes that the runner had started
    std::optional<Process> child;   // the process that the runner has started
    std::optional<status_t> rival;  // another instance that claims this role
    TimePoint rival_since{};
    TimePoint rival_heard{};
    // The last process to which the role was refused. If the runner has started the role, any other
    // process is refused immediately. If the role is external, RUN first names the process that has
    // the role. Another process is refused if it still claims the role after 1 s.
    std::optional<status_t> refused;
    // `undead` is the time at which an instance that counts as dead began to send again;
    // `undead_heard` is the time of its last STATUS.
    std::optional<TimePoint> undead;
    std::int64_t undead_instance = 0;
    TimePoint undead_heard{};
    std::string hindrance;    // why the role cannot be started again or watched at present
    int replaced = 0;         // number of times that an external role was started again
    TimePoint replaced_at{};  // when the role was last started again
  };
  const Member& member(Role role) const { return members_[static_cast<std::size_t>(role)]; }

 private:
  // A role without a STATUS for this long (five heartbeats) counts as silent.
  static constexpr Duration kSilent = milliseconds(1000);

  /// Whether each role is either ready or busy with its preparation for the run. A busy role sends
  /// nothing. So a role counts as busy if its last STATUS says WAITING and came more than kSilent
  /// ago. For example, the role may be loading the road network of SUMO. Returns false if a role
  /// has sent no STATUS at all.
  bool AllPrepare(TimePoint now) const;
  void Refuse(RefusalCounter kind) { ++(own_.*kind); }
  void OnStatus(const status_t& heard);
  /// The newest step that a role can have computed by now.
  std::int64_t NewestPossible(TimePoint now) const;
  /// Ends the run when the world is done and, in lockstep, the recorder's report includes the last
  /// step. The runner then compares the log with this report.
  void FinishWhenRecorded(TimePoint now);
  /// Ends the run. The run fails if at its end a role is deaf: it has received no message on a
  /// channel, although the producer has sent messages.
  void OnDone();
  /// Handles a role's report of its failure.
  void OnFailure(Role role, const status_t& status);
  void OnResend(Bytes bytes);
  bool AllReady(TimePoint now) const;
  /// Whether this role is missing: it is not ready, or it is an external role that is silent during
  /// the run.
  bool Lacks(Role role, TimePoint now) const;
  bool IsExternal(Role role) const;
  /// The process with this pid on `host`. An empty `host` means this machine.
  Process ProcessOn(const std::string& host, std::int32_t pid) const {
    return {.host = host.empty() ? host_ : host, .pid = pid};
  }
  /// Whether to accept the STATUS; false if it comes from a dead or second instance of the role, or
  /// from a process that leaves the run.
  bool Admit(Role role, const status_t& status, TimePoint now);
  /// Does the work of Admit() for a process that is not the role's current process.
  bool AdmitOther(Role role, const status_t& status, TimePoint now);
  /// Handles a STATUS of a process that counts as dead.
  void OnUndead(Role role, const status_t& status, TimePoint now);
  /// Notes that a process claims a role that another process has. RUN then says which process has
  /// the role.
  void NoteRival(Role role, const status_t& status, TimePoint now);
  /// Records that a process continues to claim a role and is refused.
  void NoteRefused(Role role, const status_t& status);
  /// A line for each role that two processes claim; "" if there is none.
  std::string RefusedText() const;
  bool HasRival(Role role, TimePoint now) const;
  /// Instance of the process that has a role; 0 if no process has the role, or the role's process
  /// is silent.
  std::int64_t HolderOf(Role role, TimePoint now) const;
  void AnnounceWhenDue(TimePoint now);
  void Announce(std::size_t part, std::int64_t answer_to = 0);
  void Announce(std::int8_t phase, std::size_t part, std::int64_t answer_to = 0);
  /// Why the role is missing, as the end of an error text; "" if no reason is known.
  std::string HindranceOf(Role role) const;
  /// The error line that names the role for which the run waits.
  std::string Culprit(TimePoint now) const;

  Bus& bus_;
  RunCoordinatorOptions options_;
  std::vector<std::string> parts_;
  std::string hash_;
  std::array<Member, kRoles.size()> members_;
  SignsOfLife signs_of_life_;
  DeafRoles deaf_;
  ForeignPeers foreign_peers_;
  status_t own_{};  // counts messages that the runner itself has refused or could not send
  std::string host_;
  Phase phase_ = Phase::kJoining;
  TimePoint going_since_{};       // when phase() became kRunning
  bool ready_ = false;            // whether all roles were ready at the last Poll()
  std::int8_t minimal_risk_ = 0;  // cars in a minimal risk manoeuvre, as in status_t
  std::function<void(const status_t&)> on_status_;
  std::string error_;
  TimePoint began_;
  OwnPauses pauses_;
  TimePoint announce_at_{};
  std::size_t next_part_ = 0;  // scenario part in the next RUN, for programs that only listen
  TimePoint parts_at_{};
  std::optional<TimePoint> ask_recorder_at_;  // when to ask for the recorder's last report
  std::int64_t sequence_;                     // sequence number of the last RUN
  std::int64_t progress_;
  TimePoint progressed_{};
  TimePoint awaited_{};  // when an external role was awaited last, before the run began
  std::vector<std::uint8_t> buffer_;
};

}  // namespace fogline::runtime
