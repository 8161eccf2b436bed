// Three roles of a run (world, driver, recorder), in lockstep or in real time, on a bus in memory,
// among arbitrary messages. Input: actions, one byte each. An action is the next message of a run,
// or a datagram on some channel. The bytes of the datagram then follow in the input.
#include <algorithm>
#include <limits>
#include <map>

#include "services/driver/driver.h"
#include "services/recorder/recorder.h"
#include "services/runtime/process/step_node.h"
#include "services/world/failsafe_world.h"
#include "services/world/world.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxActions = 64;

enum Action : std::uint8_t {
  kAnnounce,
  kGo,
  kCommands,
  kPoll,
  kStop,
  kDatagram,
  kAnnounceRealtime,
  kNumActions
};

/// Checks the messages of the roles as other processes receive them.
class Listener {
 public:
  explicit Listener(runtime::Bus& bus) {
    Listen<truth_t>(bus);
    Listen<ego_t>(bus);
    Listen<driver_command_t>(bus);
    bus.Subscribe(ChannelOf<status_t>().name, [this](runtime::Bytes bytes) { OnStatus(bytes); });
  }

  /// Tells the listener not to judge messages with these bytes, because the fuzzer has sent them.
  void Ignore(runtime::Bytes bytes) { foreign_.assign(bytes.begin(), bytes.end()); }
  std::size_t steps() const { return said_.size(); }

 private:
  template <class M>
  void Listen(runtime::Bus& bus) {
    bus.Subscribe(ChannelOf<M>().name, [this](runtime::Bytes bytes) {
      if (std::ranges::equal(bytes, foreign_)) return;
      M message{};
      Demand(runtime::Examine(bytes, message) == nullptr, "a role says what is sound");
      const auto [said, fresh] =
          said_.try_emplace({IndexOf<M>(), message.header.step}, bytes.begin(), bytes.end());
      Demand(fresh || std::ranges::equal(said->second, bytes),
             "a role says one thing in a step, however often");
    });
  }

  void OnStatus(runtime::Bytes bytes) {
    if (std::ranges::equal(bytes, foreign_)) return;
    status_t status{};
    Demand(runtime::Examine(bytes, status) == nullptr, "a STATUS is sound");
    for (const runtime::RefusalKind& kind : runtime::kRefusals) {
      Demand(status.*kind.counter >= 0, "fewer than none are not refused");
    }
    Demand(status.header.step >= -1, "no step is before the first");
  }

  std::map<std::pair<std::size_t, std::int64_t>, Input> said_;
  Input foreign_;
};

class Run {
 public:
  void Do(Action action, Cutter& cutter) {
    switch (action) {
      case kAnnounceRealtime:
        realtime_ = true;
        return SayRun(run_t::PREPARE);
      case kAnnounce:
        return SayRun(run_t::PREPARE);
      case kGo:
      case kStop:
        return SayRun(action == kGo ? run_t::GO : run_t::STOP);
      case kCommands: {
        Say(Sample<arbitration_t>(step_));
        auto follower = Sample<follower_command_t>(step_++);
        follower.num_followers = 1;
        follower.acceleration_mps2.resize(1);
        follower.safe_distance_m.resize(1);
        return Say(follower);
      }
      case kPoll:
        for (runtime::Work* role : roles_) role->node().Poll(Clock::now());
        return bus_.Drain();
      default: {
        const std::size_t channel = cutter.Byte() % kNumChannels;
        const runtime::Bytes datagram = cutter.Datagram();
        listener_.Ignore(datagram);
        return Publish(kChannels[channel].name, datagram);
      }
    }
  }

  void DemandSound() const {
    for (runtime::Work* role : roles_) {
      const runtime::OwnStatus& own = role->node().parts().own;
      Demand(own.left() || own.message().error.empty(), "a role that fails leaves");
    }
    if (listener_.steps() > 0) Took();
  }

 private:
  template <class M>
  void Say(const M& message) {
    Publish(ChannelOf<M>().name, Encoded(message));
  }
  void SayRun(std::int8_t phase) {
    auto run = Sample<run_t>(0);
    run.phase = phase;
    run.realtime = realtime_;
    run.pace = realtime_ ? runtime::kMaxSpeed : 0;
    run.external = {"world", "driver", "recorder"};  // the run waits for these roles
    run.holder = {0, 0, 0};
    run.num_external = static_cast<std::int32_t>(run.external.size());
    run.sequence = ++sequence_;
    Say(run);
  }
  void Publish(std::string_view channel, runtime::Bytes bytes) {
    bus_.Publish(channel, bytes);
    bus_.Drain();
  }

  runtime::Bus bus_{"memq://"};
  Listener listener_{bus_};
  MemoryFile log_;
  runtime::StepNode<world::World, world::FailsafeWorld> world_{bus_, {}};
  runtime::StepNode<driver::Driver> driver_{bus_, {}};
  recorder::Recorder recorder_{bus_, {}, log_.path()};
  std::array<runtime::Work*, 3> roles_{&world_, &driver_, &recorder_};
  std::int64_t step_ = 0;
  std::int64_t sequence_ = 0;
  bool realtime_ = false;  // true from the first kAnnounceRealtime on
};

template <class M>
void AddStep(std::int64_t step, Input& input) {
  M message = Sample<M>(0);
  message.header.step = step;
  input.insert(input.end(), {kDatagram, static_cast<std::uint8_t>(IndexOf<M>())});
  AddDatagram(Encoded(message), input);
}

/// Messages with step numbers that overflow in arithmetic, on channels that some of the roles read.
Input WithImpossibleSteps(Action announce) {
  using Limits = std::numeric_limits<std::int64_t>;
  Input input{announce, kGo, kPoll};
  for (const std::int64_t step : {Limits::max(), Limits::max() - 1, Limits::min(), kSteps}) {
    AddStep<truth_t>(step, input);
    AddStep<arbitration_t>(step, input);
    AddStep<follower_command_t>(step, input);
    AddStep<status_t>(step, input);
    AddStep<resend_t>(step, input);
    AddStep<run_t>(step, input);
  }
  for (const std::int64_t progress : {Limits::max(), Limits::min(), kSteps}) {
    auto run = Sample<run_t>(0);
    run.sequence = 100;
    run.progress = progress;
    input.insert(input.end(), {kDatagram, static_cast<std::uint8_t>(IndexOf<run_t>())});
    AddDatagram(Encoded(run), input);
  }
  input.insert(input.end(), {kCommands, kPoll, kPoll});
  return input;
}

}  // namespace

std::vector<Input> Seeds() {
  const Input undisturbed{kAnnounce, kGo, kCommands, kPoll, kCommands, kPoll, kCommands, kStop};
  Input asked{kAnnounce, kGo, kCommands, kDatagram, IndexOf<resend_t>()};
  AddDatagram(Encoded(Sample<resend_t>(0)), asked);
  asked.insert(asked.end(), {kCommands, kDatagram, IndexOf<truth_t>()});
  AddDatagram(Encoded(Sample<truth_t>(1)), asked);
  asked.push_back(kPoll);
  Input recorded{kAnnounce, kGo};
  for (std::int64_t step = 0; step < kSteps; ++step) {
    recorded.push_back(kCommands);
    ForEachStepChannel([&]<class M>(std::size_t channel) {
      if (kChannels[channel].from == Role::kWorld) return;
      recorded.insert(recorded.end(), {kDatagram, static_cast<std::uint8_t>(channel)});
      AddDatagram(Encoded(Sample<M>(step)), recorded);
    });
  }
  recorded.push_back(kPoll);
  const Input realtime{kAnnounceRealtime, kGo, kPoll, kCommands, kPoll, kCommands, kPoll, kStop};
  return {undisturbed,
          asked,
          recorded,
          realtime,
          WithImpossibleSteps(kAnnounce),
          WithImpossibleSteps(kAnnounceRealtime)};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogline::fuzz;
  Run run;
  Cutter cutter({data, size});
  for (std::size_t i = 0; i < kMaxActions && !cutter.empty(); ++i) {
    run.Do(static_cast<Action>(cutter.Byte() % kNumActions), cutter);
  }
  run.DemandSound();
  return 0;
}
