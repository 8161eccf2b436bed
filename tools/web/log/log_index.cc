#include "tools/web/log/log_index.h"

#include <algorithm>
#include <optional>

#include "services/runtime/wire/message_signer.h"

namespace fogline::web {
namespace {

/// kChannelOfRow converts an index in log::kStepNames (the channels with a message in each step)
/// into the index in kChannels. kRowOfChannel converts in the other direction. For a channel that
/// is not in kStepNames, its value is kStepChannels.
constexpr std::array<std::size_t, log::kStepChannels> kChannelOfRow = [] {
  std::array<std::size_t, log::kStepChannels> channels{};
  std::size_t row = 0;
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    if (kChannels[i].pace == Pace::kStep) channels[row++] = i;
  }
  return channels;
}();
constexpr std::array<std::size_t, kNumChannels> kRowOfChannel = [] {
  std::array<std::size_t, kNumChannels> rows{};
  rows.fill(log::kStepChannels);
  for (std::size_t row = 0; row < kChannelOfRow.size(); ++row) rows[kChannelOfRow[row]] = row;
  return rows;
}();

// Limit for the number of a step: the number of events up to its message, plus this value. Without
// the limit, one forged message with a very late step would make the index allocate memory for all
// steps before this step.
constexpr std::int64_t kLargestGap = 100'000;

constexpr std::uint64_t kMostOffset = (1ULL << 44) - 1;
constexpr std::uint64_t kMostSize = (1ULL << 20) - 1;

}  // namespace

LogIndex::LogIndex(const std::filesystem::path& file, std::optional<std::int64_t> run_id)
    : reader_(file) {
  ReadRun(file, run_id);
  ReadPlaces();
  FindEvents();
}

void LogIndex::ReadRun(const std::filesystem::path& file, std::optional<std::int64_t> run_id) {
  log::RunLogReader reader(file, {.run_id = run_id});
  while (reader.Next() != nullptr) {
  }
  run_ = reader.run();
}

void LogIndex::ReadPlaces() {
  rows_.reserve(static_cast<std::size_t>(run_.steps));
  while (const auto event = reader_.Next()) {
    ++read_;
    Take(*event);
  }
  const auto has_message = [](const Row& row) {
    return std::ranges::any_of(row, [](const Place& place) { return place.size > 0; });
  };
  first_ = std::ranges::find_if(rows_, has_message) - rows_.begin();
  if (rows_.empty()) first_ = 0;
}

void LogIndex::Take(const log::Event& event) {
  if (event.data.size() < runtime::kHeaderEnd) return;
  if (runtime::ReadInt64(event.data, runtime::kRunIdOffset) != run_.run_id) return;
  if (event.channel == ChannelOf<run_t>().name && !knows_run_) {
    run_t ignored{};
    knows_run_ = true;
    is_signed_ = runtime::LooksSigned(event.data) &&
                 runtime::Decode(runtime::WithoutSignature(event.data), ignored);
  }
  // The recorder writes the channels of a step in the order of kChannels. So the search begins at
  // the channel after the channel of the previous message, because a match there is most probable.
  for (std::size_t i = 0; i < log::kStepChannels; ++i) {
    const std::size_t row = (guess_ + i) % log::kStepChannels;
    if (log::kStepNames[row] != event.channel) continue;
    guess_ = row + 1;
    return TakeStep(row, event.data);
  }
  const std::size_t channel = ChannelNamed(event.channel);
  if (channel == kNumChannels) return;
  runtime::Bytes data = event.data;
  if (const Place place = PlaceOf(data); place.size > 0) control_[channel].push_back(place);
}

LogIndex::Place LogIndex::PlaceOf(runtime::Bytes& data) const {
  if (is_signed_) {
    // In a signed run a message without a signature does not belong to the run.
    if (!runtime::LooksSigned(data)) return {};
    data = runtime::WithoutSignature(data);
    if (data.size() < runtime::kHeaderEnd) return {};
  }
  const auto offset = static_cast<std::uint64_t>(data.data() - reader_.content().data());
  if (offset > kMostOffset || data.size() > kMostSize) return {};
  return {.offset = offset & kMostOffset, .size = data.size() & kMostSize};
}

void LogIndex::TakeStep(std::size_t row, runtime::Bytes data) {
  const Place taken = PlaceOf(data);
  if (taken.size == 0) return;
  const std::int64_t step = runtime::ReadInt64(data, runtime::kStepOffset);
  if (step < 0 || step >= std::min(run_.scenario.steps, read_ + kLargestGap)) return;
  if (step > last_step()) rows_.resize(static_cast<std::size_t>(step) + 1);
  Place& place = rows_[static_cast<std::size_t>(step)][row];
  if (place.size > 0) return;  // the log has this message twice
  place = taken;
  ++messages_;
}

runtime::Bytes LogIndex::Message(std::int64_t step, std::size_t channel) const {
  const std::size_t row = kRowOfChannel[channel];
  if (step < 0 || step > last_step() || row == log::kStepChannels) return {};
  return At(rows_[static_cast<std::size_t>(step)][row]);
}

void LogIndex::FindEvents() {
  truth_t truth{};
  arbitration_t command{};
  driver_command_t driver{};
  events_.set_person(run_.scenario.person);
  if (run_.realtime) {
    const runtime::ChannelSet& unlogged = run_.realtime->unlogged_channels;
    events_.set_may_lack_commands(!unlogged[IndexOf<arbitration_t>()] &&
                                  !unlogged[IndexOf<driver_command_t>()]);
  }
  for (std::int64_t step = first_; step <= last_step(); ++step) {
    if (runtime::Decode(Message(step, IndexOf<truth_t>()), truth)) events_.Add(truth);
    if (!runtime::Decode(Message(step, IndexOf<arbitration_t>()), command)) continue;
    const bool offered = runtime::Decode(Message(step, IndexOf<driver_command_t>()), driver);
    events_.Add(command, offered ? std::optional(driver.acceleration_mps2) : std::nullopt);
  }
}

}  // namespace fogline::web
