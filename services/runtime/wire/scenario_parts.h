// A scenario is sent over LCM in parts. Each part fits into one datagram. The receiver puts the
// parts together.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/runtime/wire/digest.h"

namespace fogline::runtime {

/// Bytes of scenario text in one RUN message. The other bytes of kMaxMessageBytes are for the other
/// fields of RUN.
inline constexpr std::size_t kPartBytes = 1000;

/// The range of a run's speed, in simulated seconds per second. At these speeds, a step of 0.1 s
/// takes between 0.1 ms and 100 s. Within this range, all times that are computed from the speed
/// are finite.
inline constexpr double kMinSpeed = 1e-3;
inline constexpr double kMaxSpeed = 1000;
inline bool IsSpeed(double speed) { return speed >= kMinSpeed && speed <= kMaxSpeed; }

/// The parts of a text, in order; at least one. No part ends within a character of UTF-8, because
/// some languages decode each part by itself.
inline std::vector<std::string> SplitScenario(std::string_view text) {
  constexpr std::size_t kMostContinuationBytes = 3;
  const auto continues = [&text](std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  std::vector<std::string> parts;
  do {
    std::size_t size = kPartBytes;
    while (continues(size) && size > kPartBytes - kMostContinuationBytes) --size;
    parts.emplace_back(text.substr(0, size));
    text.remove_prefix(parts.back().size());
  } while (!text.empty());
  return parts;
}

/// The RUN message that contains part `part` of a scenario.
inline run_t MakeRunPart(std::int64_t run_id, std::int8_t phase, double pace,
                         const std::string& hash, const std::vector<std::string>& parts,
                         std::size_t part) {
  run_t run{};
  run.header.run_id = run_id;
  run.header.step = static_cast<std::int64_t>(part);
  run.phase = phase;
  run.progress = -1;
  run.pace = pace;
  run.scenario_hash = hash;
  run.type_fingerprint = TypeFingerprint();
  run.num_parts = static_cast<std::int32_t>(parts.size());
  run.text = parts[part];
  return run;
}

/// Collects the parts of one run's scenario, in any order and with repetitions.
class ScenarioParts {
 public:
  /// The largest number of parts that a sender may announce. With kPartBytes each, these parts are
  /// 200 MB of text.
  static constexpr std::int32_t kMaxParts = 200'000;

  /// Stores the part in a run_t.
  /// @return false if the part is impossible or contradicts an earlier part
  [[nodiscard]] bool Add(const run_t& run) {
    if (run.num_parts < 1 || run.num_parts > kMaxParts) return false;
    if (run.header.step < 0 || run.header.step >= run.num_parts || run.text.empty()) return false;
    if (parts_.empty()) {
      parts_.resize(static_cast<std::size_t>(run.num_parts));
      missing_ = parts_.size();
      hash_ = run.scenario_hash;
    }
    if (static_cast<std::size_t>(run.num_parts) != parts_.size() || run.scenario_hash != hash_) {
      return false;
    }
    std::string& part = parts_[static_cast<std::size_t>(run.header.step)];
    if (!part.empty()) return part == run.text;
    part = run.text;
    --missing_;
    return true;
  }

  bool empty() const { return parts_.empty(); }
  bool Complete() const { return !parts_.empty() && missing_ == 0; }

  /// Number of the first part that is missing; 0 if no part has come yet, or if all have come.
  std::int64_t FirstMissing() const {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_[i].empty()) return static_cast<std::int64_t>(i);
    }
    return 0;
  }

  const std::string& hash() const { return hash_; }
  const std::vector<std::string>& parts() const { return parts_; }

  /// The whole text. @pre Complete()
  std::string Text() const {
    std::string text;
    for (const std::string& part : parts_) text += part;
    return text;
  }

  /// Whether the text has the hash that the sender gave. @pre Complete()
  bool HashHolds() const { return HashOf(Text()) == hash_; }

 private:
  std::vector<std::string> parts_;
  std::size_t missing_ = 0;
  std::string hash_;
};

}  // namespace fogline::runtime
