// The fallback under random sequences of events, held against its table, and against a second
// reckoning of everything that the table does not say.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
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
  constexpr std::array kSteps_s{0.1, 0.2, 0.5};
  scenario.step_s = kSteps_s[static_cast<std::size_t>(dice.Between(0, 3))];
  scenario.seed = static_cast<std::int64_t>(dice.Between(1, 1e6));
  scenario.arbitrator.take_over = {
      .mode = TakeOverMode::kRequested,
      .lead_s = dice.Between(10, 14),
      .escalation_s = dice.Between(0.1, 14),
      .time = {.mean_s = dice.Between(0.3, 14), .std_s = dice.Between(0.1, 5)},
      .absent_probability = dice.Chance(0.3) ? 1.0 : 0.0,
      .required_readiness = dice.Between(0, 1),
      .recovery_s = dice.Between(0, 3),
      .severe_ttc_s = dice.Between(0.5, 3),
      .comfort_deceleration_mps2 = dice.Between(0.5, 3),
      .emergency_deceleration_mps2 = dice.Between(3.2, 4),
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

  /// Other offers, and nothing else: they have no say in what happens.
  void OtherOffers() {
    const bool eager = dice_.Chance(0.5);
    inputs_.automation_mps2 =
        eager ? std::max(0.0, inputs_.applied_mps2) + dice_.Between(0.1, 1) : dice_.Between(-6, 2);
    inputs_.human_mps2 = dice_.Between(-8, 3);
  }
  const TakeOverInputs& inputs() const { return inputs_; }

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
    set(TakeOverEvent::kOverdue, stage_ && Since(step, *stage_ + 1) + kRounding >= overdue_s_);
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
    if (out.state == before) return;
    stage_.reset();
    if (out.state != kMrmComfort && out.state != kMrmEmergency) return;
    stage_ = step;
    overdue_s_ =
        2 * LongestStop_s(inputs, out.state == kMrmComfort ? section_.comfort_deceleration_mps2
                                                           : section_.emergency_deceleration_mps2);
  }

  /// What `authority` would apply in this step, if it had the wheel.
  double Would(Authority authority, const TakeOverInputs& inputs) const {
    Witness other = *this;
    if (authority >= Authority::kComfort) other.manoeuvre_.Begin(inputs.applied_mps2);
    return other.Source(authority, inputs);
  }
  /// What a manoeuvre without a limit on its deceleration would: bound by the jerk, or by the stop.
  double WouldAtMost(const TakeOverInputs& inputs) const {
    Witness other = *this;
    other.manoeuvre_.Begin(inputs.applied_mps2);
    return other.manoeuvre_.Step(inputs.speed_mps, std::numeric_limits<double>::infinity());
  }

  double SinceRequest(std::int64_t step) const { return Since(step, *requested_); }
  static double Ttc_s(const TakeOverInputs& inputs) {
    const bool closing =
        inputs.track != nullptr && inputs.track->valid && inputs.track->state[1] < 0;
    return closing ? inputs.track->state[0] / -inputs.track->state[1]
                   : std::numeric_limits<double>::infinity();
  }
  bool manoeuvred() const { return manoeuvre_.begun(); }

 private:
  /// The bound of services/minimal_risk/README.md on the time to rest, on a level road: the brake
  /// is applied, the car slows down, the brake is released, and three steps.
  double LongestStop_s(const TakeOverInputs& inputs, double deceleration_mps2) const {
    const double push = std::max(inputs.applied_mps2, 0.0);
    const double jerk = section_.jerk_mps3;
    return std::abs(inputs.applied_mps2 + deceleration_mps2) / jerk +
           (inputs.speed_mps + push * push / (2 * jerk) + push * step_s_) / deceleration_mps2 +
           deceleration_mps2 / jerk + 3 * step_s_;
  }
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
  std::optional<std::int64_t> stage_;  // of the manoeuvre: its first step
  double overdue_s_ = 0;               // after which it is overdue
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

/// One step against the table.
void ExpectTheTable(const TakeOverRow* row, TakeOverState before, TakeOverState after) {
  EXPECT_EQ(after, row == nullptr ? before : row->next)
      << "from " << InfoOf(before).name << " to " << InfoOf(after).name;
}

/// A change of state is felt in its own step: what is applied is the command of the new state's
/// controller, and not what the old one's would have been, by the same inputs. Between states of
/// one controller it is that controller's in either.
///
/// One change may show later, that to the harder stage of the manoeuvre: while the jerk, or the
/// stop that is near, allow less than the softer stage's deceleration, both do the same, which is
/// all that is allowed.
bool ExpectTheChangeIsFelt(const TakeOverRow& row, const Witness& witness,
                           const TakeOverInputs& inputs, double applied_mps2) {
  const Authority old_authority = AuthorityOf(row.state);
  const double old_mps2 = witness.Would(old_authority, inputs);
  EXPECT_EQ(applied_mps2, witness.Would(row.authority, inputs));
  if (row.authority == old_authority) {
    EXPECT_EQ(applied_mps2, old_mps2);
    return false;
  }
  const bool changed = std::abs(applied_mps2 - old_mps2) > kRounding;
  const bool harder = old_authority == Authority::kComfort && row.authority == Authority::kHard;
  EXPECT_TRUE(changed || (harder && applied_mps2 == witness.WouldAtMost(inputs)))
      << InfoOf(row.state).name << " -> " << InfoOf(row.next).name << ": " << applied_mps2
      << " m/s2 as before";
  return changed;
}

void ExpectNoManoeuvreTooEarly(const TakeOverRow& row, const Witness& witness, std::int64_t step,
                               const TakeOverInputs& inputs, const TakeOverSection& section) {
  if (row.authority < Authority::kComfort || AuthorityOf(row.state) >= Authority::kComfort) return;
  if (row.next == kMrmComfort) {
    EXPECT_GE(witness.SinceRequest(step), section.lead_s - kRounding);
    EXPECT_GE(witness.SinceRequest(step), 10 - kRounding) << "UN R157, 5.4.4.1";
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
    const TakeOverState before = take_over_.outcome().state;
    const bool manoeuvred = witness_.manoeuvred();
    const TakeOverInputs& inputs = events_.Next();
    const TakeOverRow* row = TakeOverRowOf(before, witness_.EventsOf(step, inputs), manoeuvred);
    if (row != nullptr) LetTheControllersDiffer(*row);
    header_t header{};
    header.step = step;

    const TakeOverOutcome& out = take_over_.Step(header, inputs);

    ExpectTheTable(row, before, out.state);
    EXPECT_EQ(out.authority, AuthorityOf(out.state));
    if (row != nullptr) {
      ExpectNoManoeuvreTooEarly(*row, witness_, step, inputs, scenario_.arbitrator.take_over);
      RowCount& count = counts[PlaceOf(*row)];
      ++count.taken;
      if (ExpectTheChangeIsFelt(*row, witness_, inputs, out.acceleration_mps2)) ++count.changed;
    }
    witness_.Note(out, before, step, inputs);
    EXPECT_EQ(out.acceleration_mps2, witness_.Source(out.authority, inputs));
    ExpectTheLimits(out, inputs, scenario_.arbitrator.take_over, scenario_.step_s);
    if (out.state == kMrmDone) ExpectLocked(before, inputs);
    EXPECT_FALSE(manoeuvred && out.state == kAutomated);
    ExpectNothingLingers(header, inputs, out);
    Log(header, out);
    events_.Apply(out.acceleration_mps2);
  }

  /// Other offers, until the controllers of the old state and of the new one want different things.
  /// The two stages of the manoeuvre may both be bound by the jerk, whatever is offered.
  void LetTheControllersDiffer(const TakeOverRow& row) {
    constexpr double kPlain_mps2 = 0.01;
    const Authority old_authority = AuthorityOf(row.state);
    if (row.authority == old_authority) return;
    const TakeOverInputs& inputs = events_.inputs();
    for (int k = 0; k < 30; ++k) {
      if (std::abs(witness_.Would(old_authority, inputs) - witness_.Would(row.authority, inputs)) >
          kPlain_mps2) {
        return;
      }
      events_.OtherOffers();
    }
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
    const Authority old_authority = AuthorityOf(row.state);
    if (row.authority == old_authority) {
      EXPECT_EQ(counts[i].changed, 0);
    } else if (row.next == kMrmDone) {
      EXPECT_EQ(counts[i].changed, 0) << "where the car stands neither stage has anything to do";
    } else if (old_authority == Authority::kComfort && row.authority == Authority::kHard) {
      EXPECT_GT(counts[i].changed, 0);
    } else {
      EXPECT_EQ(counts[i].changed, counts[i].taken);
    }
  }
}

TEST(TakeOverPropertyTest, BeginsNoManoeuvreBeforeTenSecondsWhateverTheLeadTime) {
  int manoeuvres = 0;
  for (double lead_s = 0.5; lead_s < 20; lead_s += 0.37) {
    Scenario scenario;
    scenario.arbitrator.take_over = {
        .mode = TakeOverMode::kRequested, .lead_s = lead_s, .absent_probability = 1};
    if (lead_s < 10) {
      EXPECT_THROW(TakeOver{scenario}, std::invalid_argument) << lead_s;
      continue;
    }
    TakeOver take_over(scenario);
    header_t header{};
    while (!take_over.in_manoeuvre() && header.step < 1000) {
      take_over.Step(header, {.human_wanted = true, .speed_mps = 20});
      ++header.step;
    }
    ASSERT_TRUE(take_over.request()->manoeuvre);
    const double after_s =
        static_cast<double>(*take_over.request()->manoeuvre - take_over.request()->requested) *
        scenario.step_s;
    EXPECT_GE(after_s, 10 - kRounding);
    EXPECT_NEAR(after_s, lead_s, scenario.step_s) << "and not much later than it says";
    ++manoeuvres;
  }
  EXPECT_GT(manoeuvres, 20);
}

}  // namespace
}  // namespace fogline
