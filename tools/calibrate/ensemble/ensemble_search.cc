#include "tools/calibrate/ensemble/ensemble_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "common/random.h"

namespace fogline::calibrate {
namespace {

// Random stream of the starting points. Streams below 1000 belong to roles, and streams from 1000
// to 1999 belong to studies.
constexpr Stream kStarts{2000};

// A search ends when the distance of its best point from the target is at most this share of the
// largest allowed distance (EnsembleRules::within). The other half of the allowed distance is a
// margin: the point must then also meet the target over fresh seeds, which the search does not use.
// Over these seeds the distance is a little different.
constexpr double kEnough = 0.5;

double Squared(double x) { return x * x; }

/// A point and its squared distance from the target.
struct Valued {
  std::vector<double> shares;
  double value = std::numeric_limits<double>::max();
};

class PointSearch {
 public:
  PointSearch(const Landscape& landscape, const EnsembleRules& rules,
              const EnsembleProgress& progress)
      : landscape_(landscape), rules_(rules), progress_(progress) {}

  PointEnsemble Run() {
    for (const Valued& start : RankedStarts()) {
      if (static_cast<int>(result_.points.size()) >= rules_.sets) break;
      ++result_.counts.searches;
      const Valued best = BestAround(start);
      if (result_.interrupted) break;
      Judge(best);
    }
    return std::move(result_);
  }

 private:
  std::optional<double> Evaluate(const std::vector<double>& shares) {
    const std::optional<double> value = landscape_.searched(shares);
    if (!value) {
      result_.interrupted = true;
      return value;
    }
    ++result_.counts.evaluations;
    progress_(static_cast<int>(result_.points.size()), result_.counts);
    return value;
  }

  /// The starting points, the best first; none after an interrupt.
  std::vector<Valued> RankedStarts() {
    std::vector<Valued> starts;
    for (std::vector<double>& shares :
         LatinHypercube(rules_.starts, landscape_.fields, rules_.seed)) {
      const std::optional<double> value = Evaluate(shares);
      if (!value) return {};
      starts.push_back({std::move(shares), *value});
    }
    std::ranges::stable_sort(starts, {}, &Valued::value);
    return starts;
  }

  Valued BestAround(const Valued& start) {
    Valued best = start;
    const double enough = Squared(kEnough * rules_.within);
    if (best.value <= enough) return best;
    Minimise(
        Reach::kAroundStart,
        [&](const std::vector<double>& shares) {
          const std::optional<double> value = Evaluate(shares);
          if (value && *value < best.value) best = {shares, *value};
          return value;
        },
        start.shares, enough, rules_.evaluations);
    return best;
  }

  /// Adds to the result the point that a search has found, or counts the reason why the point is
  /// not added.
  void Judge(const Valued& best) {
    EnsembleCounts& counts = result_.counts;
    if (best.value > Squared(rules_.within)) {
      ++counts.missed;
      return;
    }
    std::vector<double> point = landscape_.rounded(best.shares);
    const auto is_near = [&](const std::vector<double>& other) {
      return ShareDistance(point, other) < rules_.apart;
    };
    if (std::ranges::any_of(result_.points, is_near)) {
      ++counts.too_near;
      return;
    }
    const std::optional<double> fresh = landscape_.fresh(point);
    if (!fresh) {
      result_.interrupted = true;
    } else if (*fresh > Squared(rules_.within)) {
      ++counts.rejected;
    } else {
      result_.points.push_back(std::move(point));
    }
  }

  const Landscape& landscape_;
  const EnsembleRules& rules_;
  const EnsembleProgress& progress_;
  PointEnsemble result_;
};

}  // namespace

double ShareDistance(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += Squared(a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

std::vector<std::vector<double>> LatinHypercube(int points, std::size_t fields, std::int64_t seed) {
  const Random random(seed, kStarts);
  const auto count = static_cast<std::size_t>(points);
  std::vector<std::vector<double>> hypercube(count, std::vector<double>(fields));
  std::vector<std::size_t> parts(count);
  for (std::size_t f = 0; f < fields; ++f) {
    std::iota(parts.begin(), parts.end(), std::size_t{0});
    for (std::size_t i = count; i-- > 0;) {
      const auto [which, where] =
          random.Uniform2(static_cast<std::int64_t>(f), static_cast<std::uint32_t>(i));
      // Fisher & Yates: draws one of the remaining parts.
      const auto left = static_cast<double>(i + 1);
      std::swap(parts[i], parts[std::min(i, static_cast<std::size_t>(which * left))]);
      hypercube[i][f] = (static_cast<double>(parts[i]) + where) / static_cast<double>(count);
    }
  }
  return hypercube;
}

PointEnsemble FindPoints(const Landscape& landscape, const EnsembleRules& rules,
                         const EnsembleProgress& progress) {
  return PointSearch(landscape, rules, progress).Run();
}

}  // namespace fogline::calibrate
