#include "tools/report/story.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenario/io/loader.h"
#include "services/metrics/detection.h"
#include "services/metrics/run_metrics.h"
#include "tools/report/figures.h"
#include "tools/report/metric_text.h"
#include "tools/report/tables.h"

namespace fogline::report {
namespace {

constexpr std::size_t kMostSituations = 3;  // situations that have a sentence of their own
constexpr std::size_t kMostRuns = 3;        // runs with traded control that a sentence names

/// A run with the values that the story uses.
struct Told {
  const ReportRun* run;
  std::string name;
  metrics::RunMetrics measures;

  bool IsTraded() const { return run->scenario.arbitrator.policy != Policy::kNone; }
};

using Group = std::vector<Told>;

/// Groups of runs that differ only in their arbitrator, in the order of their first runs. Omits
/// runs without a step, and runs with gaps, because the measures of such runs are unknown.
std::vector<Group> GroupsOf(std::span<const ReportRun> runs) {
  std::vector<std::pair<std::string, Group>> situations;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].samples.empty() || runs[i].has_gaps) continue;
    Scenario scenario = runs[i].scenario;
    scenario.arbitrator = {};
    std::string key = PrintScenario(scenario);
    auto found = std::ranges::find(situations, key, &std::pair<std::string, Group>::first);
    if (found == situations.end()) {
      situations.emplace_back(std::move(key), Group());
      found = situations.end() - 1;
    }
    found->second.push_back(
        {&runs[i], RunName(runs, i), metrics::Measure(runs[i].samples, runs[i].scenario)});
  }
  std::vector<Group> parts;
  for (auto& [key, group] : situations) parts.push_back(std::move(group));
  return parts;
}

/// A length with a readable number of digits, such as "3.9 cm".
std::string LengthText(double length_m) {
  constexpr double kMillimetres = 1e3;
  constexpr double kCentimetres = 1e2;
  if (length_m < 0.001) return "less than 1 mm";
  if (length_m < 0.01) return fmt::format("{:.0f} mm", kMillimetres * length_m);
  if (length_m < 0.1) return fmt::format("{:.1f} cm", kCentimetres * length_m);
  return fmt::format("{:.{}f} m", length_m, length_m < 10 ? 2 : 0);
}

/// A time in s, such as "9.4" or "11".
std::string TimeText(double time_s) {
  std::string text = fmt::format("{:.1f}", time_s);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

/// The time spans with fog, such as "In fog from 19 s to 30 s"; "" without fog.
std::string FogText(std::span<const metrics::Sample> samples) {
  constexpr std::size_t kMostNamed = 3;
  const std::vector<Window> windows = FogWindows(samples);
  if (windows.empty()) return "";
  if (windows.size() > kMostNamed) {
    return fmt::format("In fog, {} times from {} s to {} s", windows.size(),
                       TimeText(windows.front().begin_s), TimeText(windows.back().end_s));
  }
  std::vector<std::string> spans;
  for (const Window& window : windows) {
    spans.push_back(
        fmt::format("from {} s to {} s", TimeText(window.begin_s), TimeText(window.end_s)));
  }
  return "In fog " + ListText(spans);
}

/// Errors of the LiDAR in fog, over all runs of a group.
struct Deception {
  double short_m = 0;  // largest length by which the LiDAR's range was too short
  double far_m = 0;
  double lost_s = 0;  // largest total time without an echo in one run
};

Deception DeceptionOf(const Group& group) {
  Deception worst;
  for (const Told& told : group) {
    double lost_s = 0;
    const std::span<const metrics::Sample> samples = told.run->samples;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!samples[i].fog_present) continue;
      const double error_m = metrics::LidarError(samples[i], told.run->scenario.lidar);
      if (std::isnan(error_m) && i + 1 < samples.size()) {
        lost_s += samples[i + 1].time_s - samples[i].time_s;
      }
      worst.short_m = std::max(worst.short_m, -error_m);
      worst.far_m = std::max(worst.far_m, error_m);
    }
    worst.lost_s = std::max(worst.lost_s, lost_s);
  }
  return worst;
}

/// A text such as "In fog from 19 s to 30 s the LiDAR read up to 0.22 m short".
std::string FogSentence(const Group& group) {
  const auto length = [](const Told& told) { return told.run->samples.size(); };
  const std::string fog = FogText(std::ranges::max_element(group, {}, length)->run->samples);
  if (fog.empty()) return "There was no fog";
  const double tolerance_m = group.front().run->scenario.measures.lidar_tolerance_m;
  const Deception deception = DeceptionOf(group);
  std::vector<std::string> effects;
  if (deception.short_m > tolerance_m) {
    effects.push_back(fmt::format("read up to {} short", LengthText(deception.short_m)));
  }
  if (deception.far_m > tolerance_m) {
    effects.push_back(fmt::format("read up to {} too far", LengthText(deception.far_m)));
  }
  if (deception.lost_s > 0) {
    effects.push_back(fmt::format("had no echo for {} s", TimeText(deception.lost_s)));
  }
  if (effects.empty()) {
    effects.push_back(fmt::format("was never more than {} wrong", LengthText(tolerance_m)));
  }
  return fmt::format("{} the LiDAR {}", fog, ListText(effects));
}

/// A speed, such as "0.047 m/s".
std::string SpeedText(double speed_mps) {
  return fmt::format("{:.{}f} m/s", speed_mps, speed_mps < 0.1 ? 3 : speed_mps < 10 ? 2 : 0);
}

/// The effect of the fog in metres and m/s, such as " (1.5 cm on average in the fog) and the host
/// slowed down by 0.047 m/s"; "" without an effect.
std::string EffectText(const metrics::RunMetrics& measures) {
  constexpr double kLeastSlowDown_mps = 0.0005;
  std::string text;
  if (measures.mean_compromised_safety_fog_m.value_or(0) > 0) {
    text += fmt::format(" ({} on average in the fog)",
                        LengthText(*measures.mean_compromised_safety_fog_m));
  }
  if (measures.max_slow_down_fog_mps.value_or(0) >= kLeastSlowDown_mps) {
    text +=
        fmt::format(" and the host slowed down by {}", SpeedText(*measures.max_slow_down_fog_mps));
  }
  return text;
}

/// Compromised safety as "3 mm on average" or "nothing".
std::string LeftText(double compromised_m) {
  return compromised_m > 0 ? LengthText(compromised_m) + " on average" : "nothing";
}

/// The safety of a run as text, without a comparison.
std::string SafetyText(const metrics::RunMetrics& measures) {
  if (std::string collision = CollisionText(measures); !collision.empty()) return collision;
  if (!measures.max_compromised_safety_m) return "no car collided";
  if (*measures.max_compromised_safety_m == 0) return "the following car never came too close";
  return fmt::format("the following car came {} too close",
                     LengthText(*measures.max_compromised_safety_m));
}

/// Whether a run's safety improvement covers all steps of the baseline, the run without traded
/// control. If a log or a run ends early, the improvement covers only the steps before the end.
bool IsComparable(const Told& told, const Told* baseline) {
  const auto is_whole = [](const Told& run) {
    return run.run->shortage.empty() && !run.measures.collision_time_s;
  };
  return baseline != nullptr && told.run->si_pct && is_whole(told) && is_whole(*baseline);
}

/// The outcome of a run as text. It is compared with the run without traded control if
/// IsComparable() is true.
std::string OutcomeText(const Told& told, const Told* baseline) {
  if (!IsComparable(told, baseline)) {
    const bool saved = baseline != nullptr && baseline->measures.collision_time_s &&
                       !told.measures.collision_time_s;
    return saved ? "no car collided" : SafetyText(told.measures);
  }
  const double si_pct = std::round(*told.run->si_pct) + 0.0;  // + 0.0 changes -0.0 into 0.0
  std::string text = si_pct >= 0 ? fmt::format("{:.0f} % of that was avoided", si_pct)
                                 : fmt::format("that got {:.0f} % worse", -si_pct);
  if (const auto left_m = told.measures.mean_compromised_safety_fog_m) {
    text += fmt::format(", which leaves {}", LeftText(*left_m));
  }
  return text;
}

/// A text such as "the human drove for 9.4 s".
std::string DrivingText(const Told& told) {
  const metrics::RunMetrics& measures = told.measures;
  if (measures.human_time_s == 0) return "the human never drove";
  if (measures.human_time_s >= measures.duration_s) return "the human drove all the time";
  return fmt::format("the human drove for {} s", TimeText(measures.human_time_s));
}

/// A text such as "at threshold 0.5 the human drove for 9.4 s and 81 % of that was avoided".
std::string TradedText(const Told& told, const Told* baseline) {
  const std::string_view comma = told.name.find(',') == std::string::npos ? "" : ",";
  return fmt::format("{} {}{} {} and {}", told.name.starts_with("threshold") ? "at" : "with",
                     told.name, comma, DrivingText(told), OutcomeText(told, baseline));
}

/// The range of a value over runs, such as "10 to 100", or "7". `text` formats a number.
template <class Value, class Text>
std::string RangeText(const std::vector<const Told*>& runs, Value value, Text text) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const Told* told : runs) {
    least = std::min<double>(least, value(*told));
    most = std::max<double>(most, value(*told));
  }
  const std::string low = text(least);
  const std::string high = text(most);
  return low == high ? low : fmt::format("{} to {}", low, high);
}

std::string HumanTimes(const std::vector<const Told*>& runs) {
  const auto time = [](const Told& told) { return told.measures.human_time_s; };
  return fmt::format("the human drove for {} s", RangeText(runs, time, TimeText));
}

/// Summary of runs if there are too many to name each of them in one sentence.
std::string ManyText(const std::vector<const Told*>& runs, const Told* baseline) {
  std::string text =
      fmt::format("in {} runs with traded control {}", runs.size(), HumanTimes(runs));
  const bool all_comparable =
      std::ranges::all_of(runs, [&](const Told* told) { return IsComparable(*told, baseline); });
  if (all_comparable) {
    const auto share = [](const Told& told) { return *told.run->si_pct; };
    const auto percent = [](double value) { return fmt::format("{:.0f}", value); };
    const auto left_m = [](const Told& told) {
      return told.measures.mean_compromised_safety_fog_m.value_or(0);
    };
    text += fmt::format(" and {} % of that was avoided", RangeText(runs, share, percent));
    if (runs.front()->measures.mean_compromised_safety_fog_m) {
      text += fmt::format(", which leaves {}", RangeText(runs, left_m, LeftText));
    }
  }
  const auto collisions = std::ranges::count_if(
      runs, [](const Told* told) { return told->measures.collision_time_s.has_value(); });
  if (collisions > 0) text += fmt::format("; in {} of them a car collided", collisions);
  return text;
}

std::string SentenceOf(const Group& group) {
  const Told* baseline = nullptr;
  std::vector<const Told*> traded;
  for (const Told& told : group) {
    if (told.IsTraded()) {
      traded.push_back(&told);
    } else if (baseline == nullptr) {
      baseline = &told;
    }
  }
  std::vector<std::string> parts{FogSentence(group)};
  if (baseline != nullptr) {
    const bool collided = baseline->measures.collision_time_s.has_value();
    parts.push_back(fmt::format("without traded control {}{}", SafetyText(baseline->measures),
                                collided ? "" : EffectText(baseline->measures)));
  }
  if (traded.size() > kMostRuns) {
    parts.push_back(ManyText(traded, baseline));
  } else {
    for (const Told* told : traded) parts.push_back(TradedText(*told, baseline));
  }
  return fmt::format("{}.", fmt::join(parts, "; "));
}

/// Heading of a situation: its title, if titles differ, and its seed.
std::string HeadingOf(const Group& group, bool with_title) {
  const ReportRun& run = *group.front().run;
  return with_title ? fmt::format("{}, seed {}: ", run.scenario_title, run.seed)
                    : fmt::format("Seed {}: ", run.seed);
}

/// Summary of situations if there are too many to describe each of them.
std::string SummedUp(const std::vector<Group>& situations) {
  std::vector<const Told*> runs;
  for (const Group& group : situations) {
    for (const Told& told : group) runs.push_back(&told);
  }
  double worst_m = 0;
  std::size_t too_close = 0;
  std::size_t collided = 0;
  for (const Told* told : runs) {
    const double compromised_m = told->measures.max_compromised_safety_m.value_or(0);
    worst_m = std::max(worst_m, compromised_m);
    if (compromised_m > 0) ++too_close;
    if (told->measures.collision_time_s) ++collided;
  }
  return fmt::format(
      "In {} of {} runs, of {} situations, the following car came too close{}; {}; in {} runs a "
      "car collided.",
      too_close, runs.size(), situations.size(),
      too_close > 0 ? fmt::format(", by up to {}", LengthText(worst_m)) : "", HumanTimes(runs),
      collided);
}

}  // namespace

std::string StoryOf(std::span<const ReportRun> runs) {
  const std::vector<Group> situations = GroupsOf(runs);
  const bool cut =
      std::ranges::any_of(runs, [](const ReportRun& run) { return !run.shortage.empty(); });
  std::string story = cut && !situations.empty() ? "As far as the logs go: " : "";
  if (situations.size() > kMostSituations) return story + SummedUp(situations);
  const bool with_title = std::ranges::any_of(
      runs, [&](const ReportRun& run) { return run.scenario_title != runs[0].scenario_title; });
  for (const Group& group : situations) {
    if (&group != &situations.front()) story += ' ';
    if (situations.size() > 1) story += HeadingOf(group, with_title);
    story += SentenceOf(group);
  }
  return story;
}

}  // namespace fogline::report
