// The fallback under random sequences of events, held against its table, and against a second
// reckoning of everything that the table does not say.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "services/arbitrator/take_over.h"
#include "services/arbitrator/take_over_log.h"
#include "services/runtime/random.h"

namespace fogline {
namespace {

using enum TakeOverState;

constexpr std::int64_t kSequences = 10'000;
constexpr std::int64_t kSteps = 300;
constexpr double kRounding = 1e-9;

/// Random numbers of a sequence that nothing else draws.
class Dice {
 public:
  explicit Dice(std::int64_t sequence) : random_(sequence, Stream::kFaults) {}
  double Between(double low, double high) {
    return low + (high - low) * random_.Uniform2(draw_++, 0)[0];
  }
  bool Chance(double probability) { return Between(0, 1) < probability; }

 private:
  Random random_;
  std::int64_t draw_ = 0;
};

Scenario AnyScenario(Dice& dice) {
  Scenario scenario;
  constexpr std::array kSteps_s{0.05, 0.1, 0.2};
  scenario.step_s = kSteps_s[static_cast<std::size_t>(dice.Between(0, 3))];
  scenario.seed = static_cast<std::int64_t>(dice.Between(1, 1e6));
  scenario.arbitrator.take_over = {
      .mode = TakeOverMode::kRequested,
      .lead_s = dice.Between(1, 5),
      .escalation_s = dice.Between(0.1, 5),
      .time = {.mean_s = dice.Between(0.3, 6), .std_s = dice.Between(0.1, 3)},
      .absent_probability = dice.Chance(0.3) ? 1.0 : 0.0,
      .required_readiness = dice.Between(0, 1),
      .recovery_s = dice.Between(0, 3),
      .severe_ttc_s = dice.Between(0.5, 3),
      .comfort_deceleration_mps2 = dice.Between(0.5, 4),
      .emergency_deceleration_mps2 = dice.Between(0.5, 4),
      .jerk_mps3 = dice.Between(0.5, 20)};
  return scenario;
}

/// What happens to the state machine: offers, wishes and cars at random, and a car of its own whose
/// brake may fail for a while.
class Events {
 public:
  explicit Events(Dice& dice, double step_s)
      : dice_(dice), step_s_(step_s), brakes_(!dice.Chance(0.15)) {
    track_.valid = true;
    inputs_.speed_mps = dice.Chance(0.5) ? dice.Between(0, 5) : dice.Between(5, 40);
    inputs_.applied_mps2 = dice.Between(-6, 2);
    danger_ = dice.Chance(0.3) ? 0.05 : 0.002;
  }

  const TakeOverInputs& Next() {
    if (dice_.Chance(0.03)) inputs_.human_wanted = !inputs_.human_wanted;
    inputs_.automation_mps2 = dice_.Between(-6, 2);
    inputs_.human_mps2 = dice_.Between(-8, 3);
    inputs_.readiness = dice_.Between(0, 1);
    track_.state[0] = dice_.Chance(danger_) ? dice_.Between(-1, 20) : dice_.Between(80, 200);
    track_.state[1] = dice_.Between(-20, 20);
    track_.valid = dice_.Chance(0.95);
    inputs_.track = dice_.Chance(0.95) ? &track_ : nullptr;
    return inputs_;
  }

  void Apply(double acceleration_mps2) {
    inputs_.applied_mps2 = acceleration_mps2;
    if (dice_.Chance(0.005)) brakes_ = true;
    if (brakes_) {
      inputs_.speed_mps = std::clamp(inputs_.speed_mps + step_s_ * acceleration_mps2, 0.0, 60.0);
    }
  }

 private:
  Dice& dice_;
  double step_s_;
  bool brakes_;
  double danger_;
  track_t track_{};
  TakeOverInputs inputs_;
};

/// The second reckoning: from the inputs alone which events hold, and what each source would apply.
class Witness {
 public:
  explicit Witness(const Scenario& scenario)
      : section_(scenario.arbitrator.take_over),
        step_s_(scenario.step_s),
        random_(scenario.seed, Stream::kTakeOver),
        time_(section_.time, section_.lead_s),
        manoeuvre_({.deceleration_mps2 = section_.emergency_deceleration_mps2,
                    .jerk_mps3 = section_.jerk_mps3},
                   scenario.step_s) {}

  TakeOverEvents EventsOf(std::int64_t step, const TakeOverInputs& inputs) const {
    TakeOverEvents events =
        Bit(inputs.human_wanted ? TakeOverEvent::kWanted : TakeOverEvent::kCalm);
    const auto set = [&events](TakeOverEvent event, bool holds) {
      if (holds) events = static_cast<TakeOverEvents>(events | Bit(event));
    };
    set(TakeOverEvent::kSevere, Ttc_s(inputs) < section_.severe_ttc_s);
    set(TakeOverEvent::kStandstill, inputs.speed_mps < 0.01 && inputs.applied_mps2 <= 0);
    if (!requested_) return events;
    const double t = Since(step, *requested_);
    const bool answered = section_.absent_probability < 1 && t + kRounding >= time_s_;
    set(TakeOverEvent::kEscalation, t + kRounding >= section_.escalation_s);
    set(TakeOverEvent::kAcknowledged, answered && time_s_ <= section_.lead_s);
    set(TakeOverEvent::kReady, answered && inputs.readiness >= section_.required_readiness);
    set(TakeOverEvent::kDeadline, t + kRounding >= section_.lead_s);
    set(TakeOverEvent::kRecovered,
        transferred_ && Since(step, *transferred_) + kRounding >= section_.recovery_s);
    return events;
  }

  /// What `authority` applies in this step. Of the manoeuvre once per step.
  double Source(Authority authority, const TakeOverInputs& inputs) {
    const double least =
        std::min(section_.comfort_deceleration_mps2, section_.emergency_deceleration_mps2);
    switch (authority) {
      case Authority::kAutomation:
        return inputs.automation_mps2;
      case Authority::kEasing:
        return std::min(inputs.automation_mps2,
                        std::max(0.0, inputs.applied_mps2 - section_.jerk_mps3 * step_s_));
      case Authority::kHuman:
        return inputs.human_mps2;
      case Authority::kComfort:
        return manoeuvre_.Step(inputs.speed_mps, std::clamp(-inputs.automation_mps2, least,
                                                            section_.emergency_deceleration_mps2));
      case Authority::kHard:
        return manoeuvre_.Step(inputs.speed_mps);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  void Note(const TakeOverOutcome& out, TakeOverState before, std::int64_t step,
            const TakeOverInputs& inputs) {
    if (out.state == kDemand && before == kAutomated) {
      requested_ = step;
      transferred_.reset();
      time_s_ = time_.Draw(random_, step);
    }
    if (out.state == kRecovering && before != kRecovering) transferred_ = step;
    if (out.authority >= Authority::kComfort) manoeuvre_.Begin(inputs.applied_mps2);
  }

  double SinceRequest(std::int64_t step) const { return Since(step, *requested_); }
  static double Ttc_s(const TakeOverInputs& inputs) {
    const bool closing =
        inputs.track != nullptr && inputs.track->valid && inputs.track->state[1] < 0;
    return closing ? inputs.track->state[0] / -inputs.track->state[1]
                   : std::numeric_limits<double>::infinity();
  }
  bool manoeuvred() const { return manoeuvre_.begun(); }
  /// A copy: the manoeuvre's next command without its taking place.
  Witness Asked() const { return *this; }

 private:
  double Since(std::int64_t step, std::int64_t begin) const {
    return static_cast<double>(step - begin) * step_s_;
  }

  TakeOverSection section_;
  double step_s_;
  Random random_;
  TakeOverTime time_;
  MinimalRisk manoeuvre_;
  std::optional<std::int64_t> requested_;
  std::optional<std::int64_t> transferred_;
  double time_s_ = 0;
};

/// How often each row has been taken, and has changed what is applied.
struct RowCount {
  int taken = 0;
  int changed = 0;
};
using RowCounts = std::array<RowCount, kTakeOverTable.size()>;

std::size_t PlaceOf(const TakeOverRow& row) {
  return static_cast<std::size_t>(&row - kTakeOverTable.data());
}

// Of what neither world nor witness know: that a stage lasts too long.
bool IsOverdue(TakeOverState before, TakeOverState after) {
  return (before == kMrmComfort && after == kMrmEmergency) ||
         (before == kMrmEmergency && after == kMrmFailed);
}

/// One step against the table. @return the row that it took
const TakeOverRow* ExpectTheTable(TakeOverEvents events, TakeOverState before, TakeOverState after,
                                  bool manoeuvred) {
  const TakeOverRow* row = TakeOverRowOf(before, events, manoeuvred);
  if (row == nullptr && IsOverdue(before, after)) {
    row = TakeOverRowOf(before, Bit(TakeOverEvent::kOverdue), manoeuvred);
  }
  EXPECT_EQ(after, row == nullptr ? before : row->next)
      << "from " << InfoOf(before).name << " to " << InfoOf(after).name;
  return row;
}

void ExpectNoManoeuvreTooEarly(const TakeOverRow& row, const Witness& witness, std::int64_t step,
                               const TakeOverInputs& inputs, const TakeOverSection& section) {
  if (row.authority < Authority::kComfort || AuthorityOf(row.state) >= Authority::kComfort) return;
  if (row.next == kMrmComfort) {
    EXPECT_GE(witness.SinceRequest(step), section.lead_s - kRounding);
  } else {
    EXPECT_LT(Witness::Ttc_s(inputs), section.severe_ttc_s);
  }
}

void ExpectTheLimits(const TakeOverOutcome& out, const TakeOverInputs& inputs,
                     const TakeOverSection& section, double step_s) {
  if (out.authority == Authority::kEasing) {
    // It does not accelerate, but for what it takes to end an acceleration within the jerk.
    EXPECT_LE(out.acceleration_mps2,
              std::max(0.0, inputs.applied_mps2 - section.jerk_mps3 * step_s) + kRounding);
  }
  if (out.authority < Authority::kComfort) return;
  // Who brakes harder than the manoeuvre may when it begins releases the brake within the jerk.
  EXPECT_GE(out.acceleration_mps2,
            std::min(-section.emergency_deceleration_mps2, inputs.applied_mps2) - kRounding);
  const bool standing = inputs.speed_mps == 0 && out.acceleration_mps2 == 0;
  if (standing) return;
  EXPECT_LE(std::abs(out.acceleration_mps2 - inputs.applied_mps2),
            section.jerk_mps3 * step_s + kRounding);
}

class Sequence {
 public:
  explicit Sequence(std::int64_t number)
      : dice_(number),
        scenario_(AnyScenario(dice_)),
        events_(dice_, scenario_.step_s),
        take_over_(scenario_),
        twin_(scenario_),
        witness_(scenario_) {}

  void Run(RowCounts& counts) {
    for (std::int64_t step = 0; step < kSteps && !testing::Test::HasFailure(); ++step) {
      Step(step, counts);
    }
    ExpectTheLogTellsTheRequest();
  }

 private:
  void Step(std::int64_t step, RowCounts& counts) {
    const TakeOverInputs& inputs = events_.Next();
    const TakeOverState before = take_over_.outcome().state;
    const Authority old_authority = take_over_.outcome().authority;
    const TakeOverEvents events = witness_.EventsOf(step, inputs);
    const bool manoeuvred = witness_.manoeuvred();
    header_t header{};
    header.step = step;

    const TakeOverOutcome& out = take_over_.Step(header, inputs);

    const TakeOverRow* row = ExpectTheTable(events, before, out.state, manoeuvred);
    EXPECT_EQ(out.authority, AuthorityOf(out.state));
    witness_.Note(out, before, step, inputs);
    if (row != nullptr) {
      ExpectNoManoeuvreTooEarly(*row, witness_, step, inputs, scenario_.arbitrator.take_over);
      const double old_source = witness_.Asked().Source(old_authority, inputs);
      RowCount& count = counts[PlaceOf(*row)];
      ++count.taken;
      if (out.acceleration_mps2 != old_source) ++count.changed;
      if (row->authority == old_authority) {
        EXPECT_EQ(out.acceleration_mps2, old_source);
      }
    }
    EXPECT_EQ(out.acceleration_mps2, witness_.Source(out.authority, inputs));
    ExpectTheLimits(out, inputs, scenario_.arbitrator.take_over, scenario_.step_s);
    if (out.state == kMrmDone) ExpectLocked(before, inputs);
    EXPECT_FALSE(manoeuvred && out.state == kAutomated);
    ExpectNothingLingers(header, inputs, out);
    Log(header, out);
    events_.Apply(out.acceleration_mps2);
  }

  void ExpectLocked(TakeOverState before, const TakeOverInputs& inputs) {
    if (before != kMrmDone) return;
    EXPECT_LT(inputs.speed_mps, 0.01);
    EXPECT_LE(take_over_.outcome().acceleration_mps2, 0.0);
    EXPECT_EQ(take_over_.outcome().state, kMrmDone);
  }

  // Whoever has no authority may offer what he likes: nobody notices.
  void ExpectNothingLingers(const header_t& header, TakeOverInputs inputs,
                            const TakeOverOutcome& out) {
    constexpr double kNonsense = 1e9;
    if (out.authority != Authority::kHuman) inputs.human_mps2 = kNonsense;
    const bool automation_counts = out.authority == Authority::kAutomation ||
                                   out.authority == Authority::kEasing ||
                                   out.authority == Authority::kComfort;
    if (!automation_counts) inputs.automation_mps2 = kNonsense;
    const TakeOverOutcome& same = twin_.Step(header, inputs);
    EXPECT_EQ(same.state, out.state);
    EXPECT_EQ(same.acceleration_mps2, out.acceleration_mps2);
  }

  void Log(const header_t& header, const TakeOverOutcome& out) {
    arbitration_t command{};
    command.header = header;
    command.mode = InfoOf(out.state).mode;
    command.acceleration_mps2 = out.acceleration_mps2;
    log_.Add(command);
  }

  // But for an input in the very last step, of which the state machine will hear in the next.
  void ExpectTheLogTellsTheRequest() {
    if (!take_over_.request()) {
      EXPECT_TRUE(log_.requests().empty());
      return;
    }
    ASSERT_FALSE(log_.requests().empty());
    TakeOverRequest logged = log_.requests().back();
    if (logged.effective == kSteps - 1) logged.effective.reset();
    EXPECT_EQ(logged, *take_over_.request());
  }

  Dice dice_;
  Scenario scenario_;
  Events events_;
  TakeOver take_over_;
  TakeOver twin_;
  Witness witness_;
  TakeOverLog log_;
};

TEST(TakeOverPropertyTest, KeepsToItsTableAndItsLimitsOverTenThousandSequences) {
  RowCounts counts{};
  for (std::int64_t i = 0; i < kSequences; ++i) {
    Sequence(i).Run(counts);
    ASSERT_FALSE(HasFailure()) << "sequence " << i;
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const TakeOverRow& row = kTakeOverTable[i];
    SCOPED_TRACE(testing::Message() << InfoOf(row.state).name << " -> " << InfoOf(row.next).name
                                    << ", " << counts[i].taken << " times");
    EXPECT_GT(counts[i].taken, 0) << "never taken";
    // A change of state that changes who has authority is felt at once; but where the car stands
    // neither stage of the manoeuvre has anything to do.
    if (row.authority == AuthorityOf(row.state) || row.next == kMrmDone) {
      EXPECT_EQ(counts[i].changed, 0);
    } else {
      EXPECT_GT(counts[i].changed, 0);
    }
  }
}

}  // namespace
}  // namespace fogline
