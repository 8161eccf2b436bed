#include "services/recorder/history.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "services/runtime/scenario_parts.h"

namespace fogline {
namespace {

constexpr std::size_t kStepChannels = [] {
  std::size_t count = 0;
  for (const ChannelInfo& channel : kChannels) count += channel.pace == Pace::kStep ? 1 : 0;
  return count;
}();

/// Names of the per-step channels, in the order in which a step stands in a log.
constexpr std::array<std::string_view, kStepChannels> kStepNames = [] {
  std::array<std::string_view, kStepChannels> names;
  std::size_t i = 0;
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace == Pace::kStep) names[i++] = channel.name;
  }
  return names;
}();

/// Follows the events of a log as the recorder writes them: the scenario, then whole steps.
class Follower {
 public:
  Follower(std::filesystem::path file, std::int64_t run_id) : file_(std::move(file)) {
    run_id_ = run_id;
  }

  /// @return false at the first event that does not continue what the recorder wrote
  bool Take(const Event& event, std::size_t end) {
    ++events_;
    if (event.data.size() < kHeaderEnd) return false;
    if (const std::int64_t id = ReadInt64(event.data, kRunIdOffset); id != run_id_) {
      throw InputError(
          fmt::format("{}: the log is that of run {}, not of {}", file_.string(), id, run_id_));
    }
    if (parts_.Complete()) {
      return realtime_ ? TakeRealtimeEvent(event, end) : TakeStepEvent(event, end);
    }
    run_t run{};
    if (event.channel != ChannelOf<run_t>().name || !Decode(event.data, run)) return false;
    if (!parts_.Add(run)) return false;
    realtime_ = run.realtime != 0;
    if (parts_.Complete()) {
      remains_.begin = static_cast<std::int64_t>(end);
      remains_.head = {.bytes = remains_.begin, .events = events_};
    }
    return true;
  }

  const ScenarioParts& parts() const { return parts_; }
  const Remains& remains() const { return remains_; }

 private:
  bool TakeStepEvent(const Event& event, std::size_t end) {
    const auto step = static_cast<std::int64_t>(remains_.ends.size());
    if (event.channel != kStepNames[next_] || ReadInt64(event.data, kStepOffset) != step) {
      return false;
    }
    if (event.channel == ChannelOf<truth_t>().name && Decode(event.data, truth_)) {
      last_ = truth_.last;
    }
    if (++next_ < kStepChannels) return true;
    next_ = 0;
    remains_.final = last_;
    remains_.ends.push_back(static_cast<std::int64_t>(end));
    remains_.head = {.bytes = remains_.ends.back(), .events = events_};
    return true;
  }

  /// In real time steps may lack messages, and STATUS stands between them: a step is known to end
  /// where a later one begins, or when it has all its messages.
  bool TakeRealtimeEvent(const Event& event, std::size_t end) {
    const auto begin = static_cast<std::int64_t>(end - SizeInFile(event));
    const std::int64_t step = ReadInt64(event.data, kStepOffset);
    const auto open = static_cast<std::int64_t>(remains_.ends.size());
    if (event.channel == ChannelOf<status_t>().name) return true;
    if (std::ranges::find(kStepNames, event.channel) == kStepNames.end()) return false;
    if (step < open || step > open + kLongestGap) return false;
    if (step > open) {
      next_ = 0;
      remains_.ends.insert(remains_.ends.end(), static_cast<std::size_t>(step - open), begin);
      remains_.head = {.bytes = begin, .events = events_ - 1};
    }
    if (event.channel == ChannelOf<truth_t>().name && Decode(event.data, truth_)) {
      remains_.final = truth_.last;
    }
    if (++next_ < kStepChannels) return true;
    next_ = 0;
    remains_.ends.push_back(static_cast<std::int64_t>(end));
    remains_.head = {.bytes = static_cast<std::int64_t>(end), .events = events_};
    return true;
  }

  // More steps than a run can lose in a row before it has ended for another reason.
  static constexpr std::int64_t kLongestGap = 1'000'000;

  std::filesystem::path file_;
  std::int64_t run_id_;
  bool realtime_ = false;
  ScenarioParts parts_;
  Remains remains_;
  std::int64_t events_ = 0;
  std::size_t next_ = 0;  // channel of kStepNames that comes next
  truth_t truth_{};
  bool last_ = false;
};

}  // namespace

History::History(std::filesystem::path file, std::int64_t begin)
    : file_(std::move(file)), ends_{begin} {}

History::~History() {
  if (fd_ >= 0) close(fd_);
}

void History::ForEach(std::string_view channel, StepRange steps,
                      const std::function<void(Bytes)>& use) {
  if (fd_ < 0) fd_ = open(file_.c_str(), O_RDONLY | O_CLOEXEC);
  const auto first = static_cast<std::size_t>(steps.first);
  const std::int64_t begin = ends_[first];
  const std::int64_t end = ends_[first + static_cast<std::size_t>(steps.count)];
  chunk_.resize(static_cast<std::size_t>(end - begin));
  const ssize_t size = fd_ < 0 ? -1 : pread(fd_, chunk_.data(), chunk_.size(), begin);
  if (size != end - begin) {
    throw std::runtime_error(fmt::format("cannot read {} again: {}", file_.string(),
                                         size < 0 ? std::strerror(errno) : "it is too short"));
  }
  std::string_view why;
  for (Bytes rest = chunk_; !rest.empty();) {
    const auto event = ParseEvent(rest, why);
    if (!event) throw std::runtime_error(fmt::format("{}: {}", file_.string(), why));
    if (event->channel == channel) use(event->data);
    rest = rest.subspan(SizeInFile(*event));
  }
}

std::optional<Remains> ReadRemains(const std::filesystem::path& file, std::int64_t run_id,
                                   const std::string& scenario_hash) {
  std::error_code missing;
  if (std::filesystem::file_size(file, missing) == 0 || missing) return std::nullopt;
  EventLogReader reader(file);
  Follower follower(file, run_id);
  while (const auto event = reader.Next()) {
    if (!follower.Take(*event, reader.good_bytes())) break;
  }
  const ScenarioParts& parts = follower.parts();
  if (!parts.empty() && parts.hash() != scenario_hash) {
    throw InputError(fmt::format("{}: the log is that of another scenario", file.string()));
  }
  if (!parts.Complete()) return std::nullopt;
  if (!parts.HashHolds()) {
    throw InputError(
        fmt::format("{}: the scenario in the log does not match its hash", file.string()));
  }
  return follower.remains();
}

}  // namespace fogline
