// The state machine of take-overs under random sequences of events. The tests compare the states of
// the machine with the table of its transitions (take_over_table.h). They compare its commands and
// its log with an independent computation.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "services/decision/take_over/take_over.h"
#include "services/decision/take_over/take_over_log.h"
#include "tests/property/services/decision/take_over/take_over_witness.h"

namespace fogline::test {
namespace {

using enum take_over::TakeOverState;

constexpr std::int64_t kSequences = 10'000;
constexpr std::int64_t kSteps = 300;

/// How often the state machine made the transition of a row of the table, and how often this
/// transition changed the command.
struct RowCount {
  int taken = 0;
  int changed = 0;
};
using RowCounts = std::array<RowCount, take_over::kTakeOverTable.size()>;

std::size_t PlaceOf(const take_over::TakeOverRow& row) {
  return static_cast<std::size_t>(&row - take_over::kTakeOverTable.data());
}

/// Checks one step against the table.
void ExpectTheTable(const take_over::TakeOverRow* row, take_over::TakeOverState before,
                    take_over::TakeOverState after) {
  EXPECT_EQ(after, row == nullptr ? before : row->next)
      << "from " << take_over::InfoOf(before).name << " to " << take_over::InfoOf(after).name;
}

/// Expects that a change of state changes the command in the same step. `applied_mps2` must be the
/// command of the new state's controller. The old state's controller must want another command for
/// the same inputs. If both states have the same controller, this controller must give the command.
///
/// Only the change to the harder stage of the manoeuvre may have its effect later. The jerk limit,
/// or the limit shortly before standstill, may allow less deceleration than the softer stage wants.
/// In this case both stages command this limit.
/// @return whether the command changed
bool ExpectTheChangeIsFelt(const take_over::TakeOverRow& row, const Witness& witness,
                           const take_over::TakeOverInputs& inputs, double applied_mps2) {
  const take_over::Authority old_authority = take_over::AuthorityOf(row.state);
  const double old_mps2 = witness.Would(old_authority, inputs);
  EXPECT_EQ(applied_mps2, witness.Would(row.authority, inputs));
  if (row.authority == old_authority) {
    EXPECT_EQ(applied_mps2, old_mps2);
    return false;
  }
  const bool changed = std::abs(applied_mps2 - old_mps2) > kTolerance;
  const bool harder = old_authority == take_over::Authority::kComfort &&
                      row.authority == take_over::Authority::kHard;
  EXPECT_TRUE(changed || (harder && applied_mps2 == witness.WouldAtMost(inputs)))
      << take_over::InfoOf(row.state).name << " -> " << take_over::InfoOf(row.next).name << ": "
      << applied_mps2 << " m/s2 as before";
  return changed;
}

void ExpectNoManoeuvreTooEarly(const take_over::TakeOverRow& row, const Witness& witness,
                               std::int64_t step, const take_over::TakeOverInputs& inputs,
                               const TakeOverSection& section) {
  if (row.authority < take_over::Authority::kComfort ||
      take_over::AuthorityOf(row.state) >= take_over::Authority::kHuman)
    return;
  if (row.next == kMrmComfort) {
    EXPECT_GE(witness.SinceRequest(step), section.lead_s - kTolerance);
    EXPECT_GE(witness.SinceRequest(step), 10 - kTolerance) << "UN R157, 5.4.4.1";
  } else {
    EXPECT_LT(Witness::Ttc_s(inputs), section.severe_ttc_s);
  }
}

void ExpectTheLimits(const take_over::TakeOverOutcome& out, const take_over::TakeOverInputs& inputs,
                     const TakeOverSection& section, double step_s) {
  if (out.authority == take_over::Authority::kEasing) {
    // With authority kEasing, the command is positive only while the jerk limit requires it.
    EXPECT_LE(out.acceleration_mps2,
              std::max(0.0, inputs.applied_mps2 - section.jerk_mps3 * step_s) + kTolerance);
  }
  if (out.authority < take_over::Authority::kComfort) return;
  // Before the manoeuvre, the car may brake harder than the manoeuvre is allowed to. The manoeuvre
  // then releases the brake within the jerk limit.
  EXPECT_GE(out.acceleration_mps2,
            std::min(-section.emergency_deceleration_mps2, inputs.applied_mps2) - kTolerance);
  const bool standing = inputs.speed_mps == 0 && out.acceleration_mps2 == 0;
  if (standing) return;
  EXPECT_LE(std::abs(out.acceleration_mps2 - inputs.applied_mps2),
            section.jerk_mps3 * step_s + kTolerance);
}

class Sequence {
 public:
  explicit Sequence(std::int64_t number)
      : dice_(number),
        scenario_(AnyScenario(dice_)),
        events_(dice_, scenario_),
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
    const take_over::TakeOverState before = take_over_.outcome().state;
    const bool manoeuvred = witness_.manoeuvred();
    const take_over::TakeOverInputs& inputs = events_.Next();
    const take_over::TakeOverRow* row =
        take_over::TakeOverRowOf(before, witness_.EventsOf(step, inputs), manoeuvred);
    if (row != nullptr) LetTheControllersDiffer(*row);
    header_t header{};
    header.step = step;

    const take_over::TakeOverOutcome& out = take_over_.Step(header, inputs);

    ExpectTheTable(row, before, out.state);
    EXPECT_EQ(out.authority, take_over::AuthorityOf(out.state));
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
    if (take_over_.request()) {
      request_ = take_over_.request();
      NoteTheDriver(before, step, out);
    }
    events_.Apply(out.acceleration_mps2);
  }

  /// Draws other offers until the controllers of the old and of the new state want different
  /// commands. With equal commands the change of state would have no effect. The function gives up
  /// after 30 draws, because the jerk limit may force both stages of the manoeuvre to the same
  /// acceleration, whatever the offers are.
  void LetTheControllersDiffer(const take_over::TakeOverRow& row) {
    constexpr double kPlain_mps2 = 0.01;
    const take_over::Authority old_authority = take_over::AuthorityOf(row.state);
    if (row.authority == old_authority) return;
    const take_over::TakeOverInputs& inputs = events_.inputs();
    for (int k = 0; k < 30; ++k) {
      if (std::abs(witness_.Would(old_authority, inputs) - witness_.Would(row.authority, inputs)) >
          kPlain_mps2) {
        return;
      }
      events_.OtherOffers();
    }
  }

  void ExpectLocked(take_over::TakeOverState before, const take_over::TakeOverInputs& inputs) {
    if (before != kMrmDone) return;
    EXPECT_LT(inputs.speed_mps, 0.01);
    EXPECT_LE(take_over_.outcome().acceleration_mps2, 0.0);
    EXPECT_EQ(take_over_.outcome().state, kMrmDone);
  }

  // An offer of a side without authority must have no effect.
  void ExpectNothingLingers(const header_t& header, take_over::TakeOverInputs inputs,
                            const take_over::TakeOverOutcome& out) {
    constexpr double kNonsense = 1e9;
    if (out.authority != take_over::Authority::kHuman) inputs.human_mps2 = kNonsense;
    const bool automation_counts = out.authority == take_over::Authority::kAutomation ||
                                   out.authority == take_over::Authority::kEasing ||
                                   out.authority == take_over::Authority::kComfort;
    if (!automation_counts) inputs.automation_mps2 = kNonsense;
    const take_over::TakeOverOutcome& same = twin_.Step(header, inputs);
    EXPECT_EQ(same.state, out.state);
    EXPECT_EQ(same.acceleration_mps2, out.acceleration_mps2);
  }

  void Log(const header_t& header, const take_over::TakeOverOutcome& out) {
    arbitration_t command{};
    command.header = header;
    command.mode = take_over::InfoOf(out.state).mode;
    command.acceleration_mps2 = out.acceleration_mps2;
    command.lambda_human = out.authority == take_over::Authority::kHuman ? 1 : 0;
    log_.Add(command, events_.inputs().human_mps2);
  }

  /// Notes the first step in which the driver's command differs from the last command before the
  /// transfer to the human.
  void NoteTheDriver(take_over::TakeOverState before, std::int64_t step,
                     const take_over::TakeOverOutcome& out) {
    if (out.state == kDemand && before == kAutomated) effective_.reset();
    if (out.authority != take_over::Authority::kHuman) return;
    if (take_over::AuthorityOf(before) != take_over::Authority::kHuman) {
      before_driver_mps2_ = events_.inputs().applied_mps2;
    }
    if (effective_) return;
    if (std::abs(out.acceleration_mps2 - before_driver_mps2_) >= 0.01) effective_ = step;
  }

  void ExpectTheLogTellsTheRequest() {
    if (!request_) {
      EXPECT_TRUE(log_.requests().empty());
      return;
    }
    ASSERT_FALSE(log_.requests().empty());
    take_over::TakeOverRequest expected = *request_;
    expected.effective = effective_;
    EXPECT_EQ(log_.requests().back(), expected);
  }

  Dice dice_;
  Scenario scenario_;
  Events events_;
  take_over::TakeOver take_over_;
  take_over::TakeOver twin_;
  Witness witness_;
  take_over::TakeOverLog log_;
  std::optional<take_over::TakeOverRequest> request_;  // the last request
  double before_driver_mps2_ = 0;
  std::optional<std::int64_t> effective_;
};

TEST(TakeOverPropertyTest, KeepsToItsTableAndItsLimitsOverTenThousandSequences) {
  RowCounts counts{};
  for (std::int64_t i = 0; i < kSequences; ++i) {
    Sequence(i).Run(counts);
    ASSERT_FALSE(HasFailure()) << "sequence " << i;
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const take_over::TakeOverRow& row = take_over::kTakeOverTable[i];
    SCOPED_TRACE(testing::Message()
                 << take_over::InfoOf(row.state).name << " -> " << take_over::InfoOf(row.next).name
                 << ", " << counts[i].taken << " times");
    EXPECT_GT(counts[i].taken, 0) << "never taken";
    const take_over::Authority old_authority = take_over::AuthorityOf(row.state);
    if (row.authority == old_authority) {
      EXPECT_EQ(counts[i].changed, 0);
    } else if (row.next == kMrmDone) {
      EXPECT_EQ(counts[i].changed, 0) << "where the car stands neither stage has anything to do";
    } else if (old_authority == take_over::Authority::kComfort &&
               row.authority == take_over::Authority::kHard) {
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
      EXPECT_THROW(take_over::TakeOver{scenario}, std::invalid_argument) << lead_s;
      continue;
    }
    take_over::TakeOver take_over(scenario);
    header_t header{};
    while (!take_over.in_manoeuvre() && header.step < 1000) {
      take_over.Step(header, {.human_wanted = true, .speed_mps = 20});
      ++header.step;
    }
    ASSERT_TRUE(take_over.request()->manoeuvre);
    const double after_s =
        static_cast<double>(*take_over.request()->manoeuvre - take_over.request()->requested) *
        scenario.step_s;
    EXPECT_GE(after_s, 10 - kTolerance);
    EXPECT_NEAR(after_s, lead_s, scenario.step_s) << "and not much later than it says";
    ++manoeuvres;
  }
  EXPECT_GT(manoeuvres, 20);
}

}  // namespace
}  // namespace fogline::test
