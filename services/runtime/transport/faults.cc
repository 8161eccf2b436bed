#include "services/runtime/transport/faults.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/parse_number.h"
#include "common/random.h"

namespace fogline::runtime {
namespace {

/// The delay of a message that later messages overtake. A run over udpm computes about ten steps in
/// this time.
constexpr Duration kOvertaken = milliseconds(2);
/// The largest value of delay_ms. A longer delay leads to stalls, for which there are other tests.
constexpr double kMaxDelayMs = 1000;

struct ChanceField {
  std::string_view name;
  double FaultRates::*member;
};
constexpr std::array kChances{
    ChanceField{"loss", &FaultRates::loss},       ChanceField{"duplicate", &FaultRates::duplicate},
    ChanceField{"reorder", &FaultRates::reorder}, ChanceField{"truncate", &FaultRates::truncate},
    ChanceField{"flip", &FaultRates::flip},
};

InputError FaultsError(const std::string& what) {
  return InputError(
      fmt::format("error: --faults: {}; any of "
                  "loss=0.3,duplicate=0.1,reorder=0.1,delay_ms=5,truncate=0.01,flip=0.01,seed=7",
                  what));
}

template <class Number>
Number NumberOf(std::string_view name, std::string_view text) {
  const auto number = ParseNumber<Number>(text);
  if (!number) throw FaultsError(fmt::format("{}=\"{}\" is not a number", name, text));
  return *number;
}

void Set(std::string_view name, std::string_view text, FaultRates& rates) {
  if (name == "seed") {
    rates.seed = NumberOf<std::int64_t>(name, text);
    return;
  }
  const double value = NumberOf<double>(name, text);
  if (name == "delay_ms") {
    if (!(value >= 0 && value <= kMaxDelayMs)) {
      throw FaultsError(fmt::format("{}={} is outside [0, {}] ms", name, text, kMaxDelayMs));
    }
    rates.delay_ms = value;
    return;
  }
  for (const ChanceField& chance : kChances) {
    if (chance.name != name) continue;
    if (!(value >= 0 && value < 1)) {
      throw FaultsError(fmt::format("{}={} is outside [0, 1)", name, text));
    }
    rates.*chance.member = value;
    return;
  }
  throw FaultsError(fmt::format("\"{}\" is no kind of fault", name));
}

/// A random index in [0, size).
std::size_t Place(double uniform, std::size_t size) {
  return static_cast<std::size_t>(uniform * static_cast<double>(size));
}

}  // namespace

FaultRates ParseFaults(std::string_view text) {
  FaultRates rates;
  std::set<std::string_view> given;
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(','));
    text.remove_prefix(std::min(item.size() + 1, text.size()));
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos) {
      throw FaultsError(fmt::format("\"{}\" has no value", item));
    }
    const std::string_view name = item.substr(0, equals);
    Set(name, item.substr(equals + 1), rates);
    if (!given.insert(name).second) throw FaultsError(fmt::format("\"{}\" is given twice", name));
  }
  return rates;
}

std::array<double, 2> Faults::Uniform2(Draw draw) const {
  constexpr std::uint32_t kDraws = 4;
  const Random random(rates_.seed, Stream::kFaults);
  return random.Uniform2(
      count_, kDraws * static_cast<std::uint32_t>(role_) + static_cast<std::uint32_t>(draw));
}

void Faults::Take(std::string_view channel, Bytes bytes, TimePoint now) {
  ++count_;
  const auto [loss, duplicate] = Uniform2(Draw::kLossOrDuplicate);
  if (loss < rates_.loss) return;
  const auto [reorder, truncate] = Uniform2(Draw::kReorderOrTruncate);
  const auto [flip, unused] = Uniform2(Draw::kFlip);
  const auto [end, bit] = Uniform2(Draw::kPlaces);
  Message message{.channel = std::string(channel), .bytes = {bytes.begin(), bytes.end()}};
  if (truncate < rates_.truncate) message.bytes.resize(Place(end, message.bytes.size()));
  if (flip < rates_.flip && !message.bytes.empty()) {
    constexpr std::size_t kByteBits = 8;
    const std::size_t place = Place(bit, kByteBits * message.bytes.size());
    message.bytes[place / kByteBits] ^= static_cast<std::uint8_t>(1U << (place % kByteBits));
  }
  const std::chrono::duration<double, std::milli> delay(rates_.delay_ms);
  TimePoint due = now + duration_cast<Duration>(delay);
  if (duplicate < rates_.duplicate) waiting_.emplace(due, message);
  if (reorder < rates_.reorder) due += kOvertaken;
  waiting_.emplace(due, std::move(message));
}

std::optional<Faults::Message> Faults::Due(TimePoint now) {
  if (NextDue() > now) return std::nullopt;
  return std::move(waiting_.extract(waiting_.begin()).mapped());
}

TimePoint Faults::NextDue() const {
  return waiting_.empty() ? TimePoint::max() : waiting_.begin()->first;
}

}  // namespace fogline::runtime
