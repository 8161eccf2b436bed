#include "services/recorder/history.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "services/log/step_order.h"

namespace fogline::recorder {
namespace {

// The number of bytes that Look() reads. It is more than twice the size of any step, so a step
// begins in every piece of this size.
constexpr std::int64_t kLook = 2 * log::kMostStepBytes + 1;

}  // namespace

History::History(std::filesystem::path file, const log::LogFront& front,
                 const log::Remains& remains)
    : file_(std::move(file)),
      run_id_(front.run_id),
      realtime_(front.realtime),
      step_events_(front.StepEvents()),
      front_(front.head),
      steps_(remains.steps),
      last_(remains.last),
      end_(remains.head.bytes) {}

History::~History() {
  if (fd_ >= 0) close(fd_);
}

void History::Add(std::int64_t end) {
  ++steps_;
  last_ = std::exchange(end_, end);
}

void History::ForEachMessage(
    std::int64_t step, const std::function<void(std::string_view channel, runtime::Bytes)>& use) {
  const std::int64_t begin = Find(step);
  const Place& behind = found_[runtime::RingSlot(step + 1)];
  const std::int64_t known_end =
      step == steps_ - 1 ? end_
                         : (behind.step == step + 1 ? behind.begin : begin + log::kMostStepBytes);
  const runtime::Bytes read = Read(begin, known_end - begin);
  runtime::Bytes rest = read;
  std::size_t messages = 0;
  std::string_view why;
  while (messages < log::kStepChannels) {
    const auto event = log::ParseEvent(rest, why);
    const bool is_next = event && (realtime_ ? log::IsStepChannel(event->channel)
                                             : event->channel == log::kStepNames[messages]);
    const bool is_of_step = is_next && log::StepOf(*event, run_id_) == step;
    if (is_of_step) {
      ++messages;
      use(event->channel, event->data);
    } else if (!event || !realtime_) {
      break;
    }
    rest = rest.subspan(log::SizeInFile(*event));
  }
  if (realtime_) return;  // the missing messages were never recorded
  if (messages < log::kStepChannels) {
    throw std::runtime_error(fmt::format("cannot read {} again: step {} at byte {} is damaged",
                                         file_.string(), step, begin));
  }
  found_[runtime::RingSlot(step)] = {.step = step, .begin = begin};
  if (std::cmp_greater(step_events_, log::kStepChannels)) {
    const auto clock = log::ParseEvent(rest, why);
    if (!clock) return;
    rest = rest.subspan(log::SizeInFile(*clock));
  }
  const auto size = static_cast<std::int64_t>(read.size() - rest.size());
  found_[runtime::RingSlot(step + 1)] = {.step = step + 1, .begin = begin + size};
}

std::int64_t History::Find(std::int64_t step) {
  if (step == steps_ - 1) return last_;
  if (const Place& known = found_[runtime::RingSlot(step)]; known.step == step) return known.begin;
  Place low{.step = 0, .begin = front_.bytes};  // the wanted step is this one or a later one
  std::int64_t high = end_;                     // the wanted step begins before this byte
  // All steps have nearly the same size, so the byte at which a step begins can be guessed from its
  // number. The guess is for the previous step, because Look() searches forwards.
  const double share = static_cast<double>(std::max<std::int64_t>(0, step - 1)) /
                       static_cast<double>(std::max<std::int64_t>(1, steps_ - 1));
  std::int64_t guess =
      low.begin + static_cast<std::int64_t>(share * static_cast<double>(last_ - low.begin));
  while (low.step != step) {
    const bool is_near = high - low.begin <= kLook;
    const std::int64_t from = is_near ? low.begin : std::clamp(guess, low.begin, high - 1);
    const auto found = Look(from, high, step);
    if (found && found->step <= step && (found->step > low.step || from > low.begin)) {
      low = *found;
    } else if (from > low.begin) {
      high = from;
    } else {
      throw std::runtime_error(
          fmt::format("cannot read {} again: there is no step {} after byte {}", file_.string(),
                      low.step + 1, low.begin));
    }
    guess = low.begin + (high - low.begin) / 2;
  }
  return low.begin;
}

std::optional<History::Place> History::Look(std::int64_t from, std::int64_t limit,
                                            std::int64_t step) {
  const runtime::Bytes chunk = Read(from, std::min(kLook, end_ - from));
  std::optional<Place> found;
  std::size_t offset = 0;
  const auto begins_step = [this](const log::Event& event) {
    return log::StepBegunBy(event, front_.events, step_events_, run_id_).has_value();
  };
  while (const auto at = log::FindEvent(chunk, offset, begins_step)) {
    std::string_view why;
    const auto event = log::ParseEvent(chunk.subspan(*at), why);
    const Place place{.step = *log::StepBegunBy(*event, front_.events, step_events_, run_id_),
                      .begin = from + static_cast<std::int64_t>(*at)};
    if (place.begin >= limit) break;
    if (place.step > step) return found ? found : place;
    found = place;
    offset = *at + log::SizeInFile(*event);
  }
  return found;
}

runtime::Bytes History::Read(std::int64_t from, std::int64_t size) {
  if (fd_ < 0) fd_ = open(file_.c_str(), O_RDONLY | O_CLOEXEC);
  const auto wanted = static_cast<std::size_t>(size);
  if (chunk_.size() < wanted) chunk_.resize(wanted);
  const ssize_t got = fd_ < 0 ? -1 : pread(fd_, chunk_.data(), wanted, from);
  if (got < 0) {
    throw std::runtime_error(
        fmt::format("cannot read {} again: {}", file_.string(), std::strerror(errno)));
  }
  return {chunk_.data(), static_cast<std::size_t>(got)};
}

}  // namespace fogline::recorder
