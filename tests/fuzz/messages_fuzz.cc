// Fuzzes the decoding of every message type, from the bytes to the values that a reader gets.
// Input: an index into kChannels, and the message.
#include <algorithm>

#include "services/runtime/wire/arrival.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

template <class M>
void DemandOneMeaning(runtime::Bytes bytes) {
  M message{};
  const bool whole = runtime::Decode(bytes, message);
  const bool finite = runtime::FirstNonFiniteField(message).empty();
  runtime::Arrival arrival;
  arrival.Renew(bytes, {});
  Demand((arrival.As<M>() != nullptr) == (whole && finite),
         "a reader is given what is whole and finite, and nothing else");
  const runtime::RefusalCounter expected = bytes.size() < runtime::kHeaderEnd ? &status_t::malformed
                                           : runtime::ReadInt64(bytes, 0) != M::getHash()
                                               ? &status_t::wrong_type
                                           : !whole  ? &status_t::malformed
                                           : !finite ? &status_t::not_finite
                                                     : nullptr;
  Demand(arrival.Wrong<M>() == expected, "a refusal names the defect of the message");
  if (!whole) return;
  Demand(std::ranges::equal(Encoded(message), bytes),
         "a decoded message encodes to the same bytes");
  M used = Sample<M>(1);
  Demand(runtime::Decode(bytes, used) && std::ranges::equal(Encoded(used), bytes),
         "nothing is left of an earlier message");
  Demand(!runtime::Decode(bytes.first(bytes.size() - 1), used),
         "a message without its end is refused");
  Input longer(bytes.begin(), bytes.end());
  longer.push_back(0);
  Demand(!runtime::Decode(longer, used), "a message with more bytes behind its end is refused");
  if (finite) Took();
}

template <class M>
void DemandNoOther(runtime::Bytes bytes) {
  M message{};
  Demand(!runtime::Decode(bytes, message), "a message is of one type only");
}

}  // namespace

std::vector<Input> Seeds() { return SeedOfEachType(); }

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t channel = data[0] % fogline::kNumChannels;
  const fogline::runtime::Bytes bytes(data + 1, size - 1);
  fogline::fuzz::ForEachType([&]<class M>(std::size_t place) {
    if (place == channel) fogline::fuzz::DemandOneMeaning<M>(bytes);
    const bool of_another = bytes.size() >= fogline::runtime::kHeaderEnd &&
                            fogline::runtime::ReadInt64(bytes, 0) != M::getHash();
    if (of_another) fogline::fuzz::DemandNoOther<M>(bytes);
  });
  return 0;
}
