// The table of all roles and all channels of Fogline. The code that connects processes to channels,
// the recorder, the digest, the monitors and the tests use this table. The tables in README.md and
// docs/architecture.md are made from it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "fogline/fields.hpp"  // all message types

namespace fogline {

// Every role that computes messages, in the order of evaluation within a step. A row is
// ROLE(folder, Class, purpose). The class of the role is fogline::FOLDER::CLASS in
// services/FOLDER/FOLDER.h. The name of the role is FOLDER. Its program is fogline-FOLDER, and its
// value is Role::kCLASS. services/closed_loop/algorithms.h checks that each row has a folder, and
// that each folder of a role has a row.
#define FOGLINE_ROLES(ROLE)                                                         \
  ROLE(world, World, "moves the cars and is the clock of the run")                  \
  ROLE(radar, Radar, "measures range and range rate; fog hardly affects it")        \
  ROLE(lidar, Lidar, "measures range; fog deceives it")                             \
  ROLE(fusion, Fusion, "extended Kalman filter over both sensors")                  \
  ROLE(acc, Acc, "the automation agent: MPC-based adaptive cruise control")         \
  ROLE(driver, Driver, "the human agent: follows the car ahead, as far as it sees") \
  ROLE(arbitrator, Arbitrator, "Degree of Conflict; decides who drives the host")   \
  ROLE(follower, Follower, "drives the cars behind the host: the same ACC, or human drivers")

#define FOGLINE_ROLE_VALUE(folder, Class, purpose) k##Class,
enum class Role : std::uint8_t {
  FOGLINE_ROLES(FOGLINE_ROLE_VALUE)  // the roles that compute messages
  kRecorder,                         // writes the log; its row is only in kRoles
  kRunner,                           // `fogline run`: starts and ends a run, and computes no step
};
#undef FOGLINE_ROLE_VALUE

/// A set of roles.
class RoleSet {
 public:
  constexpr RoleSet(std::initializer_list<Role> roles) {
    for (const Role role : roles) Add(role);
  }
  constexpr void Add(Role role) { bits_ |= Bit(role); }
  constexpr bool Has(Role role) const { return (bits_ & Bit(role)) != 0; }

 private:
  static constexpr std::uint32_t Bit(Role role) { return 1U << static_cast<unsigned>(role); }
  std::uint32_t bits_ = 0;
};

struct RoleInfo {
  Role role;
  std::string_view name;
  std::string_view purpose;
};

#define FOGLINE_ROLE_INFO(folder, Class, purpose) RoleInfo{Role::k##Class, #folder, purpose},
/// Every role that is a separate process, in the order of evaluation within a step.
inline constexpr std::array kRoles{
    FOGLINE_ROLES(FOGLINE_ROLE_INFO)
        RoleInfo{Role::kRecorder, "recorder", "writes the LCM event log; the world waits for it"},
};
#undef FOGLINE_ROLE_INFO

/// All roles of `kRoles`, and the runner.
inline constexpr RoleSet kEveryone = [] {
  RoleSet everyone{Role::kRunner};
  for (const RoleInfo& info : kRoles) everyone.Add(info.role);
  return everyone;
}();

/// The pace of a channel says when its producer sends messages.
enum class Pace : std::uint8_t {
  kStep,     // its producer sends exactly one message in every step
  kControl,  // messages as needed, outside the sequence of steps
};

/// One channel. Every channel has its own message type, so a type identifies its channel.
template <class M>
struct Channel {
  using Message = M;
  std::string_view name;
  Pace pace;
  Role from;
  RoleSet to;  // roles that use the channel; the recorder receives every kStep channel, too
  std::string_view what;
  RoleSet on_demand = {};  // roles that read the channel only in some scenarios (algorithm.h)
};

/// Every channel. The kStep channels are in an order in which a step can be evaluated.
inline constexpr std::tuple kGraph{
    Channel<run_t>{"RUN", Pace::kControl, Role::kRunner, kEveryone,
                   "phase of the run; the scenario, in parts"},
    Channel<truth_t>{"TRUTH",
                     Pace::kStep,
                     Role::kWorld,
                     {Role::kRadar, Role::kLidar, Role::kDriver, Role::kFollower},
                     "ground truth: positions, speeds, accelerations, gaps, fog",
                     {Role::kFusion, Role::kArbitrator}},
    Channel<ego_t>{"HOST_EGO",
                   Pace::kStep,
                   Role::kWorld,
                   {Role::kFusion, Role::kAcc, Role::kArbitrator},
                   "the host's own odometry: speed, acceleration"},
    Channel<radar_t>{"RADAR",
                     Pace::kStep,
                     Role::kRadar,
                     {Role::kFusion, Role::kArbitrator},
                     "range, range rate, standard deviations, validity"},
    Channel<lidar_t>{"LIDAR",
                     Pace::kStep,
                     Role::kLidar,
                     {Role::kFusion, Role::kArbitrator},
                     "range, standard deviation, intensity, validity"},
    Channel<track_t>{"TRACK",
                     Pace::kStep,
                     Role::kFusion,
                     {Role::kAcc, Role::kArbitrator},
                     "fused state, covariance, innovations"},
    Channel<accel_command_t>{"ACC_COMMAND",
                             Pace::kStep,
                             Role::kAcc,
                             {Role::kArbitrator},
                             "acceleration a_A of the automation agent"},
    Channel<driver_command_t>{"DRIVER_COMMAND",
                              Pace::kStep,
                              Role::kDriver,
                              {Role::kArbitrator},
                              "acceleration a_H of the human driver, readiness"},
    // Runs that differ only in their arbitrators share the computation of all other roles
    // (shared_runs.h). They share it until their HOST_COMMANDs have different effects on these
    // roles. If you change a role so that it reads another field of HOST_COMMAND, let
    // ClosedLoop::CommandsAs() compare this field, too.
    Channel<arbitration_t>{"HOST_COMMAND",
                           Pace::kStep,
                           Role::kArbitrator,
                           {Role::kWorld},
                           "the host's acceleration, authorities, Degree of Conflict",
                           {Role::kDriver}},
    Channel<follower_command_t>{"FOLLOWER_COMMAND",
                                Pace::kStep,
                                Role::kFollower,
                                {Role::kWorld},
                                "acceleration and safe distance of each following car"},
    Channel<status_t>{"STATUS",
                      Pace::kControl,
                      Role::kRunner,
                      {Role::kRunner, Role::kWorld},
                      "state, step and counters of every role"},
    Channel<resend_t>{"RESEND", Pace::kControl, Role::kRunner, kEveryone,
                      "asks a producer to publish a step again"},
    Channel<driver_input_t>{"DRIVER_INPUT",
                            Pace::kControl,
                            Role::kRunner,
                            {Role::kDriver},
                            "pedals and buttons of a person who drives"},
    Channel<trial_t>{"TRIAL",
                     Pace::kControl,
                     Role::kRunner,
                     {Role::kRecorder},
                     "facts of a trial with a person: condition, markers, answers"},
};

inline constexpr std::size_t kNumChannels = std::tuple_size_v<decltype(kGraph)>;

// Sets of roles and of channels have 32 bits.
static_assert(kRoles.size() < 32 && kNumChannels <= 32, "a set of 32 bits is too small");

/// A channel without its type, for code that works on all channels.
struct ChannelInfo {
  std::string_view name;
  Pace pace;
  Role from;
  RoleSet to;
  std::string_view what;
  RoleSet on_demand;

  /// Whether the recorder logs the channel in every run. The result is true for every kStep
  /// channel, and for RUN, because a log must contain its scenario. In real time, the recorder also
  /// logs STATUS, DRIVER_INPUT and TRIAL. For these three channels the result is false.
  constexpr bool Logged() const { return pace == Pace::kStep || name == "RUN"; }
};

/// `kGraph` without types, in the same order.
inline constexpr auto kChannels = std::apply(
    [](const auto&... channel) {
      return std::array{ChannelInfo{channel.name, channel.pace, channel.from, channel.to,
                                    channel.what, channel.on_demand}...};
    },
    kGraph);

/// Position of message type M's channel in `kGraph`.
template <class M, std::size_t I = 0>
constexpr std::size_t IndexOf() {
  static_assert(I < kNumChannels, "this type has no channel in kGraph");
  if constexpr (std::is_same_v<typename std::tuple_element_t<I, decltype(kGraph)>::Message, M>) {
    return I;
  } else {
    return IndexOf<M, I + 1>();
  }
}

/// The channel of message type M.
template <class M>
constexpr const ChannelInfo& ChannelOf() {
  return kChannels[IndexOf<M>()];
}

/// Calls `visit.template operator()<Message>(index)` for every kStep channel, in order.
template <class Visit>
constexpr void ForEachStepChannel(Visit&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (
        [&] {
          using M = typename std::tuple_element_t<I, decltype(kGraph)>::Message;
          if constexpr (kChannels[I].pace == Pace::kStep) visit.template operator()<M>(I);
        }(),
        ...);
  }
  (std::make_index_sequence<kNumChannels>{});
}

/// Age, in steps, of the message of `producer` that `reader` uses in a step: 0 if the producer
/// comes before the reader in the order of evaluation, 1 otherwise.
constexpr std::int64_t LagOf(Role producer, Role reader) {
  for (const RoleInfo& info : kRoles) {
    if (info.role == reader) return 1;
    if (info.role == producer) return 0;
  }
  return 0;
}

/// Whether each role, except the world, reads only channels whose producers come before this role
/// in kRoles. If this is true, each of these roles uses only messages of its own step. The world
/// begins a step, and uses messages of the previous step.
constexpr bool RolesAreInOrder() {
  for (const ChannelInfo& channel : kChannels) {
    for (const RoleInfo& reader : kRoles) {
      const bool reads = channel.pace == Pace::kStep && channel.to.Has(reader.role);
      if (reads && reader.role != Role::kWorld && LagOf(channel.from, reader.role) != 0)
        return false;
    }
  }
  return true;
}
static_assert(
    RolesAreInOrder(),
    "a role reads a channel of a role below it: move the reader's row in FOGLINE_ROLES down");

/// Whether the kStep channels of kGraph are in the order of their producers in kRoles.
constexpr bool ChannelsAreInOrder() {
  Role last = Role::kWorld;
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace != Pace::kStep) continue;
    if (channel.from != last && LagOf(last, channel.from) != 0) return false;
    last = channel.from;
  }
  return true;
}
static_assert(ChannelsAreInOrder(),
              "the channels of kGraph are not in the order of their roles in FOGLINE_ROLES");

/// The unit of simulated time in messages (header_t, utime) is the microsecond.
inline constexpr double kMicrosPerSecond = 1e6;

/// Index in kChannels of the channel with this name; kNumChannels if there is no such channel.
constexpr std::size_t ChannelNamed(std::string_view name) {
  std::size_t place = 0;
  while (place < kNumChannels && kChannels[place].name != name) ++place;
  return place;
}

/// Name of a role on the command line and in STATUS.
constexpr std::string_view NameOf(Role role) {
  for (const RoleInfo& info : kRoles) {
    if (info.role == role) return info.name;
  }
  return "runner";
}

}  // namespace fogline
