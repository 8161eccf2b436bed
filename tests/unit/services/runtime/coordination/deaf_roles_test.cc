#include "services/runtime/coordination/deaf_roles.h"

#include <optional>

#include <gtest/gtest.h>

#include "services/runtime/wire/wire.h"

namespace fogline {
namespace {

constexpr Duration kPeriod = milliseconds(100);

class DeafRolesTest : public testing::Test {
 protected:
  /// The state of the radar's input, as the radar reports it in STATUS.
  struct Ear {
    std::int64_t age_ms;
    std::int8_t state = status_t::INPUT_LOST;
    std::int64_t late = 0;
    std::int64_t step = 17;  // last step that the radar has computed
  };
  void SayWorld() {
    status_t status{};
    status.header.step = world_step_;
    status.ticks = world_ticks_ ? *world_ticks_ : world_step_;
    deaf_.Heard(Role::kWorld, status, now_);
  }
  void SayRadar(const Ear& ear) {
    status_t status{};
    status.header.step = ear.step;
    status.num_inputs = 1;
    status.input = {"TRUTH"};
    status.input_state = {ear.state};
    status.input_age_us = {1000 * ear.age_ms};
    status.input_rate_hz = {0};
    status.input_late = {ear.late};
    deaf_.Heard(Role::kRadar, status, now_);
  }
  /// Passes the next STATUS of the radar, with no STATUS of the world before it.
  void SayRadarAfter(Duration time, std::int64_t age_ms) {
    now_ += time;
    age_ms_ = age_ms;
    SayRadar({.age_ms = age_ms_});
  }
  /// Passes `signs` STATUS messages of the world and of the radar. Between two STATUS messages the
  /// world computes two steps. Each time the radar's input gets 200 ms older.
  void Pass(int signs, std::int8_t state = status_t::INPUT_LOST) {
    for (int i = 0; i < signs; ++i) {
      now_ += milliseconds(200);
      world_step_ += 2;
      age_ms_ += 200;
      SayWorld();
      SayRadar({.age_ms = age_ms_, .state = state});
    }
  }
  /// The world computes a step in 400 ms, `messages` times. The messages of these steps do not
  /// come.
  void Lose(int messages) {
    for (int i = 0; i < messages; ++i) {
      Pass(2);
      ++*world_ticks_;
    }
  }
  bool IsDeaf() const { return deaf_.Of(Role::kRadar).has_value(); }

  runtime::DeafRoles deaf_{kPeriod};
  TimePoint now_{std::chrono::hours(5)};
  std::int64_t world_step_ = 20;
  std::optional<std::int64_t> world_ticks_;  // nullopt: the world has computed every step
  std::int64_t age_ms_ = 0;
};

TEST_F(DeafRolesTest, ARoleIsDeafThatHearsNothingOfWhatIsPublishedForTwoSeconds) {
  Pass(10);
  EXPECT_FALSE(IsDeaf()) << "the first sign of life tells of no time";
  Pass(1);
  const auto deaf = deaf_.Of(Role::kRadar);
  ASSERT_TRUE(deaf);
  EXPECT_EQ(deaf->channel, IndexOf<truth_t>());
  EXPECT_EQ(deaf->missed, milliseconds(2000));
  EXPECT_EQ(Text(*deaf), "has heard no TRUTH for 2.0 s, although the world has published it");
  EXPECT_FALSE(deaf_.Of(Role::kWorld));
}

TEST_F(DeafRolesTest, TheLossOfTheFewMessagesOfASlowProducerMakesNoRoleDeaf) {
  // GIVEN a producer that leaves out most steps: it computes one step in 400 ms
  world_ticks_ = 1;
  Pass(1);
  Lose(9);
  // WHEN the role has received nothing for 3.6 s, THEN it is not deaf: so few lost messages can be
  // chance
  EXPECT_FALSE(IsDeaf());
  // WHEN ten messages have not come, THEN the role is deaf: this cannot be chance
  Lose(1);
  Pass(1);
  EXPECT_TRUE(IsDeaf());
}

TEST_F(DeafRolesTest, AMessageThatCameIsNotMissingIfTheStatusBeforeItWasLost) {
  // GIVEN a slow producer that has published three messages since its last STATUS. The role has
  // received the third one.
  world_ticks_ = 1;
  Pass(1);
  SayRadarAfter(milliseconds(200), 0);
  SayRadarAfter(milliseconds(200), 200);
  world_ticks_ = 4;
  // WHEN the role does not receive the next nine messages, THEN it is not deaf: this can be chance
  Lose(9);
  Pass(1);
  EXPECT_FALSE(IsDeaf());
  // WHEN it does not receive the tenth message either, THEN it is deaf: this cannot be chance
  ++*world_ticks_;
  Pass(1);
  EXPECT_TRUE(IsDeaf());
}

TEST_F(DeafRolesTest, AMessageThatCameIsNotMissingForAReaderThatIsLate) {
  // GIVEN a reader that reads two STATUS messages of the role within 1 ms. A message has come to
  // the role between them.
  world_ticks_ = 1;
  Pass(3);
  world_ticks_ = 9;
  SayWorld();
  SayRadarAfter(milliseconds(1), 100);
  // WHEN the role does not receive the next two messages, THEN it is not deaf
  Pass(9);
  world_ticks_ = 11;
  Pass(1);
  EXPECT_FALSE(IsDeaf());
}

TEST_F(DeafRolesTest, TheMessagesOfAProducerThatWasStartedAgainAreCountedFromItsStart) {
  // GIVEN a slow producer whose last nine messages have not come, and which is then started again
  world_ticks_ = 50;
  Pass(2);
  world_ticks_ = 59;
  Pass(10);
  EXPECT_FALSE(IsDeaf());
  world_ticks_ = 1;
  Pass(2);
  EXPECT_FALSE(IsDeaf());
  // WHEN ten messages of the new process have not come, THEN the role is deaf
  world_ticks_ = 11;
  Pass(1);
  EXPECT_TRUE(IsDeaf());
}

TEST_F(DeafRolesTest, AtTheEndASecondIsEnough) {
  Pass(5);
  EXPECT_FALSE(deaf_.AtTheEnd(Role::kRadar));
  Pass(1);
  EXPECT_TRUE(deaf_.AtTheEnd(Role::kRadar));
  // Time without a step does not count, because the world publishes nothing in this time.
  for (int i = 0; i < 20; ++i) {
    now_ += milliseconds(200);
    age_ms_ += 200;
    SayWorld();
    SayRadar({.age_ms = age_ms_});
  }
  EXPECT_TRUE(deaf_.AtTheEnd(Role::kRadar));
}

TEST_F(DeafRolesTest, ARoleThatWasStartedAgainAndHeardNothingYetIsDeafToo) {
  for (int i = 0; i < 11; ++i) {
    age_ms_ = -200;  // Pass() makes it 0, the age of an input that never came
    Pass(1, status_t::INPUT_AWAITED);
  }
  EXPECT_TRUE(IsDeaf());
}

TEST_F(DeafRolesTest, AWorldThatStandsStillMakesNoRoleDeaf) {
  for (int i = 0; i < 20; ++i) {
    world_step_ = 20;
    Pass(1);
  }
  EXPECT_FALSE(IsDeaf());
}

TEST_F(DeafRolesTest, AMessageNowAndThenOrALateOneIsHeard) {
  for (int i = 0; i < 20; ++i) {
    Pass(5);
    age_ms_ = 50;
    SayRadar({.age_ms = 50, .state = status_t::INPUT_LOST});
  }
  EXPECT_FALSE(IsDeaf());
  for (int i = 1; i < 20; ++i) {
    Pass(5);
    SayRadar({.age_ms = age_ms_, .late = i});
  }
  EXPECT_FALSE(IsDeaf());
}

TEST_F(DeafRolesTest, WhatComesLateToARoleThatIsAheadOfItsProducerIsNotHeard) {
  // GIVEN a role that has computed a forged step far ahead, so all genuine messages come too late
  const auto pass_ahead = [this](std::int64_t steps) {
    for (int i = 1; i <= 12; ++i) {
      now_ += milliseconds(200);
      world_step_ += 2;
      age_ms_ += 200;
      SayWorld();
      SayRadar({.age_ms = age_ms_, .late = 100 * steps + i, .step = world_step_ + steps});
    }
  };
  pass_ahead(1);
  EXPECT_FALSE(IsDeaf()) << "its producer is slow";
  pass_ahead(12);
  EXPECT_TRUE(IsDeaf());
}

TEST_F(DeafRolesTest, AtTheEndNothingIsMissedOfStepsThatNeverWere) {
  Pass(3);
  // WHEN the world has computed its last step, THEN the role is not deaf: it misses no message
  // while the world computes no step
  for (int i = 0; i < 5; ++i) {
    now_ += milliseconds(200);
    age_ms_ += 200;
    SayWorld();
    SayRadar({.age_ms = age_ms_});
  }
  EXPECT_FALSE(deaf_.AtTheEnd(Role::kRadar));
}

TEST_F(DeafRolesTest, OfATimeInWhichItIsNotHeardItselfNothingIsKnown) {
  Pass(2);
  for (int i = 0; i < 20; ++i) {
    now_ += milliseconds(3000);
    world_step_ += 30;
    age_ms_ += 3000;
    SayWorld();
    SayRadar({.age_ms = age_ms_});
  }
  EXPECT_FALSE(IsDeaf());
}

TEST_F(DeafRolesTest, AReaderThatIsLateForgetsNoSilence) {
  // GIVEN a reader of STATUS that gets three messages together, and then none for half a second
  for (int i = 1; i <= 12; ++i) {
    now_ += milliseconds(i % 3 == 0 ? 598 : 1);
    world_step_ += 2;
    age_ms_ += 200;
    SayWorld();
    SayRadar({.age_ms = age_ms_});
  }
  EXPECT_TRUE(IsDeaf());
  // WHEN the radar's input gets messages again, THEN the radar is not deaf any more
  age_ms_ = 0;
  for (int i = 1; i <= 6; ++i) {
    now_ += milliseconds(i % 3 == 0 ? 598 : 1);
    world_step_ += 2;
    age_ms_ += 100;
    SayWorld();
    SayRadar({.age_ms = age_ms_});
  }
  EXPECT_FALSE(IsDeaf());
  EXPECT_FALSE(deaf_.AtTheEnd(Role::kRadar));
}

TEST_F(DeafRolesTest, ItsSuccessorIsNot) {
  Pass(20);
  EXPECT_TRUE(IsDeaf());
  deaf_.Forget(Role::kRadar);
  EXPECT_FALSE(IsDeaf());
}

TEST_F(DeafRolesTest, InLockstepNoRoleIsDeaf) {
  deaf_ = runtime::DeafRoles(Duration::zero());
  Pass(20);
  EXPECT_FALSE(IsDeaf());
}

TEST_F(DeafRolesTest, WhatIsNoInputIsIgnored) {
  status_t status{};
  status.num_inputs = 2;
  status.input = {"RUN", "nothing"};
  status.input_state = {status_t::INPUT_LOST, status_t::INPUT_LOST};
  status.input_age_us = {std::numeric_limits<std::int64_t>::max(),
                         std::numeric_limits<std::int64_t>::min()};
  status.input_rate_hz = {0, 0};
  status.input_late = {0, 0};
  for (int i = 0; i < 20; ++i) {
    now_ += milliseconds(200);
    deaf_.Heard(Role::kRadar, status, now_);
  }
  EXPECT_FALSE(IsDeaf());
}

}  // namespace
}  // namespace fogline
