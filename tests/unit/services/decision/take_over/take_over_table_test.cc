#include "services/decision/take_over/take_over_table.h"

#include <cstdint>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace fogline {
namespace {

using enum take_over::TakeOverState;
using Change = std::pair<take_over::TakeOverState, take_over::TakeOverState>;

constexpr unsigned kEventSets = 1U << 12;

// The allowed changes of state, without their events. The test compares the table with this second,
// independent list.
const std::set<Change> kChanges{
    {kAutomated, kDemand},        {kDemand, kUrgentDemand},       {kDemand, kHandover},
    {kDemand, kMrmComfort},       {kDemand, kMrmEmergency},       {kUrgentDemand, kHandover},
    {kUrgentDemand, kMrmComfort}, {kUrgentDemand, kMrmEmergency}, {kHandover, kRecovering},
    {kHandover, kMrmComfort},     {kHandover, kMrmEmergency},     {kRecovering, kManual},
    {kManual, kAutomated},        {kMrmComfort, kMrmDone},        {kMrmComfort, kRecovering},
    {kMrmComfort, kMrmEmergency}, {kMrmEmergency, kMrmDone},      {kMrmEmergency, kRecovering},
    {kMrmEmergency, kMrmFailed},  {kMrmFailed, kMrmDone},         {kMrmFailed, kRecovering},
    {kAutomated, kRecovering},    {kDemand, kRecovering},         {kUrgentDemand, kRecovering},
    {kRecovering, kMrmComfort},   {kManual, kMrmComfort}};

TEST(TakeOverTableTest, HasTheseChangesOfStateAndNoOtherWhateverHappens) {
  std::set<Change> seen;
  std::set<const take_over::TakeOverRow*> taken;
  for (const take_over::TakeOverStateInfo& info : take_over::kTakeOverStates) {
    for (unsigned events = 0; events < kEventSets; ++events) {
      for (const bool manoeuvred : {false, true}) {
        const take_over::TakeOverRow* row = take_over::TakeOverRowOf(
            info.state, static_cast<take_over::TakeOverEvents>(events), manoeuvred);
        if (row == nullptr) continue;
        ASSERT_EQ(row->state, info.state);
        ASSERT_NE(events & take_over::Bit(row->event), 0U);
        seen.emplace(row->state, row->next);
        taken.insert(row);
      }
    }
  }
  EXPECT_EQ(seen, kChanges);
  EXPECT_EQ(taken.size(), take_over::kTakeOverTable.size()) << "a row that nothing leads to";
}

TEST(TakeOverTableTest, GivesAuthorityToADriverWhoOverridesWhateverElseHappens) {
  using enum take_over::TakeOverEvent;
  for (const take_over::TakeOverStateInfo& info : take_over::kTakeOverStates) {
    if (info.state == kMrmDone) continue;
    const take_over::Authority authority = take_over::AuthorityOf(info.state);
    if (authority == take_over::Authority::kHuman) continue;
    for (unsigned set = 0; set < kEventSets; ++set) {
      const auto events = static_cast<take_over::TakeOverEvents>(set | take_over::Bit(kOverride));
      const bool stands = (events & take_over::Bit(kStandstill)) != 0;
      if (stands && authority >= take_over::Authority::kComfort) continue;
      const take_over::TakeOverRow* row =
          take_over::TakeOverRowOf(info.state, events, /*manoeuvred=*/false);
      ASSERT_NE(row, nullptr) << info.name;
      EXPECT_EQ(row->next, kRecovering) << info.name << ", events " << set;
    }
  }
}

TEST(TakeOverTableTest, NeverLeavesTheLock) {
  for (unsigned events = 0; events < kEventSets; ++events) {
    EXPECT_EQ(
        take_over::TakeOverRowOf(kMrmDone, static_cast<take_over::TakeOverEvents>(events), true),
        nullptr);
  }
}

TEST(TakeOverTableTest, NeverReturnsToTheAutomationAfterAManoeuvre) {
  for (const take_over::TakeOverStateInfo& info : take_over::kTakeOverStates) {
    for (unsigned events = 0; events < kEventSets; ++events) {
      const take_over::TakeOverRow* row = take_over::TakeOverRowOf(
          info.state, static_cast<take_over::TakeOverEvents>(events), true);
      EXPECT_TRUE(row == nullptr || row->next != kAutomated);
    }
  }
}

TEST(TakeOverTableTest, GivesEachStateAModeOfItsOwnAndThePapersTheirs) {
  std::set<std::int8_t> modes;
  std::set<std::string_view> names;
  for (const take_over::TakeOverStateInfo& info : take_over::kTakeOverStates) {
    modes.insert(info.mode);
    names.insert(info.name);
    EXPECT_NE(info.mode, arbitration_t::MINIMAL_RISK) << "failed inputs are another matter";
  }
  EXPECT_EQ(modes.size(), take_over::kTakeOverStates.size());
  EXPECT_EQ(names.size(), take_over::kTakeOverStates.size());
  EXPECT_EQ(take_over::InfoOf(kAutomated).mode, 0);
  EXPECT_EQ(take_over::InfoOf(kManual).mode, 1);
}

}  // namespace
}  // namespace fogline
