#include "services/log/driver_inputs.h"

#include <cstdint>
#include <vector>

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "services/log/event_log.h"
#include "services/runtime/wire/message_signer.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

using testing::ElementsAre;

constexpr std::int64_t kRun = 7;

driver_input_t Input(std::int64_t sequence) {
  driver_input_t input{};
  input.header.run_id = kRun;
  input.instance = 3;
  input.sequence = sequence;
  input.present = 1;
  return input;
}

class DriverInputsTest : public testing::Test {
 protected:
  /// Appends a message to the log. @param end bytes after the message
  template <class M>
  void Write(const M& message, const std::vector<std::uint8_t>& end = {}) {
    std::vector<std::uint8_t> bytes;
    runtime::Encode(message, bytes);
    bytes.insert(bytes.end(), end.begin(), end.end());
    writer_.Write(ChannelOf<M>().name, message.header.utime, bytes);
  }
  std::vector<std::int64_t> Sequences() {
    writer_.Flush();
    std::vector<std::int64_t> sequences;
    log::ForEachDriverInput(
        file_, kRun, [&](const driver_input_t& input) { sequences.push_back(input.sequence); });
    return sequences;
  }
  std::vector<driver_input_t> Read() {
    writer_.Flush();
    return log::ReadDriverInputs(file_, kRun);
  }

 private:
  test::ScratchFolder folder_;
  const std::string file_ = folder_.File("log");
  log::EventLogWriter writer_{file_};
};

TEST_F(DriverInputsTest, AreReadInTheOrderOfTheLogAmongOtherMessages) {
  Write(Input(0));
  Write(truth_t{});
  Write(Input(2));
  Write(Input(1));
  EXPECT_THAT(Sequences(), ElementsAre(0, 2, 1));
}

TEST_F(DriverInputsTest, OfAnotherRunAreLeftOut) {
  driver_input_t other = Input(1);
  other.header.run_id = kRun + 1;
  Write(Input(0));
  Write(other);
  EXPECT_THAT(Sequences(), ElementsAre(0));
}

TEST_F(DriverInputsTest, WithAValueThatTheDriverRefusesAreLeftOut) {
  driver_input_t wrong = Input(1);
  wrong.brake = 1.5;
  Write(Input(0));
  Write(wrong);
  EXPECT_THAT(Sequences(), ElementsAre(0));
}

TEST_F(DriverInputsTest, MayHaveSignatures) {
  std::vector<std::uint8_t> signature(runtime::kSignatureMagic.begin(),
                                      runtime::kSignatureMagic.end());
  signature.resize(runtime::kSignatureBytes);
  Write(Input(5), signature);
  EXPECT_THAT(Sequences(), ElementsAre(5));
}

TEST_F(DriverInputsTest, AreFoundByWhatACommandNames) {
  Write(Input(5));
  const log::DriverInputs inputs(Read());
  ASSERT_NE(inputs.Find(3, 5), nullptr);
  EXPECT_EQ(inputs.Find(3, 5)->sequence, 5);
  EXPECT_EQ(inputs.Find(3, 6), nullptr);
  EXPECT_EQ(inputs.Find(4, 5), nullptr);
}

}  // namespace
}  // namespace fogline
